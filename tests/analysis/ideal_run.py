"""The phasors that an ideal rig would measure of a linear hull, in closed form.

Rows of phasors are those of :mod:`analysis.ideal_rig`.
"""

import math
from dataclasses import dataclass, field

import numpy as np

from analysis.ideal_rig import incidence, mass_matrix, strut_displacements, weight_matrix
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.body import Body
from hardware.description.oscillator import Oscillator, Plane
from hardware.description.setpoint import Medium, SetPoint
from hardware.description.struts import to_motion, to_strut_forces


def _nothing() -> FloatArray:
    return np.zeros((2, 2))


@dataclass(frozen=True, eq=False)
class LinearHull:
    """A hull whose load is linear in its motion; each matrix is 2 by 2, about the midpoint.

    Rows are force and moment, columns translation and rotation; positive values are those of a
    load that the struts have to exert.

    Attributes
    ----------
    mass
        Of the model: kg, kg m and kg m^2 (see :func:`analysis.ideal_rig.mass_matrix`).
    added_mass, damping
        Per acceleration and velocity through the water, in SI units.
    restoring
        Per displacement: buoyancy and the weight's part (:func:`analysis.ideal_rig.weight_matrix`).
    """

    mass: FloatArray = field(default_factory=_nothing)
    added_mass: FloatArray = field(default_factory=_nothing)
    damping: FloatArray = field(default_factory=_nothing)
    restoring: FloatArray = field(default_factory=_nothing)


def motion(struts: ComplexArray, half_spacing_m: float, plane: Plane) -> ComplexArray:
    """Turn strut displacements ``(..., 2)`` into translation (m) and rotation (rad)."""
    pair = to_motion(struts[..., 0], struts[..., 1], half_spacing_m, plane)
    return np.stack(pair, axis=-1)


def derivative(phasors: ComplexArray, frequency_hz: float, times: int = 1) -> ComplexArray:
    """Return the time derivative of rows of phasors: times ``(i n omega)^times``."""
    factor = (2j * math.pi * frequency_hz * np.arange(len(phasors))) ** times
    return phasors * factor[:, np.newaxis]


def through_water(
    displacement: ComplexArray, frequency_hz: float, speed_m_s: float, plane: Plane
) -> ComplexArray:
    """Return the velocity through the water, (w, q) or (v, r): m/s and rad/s.

    ``w = z' + U pitch`` in the vertical plane, ``v = y' - U yaw`` in the horizontal one.
    """
    turned: ComplexArray = speed_m_s * displacement @ incidence(plane).T
    return derivative(displacement, frequency_hz) + turned


def loads(
    hull: LinearHull,
    displacement: ComplexArray,
    frequency_hz: float,
    speed_m_s: float,
    plane: Plane,
) -> ComplexArray:
    """Return force (N) and moment (N m) that the struts have to exert on a linear hull.

        (force, moment) = M q'' + A v' + B v + C q        v: see :func:`through_water`

    The mean of the result is what the mean displacement costs; weight and buoyancy at rest are
    left out, as from a dynamometer that was tared with the model in place.
    """
    velocity = through_water(displacement, frequency_hz, speed_m_s, plane)
    total: ComplexArray = (
        derivative(displacement, frequency_hz, 2) @ hull.mass.T
        + derivative(velocity, frequency_hz) @ hull.added_mass.T
        + velocity @ hull.damping.T
        + displacement @ hull.restoring.T
    )
    return total


def strut_forces(load: ComplexArray, half_spacing_m: float, plane: Plane) -> ComplexArray:
    """Turn loads ``(..., 2)`` into the forces of the aft and the fore strut on the model, N."""
    pair = to_strut_forces(load[..., 0], load[..., 1], half_spacing_m, plane)
    return np.stack(pair, axis=-1)


@dataclass(frozen=True, eq=False)
class IdealRun:
    """All phasors of an ideal run, each of shape ``(orders + 1, 2)``.

    Attributes
    ----------
    displacements, forces
        Of the struts, aft and fore: m and N.
    motion, loads
        Of the model about the midpoint: m and rad, N and N m.
    """

    displacements: ComplexArray
    motion: ComplexArray
    loads: ComplexArray
    forces: ComplexArray


def ideal_run(
    oscillator: Oscillator,
    set_point: SetPoint,
    body: Body,
    hull: LinearHull,
    orders: int = 1,
) -> IdealRun:
    """Return what an ideal rig would measure.

    Parameters
    ----------
    body
        The model; its mass and weight are added to those of ``hull``.
    hull
        The water's part; left out where the set-point's medium is air.

    Raises
    ------
    ConfigurationError
        As :func:`analysis.ideal_rig.strut_displacements`.
    """
    plane, half = oscillator.plane, oscillator.half_spacing_m
    struts = strut_displacements(oscillator, set_point, orders)
    moved = motion(struts, half, plane)
    water = hull if set_point.medium is Medium.WATER else LinearHull()
    whole = LinearHull(
        mass=water.mass + mass_matrix(body, plane),
        added_mass=water.added_mass,
        damping=water.damping,
        restoring=water.restoring + weight_matrix(body, plane, set_point.medium),
    )
    load = loads(whole, moved, set_point.frequency_hz, set_point.carriage_speed_m_s, plane)
    return IdealRun(struts, moved, load, strut_forces(load, half, plane))
