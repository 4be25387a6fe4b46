"""What turns an observed period or inertia into the body's own."""

import math

from analysis.inertia.numeric import Value, sqrt


def gravity_in_air(gravity_m_s2: Value, air_kg_m3: Value, body_kg_m3: Value) -> Value:
    """Gravity less buoyancy, ``g (1 - rho_air/rho_body)``; it drops out of period ratios."""
    return gravity_m_s2 * (1.0 - air_kg_m3 / body_kg_m3)


def undamped(period_s: Value, decay_1_s: Value) -> Value:
    """Period without damping, ``T/sqrt(1 + (lambda T/(2 pi))^2)``."""
    product = decay_1_s * period_s / (2.0 * math.pi)
    return period_s / sqrt(1.0 + product * product)


def pendulum_at_no_amplitude(period_s: Value, amplitude_rad: Value) -> Value:
    """Period of a pendulum at no amplitude, ``T/(1 + A^2/16)``."""
    return period_s / (1.0 + amplitude_rad * amplitude_rad / 16.0)


def bifilar_amplitude_factor(
    amplitude_rad: Value, gyradius_m: Value, half_spacing_m: Value, line_m: Value
) -> Value:
    """Yaw period at an amplitude over that at none, to its square.

    With s = d/l: ``1 + A^2 (1/16 - 3 s^2/16 + s^2 (d/k)^2/4)``, from the lines' exact height
    ``sqrt(l^2 - 4 d^2 sin^2(A/2))`` (first two terms) and the kinetic energy of the heave that goes
    with it (third).
    """
    slope = half_spacing_m / line_m
    reach = half_spacing_m / gyradius_m
    square = slope * slope
    factor = 1.0 / 16.0 - 3.0 / 16.0 * square + 0.25 * square * reach * reach
    return 1.0 + amplitude_rad * amplitude_rad * factor


def without_entrained_air(
    inertia_kg_m2: Value, displaced_air_kg: Value, coefficient: Value, gyradius_m: Value
) -> Value:
    """Inertia less the air's that swings along.

    Parameters
    ----------
    displaced_air_kg
        Mass of the air that the body displaces.
    coefficient
        Added mass over displaced mass for this motion, by shape: 0.2 to 1 and more across.
    gyradius_m
        Of the displaced volume about the axis.
    """
    return inertia_kg_m2 - coefficient * displaced_air_kg * gyradius_m * gyradius_m


def square_frame(half_side_m: Value, depth_m: Value) -> tuple[Value, Value]:
    """Gyradii of a square frame of side 2d about the body's centre of gravity (eq 27).

    Parameters
    ----------
    depth_m
        ``l_2``, of the centre of gravity below the frame.

    Returns
    -------
    level, upright
        About an axis along a side, and about the vertical.
    """
    square = half_side_m * half_side_m
    return sqrt(depth_m * depth_m + 2.0 * square / 3.0), 2.0 * half_side_m / math.sqrt(3.0)


def gyradius_with_end_masses(
    mass_kg: Value,
    gyradius_m: Value,
    added_kg: Value,
    forward_m: Value,
    aft_m: Value,
) -> Value:
    """Gyradius about the joint centre of gravity with equal masses fore and aft (figs 7, 18)."""
    total = mass_kg + 2.0 * added_kg
    shift = added_kg * (forward_m - aft_m) / total
    inertia = mass_kg * gyradius_m * gyradius_m + added_kg * (forward_m * forward_m + aft_m * aft_m)
    return sqrt(inertia / total - shift * shift)
