"""Closed-form phasors of an ideal rig: motion of the struts and the model, forces of a linear hull.

Every quantity is a row of phasors, ``H[n]`` for the harmonic ``n = 0, 1, 2, ...`` of the shaft:

    y = sum over n of Im(H[n] exp(i n theta))          H[n] = S_n + i C_n,  n >= 1

The mean, which has no phase, is kept as ``H[0] = i A0``, so that the same sum holds. Arrays have
the shape ``(orders + 1, 2)``: (aft, fore), (translation, rotation) or (force, moment), about the
midpoint between the struts. Axes and signs are those of ``docs/conventions.md``. Nothing here is
simulated: theory stands on its own, beside the simulator and the measured harmonics.
"""

import math
from dataclasses import dataclass, field

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.body import Body
from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Oscillator, Plane
from hardware.description.setpoint import Medium, SetPoint
from hardware.description.struts import to_motion, to_strut_forces
from hardware.description.units import STANDARD_GRAVITY_M_S2


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
        Of the model: kg, kg m and kg m^2 (see :func:`mass_matrix`).
    added_mass, damping
        Per acceleration and velocity through the water, in SI units.
    restoring
        Per displacement: buoyancy and the weight's part (see :func:`weight_matrix`).
    """

    mass: FloatArray = field(default_factory=_nothing)
    added_mass: FloatArray = field(default_factory=_nothing)
    damping: FloatArray = field(default_factory=_nothing)
    restoring: FloatArray = field(default_factory=_nothing)


def mass_matrix(body: Body, plane: Plane) -> FloatArray:
    """Return the model's mass matrix about the midpoint: kg, kg m and kg m^2.

    The coupling is ``-m x_G`` for heave and pitch (bow up), ``+m x_G`` for sway and yaw.
    """
    arm = -body.cg_x_m if plane is Plane.VERTICAL else body.cg_x_m
    coupling = body.mass_kg * arm
    return np.array([[body.mass_kg, coupling], [coupling, body.inertia_kg_m2]])


def weight_matrix(body: Body, plane: Plane) -> FloatArray:
    """Return what the weight adds to the restoring: ``m g z_G`` against pitch, else nothing."""
    against_pitch = body.mass_kg * STANDARD_GRAVITY_M_S2 * body.cg_z_m
    return np.diag([0.0, against_pitch if plane is Plane.VERTICAL else 0.0])


def incidence(plane: Plane) -> FloatArray:
    """Return E of ``v = q' + U E q``: +1 for pitch on w, -1 for yaw on v."""
    return np.array([[0.0, 1.0 if plane is Plane.VERTICAL else -1.0], [0.0, 0.0]])


def strut_displacements(
    oscillator: Oscillator, set_point: SetPoint, orders: int = 1
) -> ComplexArray:
    """Return the displacement of both struts that a set-point asks for.

    A scotch yoke gives ``e sin(theta + phi)`` and nothing else. A crank with a rod of length L adds
    ``sqrt(L^2 - e^2 cos^2) - L``, whose Fourier coefficients are, with ``k = e/L``,

        cos(2 m psi):  2 L binom(1/2, m) (-k^2/4)^m 2F1(m - 1/2, m + 1/2; 2m + 1; k^2)

    and half of that for the mean (m = 0), before L is taken off.

    Parameters
    ----------
    orders
        Highest harmonic.

    Returns
    -------
    numpy.ndarray
        Phasors in m, shape ``(orders + 1, 2)``, columns aft and fore.

    Raises
    ------
    ConfigurationError
        If the rod is not longer than the eccentricity, or ``orders`` is below 1.
    """
    if orders < 1:
        raise ConfigurationError(f"orders = {orders}; it must be 1 or more")
    angles = np.array([0.0, set_point.strut_phase_rad])
    displacements = np.zeros((orders + 1, 2), dtype=np.complex128)
    displacements[1] = set_point.eccentricity_m * np.exp(1j * angles)
    if oscillator.rod_length_m is None:
        return displacements
    rod = rod_series(set_point.eccentricity_m, oscillator.rod_length_m, orders // 2)
    for m, amplitude in enumerate(rod):
        displacements[2 * m] += 1j * amplitude * np.exp(2j * m * angles)  # cos x = Im(i exp(i x))
    return displacements


def rod_series(eccentricity_m: float, rod_length_m: float, terms: int) -> FloatArray:
    """Return the amplitudes of ``cos(2 m psi)`` of a finite rod, m = 0 to ``terms``, in m.

    Raises
    ------
    ConfigurationError
        If the rod is not longer than the eccentricity: the crank could not turn.
    """
    from scipy.special import binom, hyp2f1

    if not rod_length_m > eccentricity_m:
        raise ConfigurationError(
            f"rod_length_m = {rod_length_m:g} must exceed eccentricity_m = {eccentricity_m:g}: "
            "the crank could not turn"
        )
    square = (eccentricity_m / rod_length_m) ** 2
    m = np.arange(terms + 1)
    series = 2.0 * binom(0.5, m) * (-square / 4.0) ** m
    series = rod_length_m * series * hyp2f1(m - 0.5, m + 0.5, 2 * m + 1, square)
    series[0] = series[0] / 2.0 - rod_length_m
    return np.asarray(series, dtype=np.float64)


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
        As :func:`strut_displacements`.
    """
    plane, half = oscillator.plane, oscillator.half_spacing_m
    struts = strut_displacements(oscillator, set_point, orders)
    moved = motion(struts, half, plane)
    water = hull if set_point.medium is Medium.WATER else LinearHull()
    whole = LinearHull(
        mass=water.mass + mass_matrix(body, plane),
        added_mass=water.added_mass,
        damping=water.damping,
        restoring=water.restoring + weight_matrix(body, plane),
    )
    load = loads(whole, moved, set_point.frequency_hz, set_point.carriage_speed_m_s, plane)
    return IdealRun(struts, moved, load, strut_forces(load, half, plane))
