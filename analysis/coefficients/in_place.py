"""Gain and lag of the dynamometers in place, from a run in air with known mass.

In air the struts carry nothing but inertia and weight of a known body, so each gauge's reading over
the force that theory gives is its response at that frequency.
"""

import math
from dataclasses import dataclass

import numpy as np

from analysis.coefficients.corrections import Delay
from analysis.coefficients.measured import StrutRun
from analysis.coefficients.phasors import FloatArray
from analysis.coefficients.run import from_struts
from analysis.motion import ComplexArray, motion, strut_forces
from hardware.description.body import Body
from hardware.description.channels import DISPLACEMENTS, FORCES
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.setpoint import Medium

_LEAST_FORCE = 0.05  # of the larger strut's: below, the other strut's errors decide


@dataclass(frozen=True, eq=False)
class InPlace:
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


def in_place(run: StrutRun, body: Body) -> InPlace:
    """Return gain and lag of both dynamometers.

    Parameters
    ----------
    run
        In air, fundamental, with measured displacements or its set-point's.
    body
        What moved below the dynamometers, the known mass included; about the midpoint.

    Raises
    ------
    ConfigurationError
        If the run was not in air, or is not a fundamental.
    DataError
        If a strut hardly carried anything.
    """
    if run.set_point.medium is not Medium.AIR or run.order != 1:
        raise ConfigurationError(f"{run.name}: a fundamental of a run in air is needed")
    loaded = from_struts(run).without(body)
    asked = loaded.known() @ loaded.motion.values
    forces = strut_forces(asked, run.oscillator.half_spacing_m, run.oscillator.plane)
    weakest = np.abs(forces).min() / np.abs(forces).max()
    if not weakest > _LEAST_FORCE:
        raise DataError(
            f"{run.name}: one strut carries {100 * weakest:.2g} % of the other's force (limit "
            f"{100 * _LEAST_FORCE:g} %); shift the mass, or run another motion"
        )
    ratio = run.forces.values / forces
    relative = _relative(run, loaded.known(), forces)
    omega = 2.0 * math.pi * run.frequency_hz
    spread = np.stack((np.abs(ratio) * relative[0::2], relative[1::2] / omega), axis=-1)
    return InPlace(np.abs(ratio), -np.angle(ratio) / omega, spread, run.frequency_hz)


def _relative(run: StrutRun, known: FloatArray, forces: ComplexArray) -> FloatArray:
    """Standard uncertainty of each ratio's relative size and angle: d(ratio) / ratio."""
    half, plane = run.oscillator.half_spacing_m, run.oscillator.plane
    ordered = run.phasors.select((*DISPLACEMENTS, *FORCES))
    unit = np.eye(2, dtype=np.complex128)
    per_strut = strut_forces((known @ motion(unit, half, plane).T).T, half, plane).T
    slope = np.hstack((-per_strut / forces[:, None], np.diag(1.0 / run.forces.values)))
    return np.sqrt(np.diagonal(ordered.mapped(slope, FORCES, ("1", "1")).covariance))
