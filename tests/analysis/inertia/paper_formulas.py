"""Formulas of the swing and bifilar papers that tests need and the product does not."""

import math

from analysis.inertia.elementary_functions import Value, cos, sin, sqrt


def average_period(yaw_s: Value, sway_s: Value) -> Value:
    """Period of the oscillation within the beats: ``2 T_y T_s/(T_y + T_s)`` (eq 10)."""
    return 2.0 * yaw_s * sway_s / (yaw_s + sway_s)


def oscillations_per_beat(yaw_s: Value, sway_s: Value) -> Value:
    """Return ``n = T_b/T_a`` (eq 12)."""
    return (yaw_s + sway_s) / (2.0 * (yaw_s - sway_s))


def pendulum_period(gyradius_m: Value, depth_m: Value, gravity_m_s2: Value) -> Value:
    """Period of a body whose centre of gravity hangs ``depth_m`` below the axis (eq 22)."""
    square = gyradius_m * gyradius_m + depth_m * depth_m
    return 2.0 * math.pi * sqrt(square / (depth_m * gravity_m_s2))


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


def gyradius_about(px_m: Value, pz_m: Value, angle_rad: Value) -> Value:
    """Gyradius about an axis in the centre plane at an angle to the principal z axis (eq 3)."""
    along = px_m * sin(angle_rad)
    across = pz_m * cos(angle_rad)
    return sqrt(along * along + across * across)


def mass_equivalent_ellipsoid(px_m: Value, py_m: Value, pz_m: Value) -> tuple[Value, Value, Value]:
    """Semi-axes ``(a, b, c)`` of the ellipsoid of the same mass and inertia."""
    xx, yy, zz = px_m * px_m, py_m * py_m, pz_m * pz_m
    return sqrt(2.5 * (yy + zz - xx)), sqrt(2.5 * (zz + xx - yy)), sqrt(2.5 * (xx + yy - zz))
