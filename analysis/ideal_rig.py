"""Closed-form phasors of an ideal rig: motion of the struts and the model, its mass and weight.

Every quantity is a row of phasors, ``H[n]`` for the harmonic ``n = 0, 1, 2, ...`` of the shaft:

    y = sum over n of Im(H[n] exp(i n theta))          H[n] = S_n + i C_n,  n >= 1

The mean, which has no phase, is kept as ``H[0] = i A0``, so that the same sum holds. Arrays have
the shape ``(orders + 1, 2)``: (aft, fore), (translation, rotation) or (force, moment), about the
midpoint between the struts. Axes and signs are those of ``docs/conventions.md``. Nothing here is
simulated: theory stands on its own, beside the simulator and the measured harmonics.
"""

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.body import Body
from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Oscillator, Plane
from hardware.description.setpoint import Medium, SetPoint
from hardware.description.units import STANDARD_GRAVITY_M_S2


def mass_matrix(body: Body, plane: Plane) -> FloatArray:
    """Return the model's mass matrix about the midpoint: kg, kg m and kg m^2.

    The coupling is ``-m x_G`` for heave and pitch (bow up), ``+m x_G`` for sway and yaw.
    """
    arm = -body.cg_x_m if plane is Plane.VERTICAL else body.cg_x_m
    coupling = body.mass_kg * arm
    return np.array([[body.mass_kg, coupling], [coupling, body.inertia_kg_m2]])


def weight_matrix(body: Body, plane: Plane, medium: Medium) -> FloatArray:
    """Return what weight and buoyancy add to the restoring: a moment against pitch, in N m.

    It is ``m g z_G`` in air and of a model that floats, whose buoyancy is its hydrostatic
    restoring, and ``g (m z_G - m_displaced z_B)`` of a model below the surface.
    """
    lever = body.mass_kg * body.cg_z_m
    if medium is Medium.WATER and body.displaced_kg is not None:
        lever -= body.displaced_kg * body.buoyancy_z_m
    return np.diag([0.0, STANDARD_GRAVITY_M_S2 * lever if plane is Plane.VERTICAL else 0.0])


def held_at_rest_n(body: Body, oscillator: Oscillator, medium: Medium) -> FloatArray:
    """Return the struts' forces on a model at rest, aft and fore, in N: weight less buoyancy.

    What floats holds itself; in the horizontal plane nothing pulls.
    """
    floats = medium is Medium.WATER and body.displaced_kg is None
    if oscillator.plane is Plane.HORIZONTAL or floats:
        return np.zeros(2)
    mass_kg, moment = body.mass_kg, body.mass_kg * body.cg_x_m
    if medium is Medium.WATER and body.displaced_kg is not None:
        mass_kg -= body.displaced_kg
        moment -= body.displaced_kg * body.buoyancy_x_m
    ahead_kg = moment / oscillator.half_spacing_m
    return -0.5 * STANDARD_GRAVITY_M_S2 * np.array([mass_kg - ahead_kg, mass_kg + ahead_kg])


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

    and half of that for the mean (m = 0), before L is taken off. A motion of many lines has each at
    its own harmonic.

    They are phasors in m, of the shape ``(orders + 1, 2)``, columns aft and fore.

    Parameters
    ----------
    orders
        Highest harmonic.

    Raises
    ------
    ConfigurationError
        If the rod is not longer than the eccentricity, or ``orders`` is below 1.
    """
    if orders < 1:
        raise ConfigurationError(f"orders = {orders}; it must be 1 or more")
    displacements = np.zeros((orders + 1, 2), dtype=np.complex128)
    if set_point.lines:
        for line in set_point.lines:
            if line.order <= orders:
                displacements[line.order] += set_point.eccentricity_m * line.phasors
        return displacements
    angles = np.array([0.0, set_point.strut_phase_rad])
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
