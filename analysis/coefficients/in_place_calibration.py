"""Gain and lag of the dynamometers in place, from a run in air with known mass.

In air the struts carry nothing but inertia and weight of a known body, so each gauge's reading over
the force that theory gives is its response at that frequency.
"""

import math
from dataclasses import dataclass

import numpy as np

from analysis.coefficients.body_axes import at_order, labels
from analysis.coefficients.corrections import Delay
from analysis.coefficients.phasors import from_interleaved, interleaved
from analysis.coefficients.strut_cycle import StrutCycle
from analysis.ideal_rig import mass_matrix, motion, strut_forces, weight_matrix
from analysis.kinematics.cycle import driven, harmonics
from analysis.kinematics.motion import motion as turned
from analysis.kinematics.projection import readings
from analysis.kinematics.rigid_body import inertia, weight, zero_readings
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.body import Body
from hardware.description.channels import DISPLACEMENTS, FORCES
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.oscillator import Plane
from hardware.description.setpoint import Medium

_LEAST_FORCE = 0.05  # of the larger strut's: below, the other strut's errors decide


@dataclass(frozen=True, eq=False)
class InPlaceResponse:
    """Response of both dynamometers, aft and fore.

    Attributes
    ----------
    gain
        Reading over force, shape ``(2,)``.
    lag_s
        By which the reading is late, shape ``(2,)``.
    standard_uncertainty
        Of (gain, lag) from the scatter of the run, shape ``(2, 2)``: first index the strut. The
        body's own uncertainty adds to the gain in full.
    """

    gain: FloatArray
    lag_s: FloatArray
    standard_uncertainty: FloatArray
    frequency_hz: float

    @property
    def responses(self) -> dict[str, Delay]:
        """What :func:`analysis.coefficients.corrections.without_response` takes out with it."""
        return {
            name: Delay(float(lag), float(gain))
            for name, lag, gain in zip(FORCES, self.lag_s, self.gain, strict=True)
        }


def in_place_response(struts: StrutCycle, body: Body) -> InPlaceResponse:
    """Return gain and lag of both dynamometers at the fundamental.

    Parameters
    ----------
    struts
        In air, with measured displacements or its set-point's.
    body
        What moved below the dynamometers, the known mass included; about the midpoint.

    Raises
    ------
    ConfigurationError
        If the run was not in air.
    DataError
        If a strut hardly carried anything.
    """
    if struts.set_point.medium is not Medium.AIR:
        raise ConfigurationError(f"{struts.name}: a run in air is needed")
    omega = 2.0 * math.pi * struts.frequency_hz
    ordered = struts.phasors.select([at_order(name, 1) for name in (*DISPLACEMENTS, *FORCES)])
    read = ordered.values[2:]
    forces = _forces(struts, body, omega)
    weakest = np.abs(forces).min() / np.abs(forces).max()
    if not weakest > _LEAST_FORCE:
        raise DataError(
            f"{struts.name}: one strut carries {100 * weakest:.2g} % of the other's force (limit "
            f"{100 * _LEAST_FORCE:g} %); shift the mass, or run another motion"
        )
    plane, half = struts.oscillator.plane, struts.oscillator.half_spacing_m
    known = weight_matrix(body, plane) - omega**2 * mass_matrix(body, plane)
    unit = np.eye(2, dtype=np.complex128)
    per_strut = strut_forces((known @ motion(unit, half, plane).T).T, half, plane).T
    slope = np.hstack((-per_strut / forces[:, None], np.diag(1.0 / read)))
    relative = np.sqrt(np.diagonal(ordered.mapped(slope, FORCES, ("1", "1")).covariance))
    ratio = read / forces
    spread = np.stack((np.abs(ratio) * relative[0::2], relative[1::2] / omega), axis=-1)
    return InPlaceResponse(np.abs(ratio), -np.angle(ratio) / omega, spread, struts.frequency_hz)


def _forces(struts: StrutCycle, body: Body, omega: float) -> ComplexArray:
    """What the body asks of both gauges at the fundamental, less what it asks of them at rest."""
    geometry = struts.geometry
    moved = struts.phasors.select(labels(DISPLACEMENTS, struts.orders))
    state = turned(geometry, driven(interleaved(moved.values), omega))
    asked = inertia(body, state, geometry.plane)
    if geometry.plane is Plane.VERTICAL:
        asked = asked + weight(body, state)
    forces = readings(geometry, state.line_rad, asked) - zero_readings(geometry, body)[:, None]
    return from_interleaved(harmonics(forces[:2], 1))[2:]
