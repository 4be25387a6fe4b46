"""Corrections of an observed period or inertia for air, lines and the test's frame."""

import math

from analysis.inertia.elementary_functions import Value, sqrt


def gravity_in_air(gravity_m_s2: Value, air_kg_m3: Value, body_kg_m3: Value) -> Value:
    """Gravity less buoyancy, ``g (1 - rho_air/rho_body)``; it drops out of period ratios."""
    return gravity_m_s2 * (1.0 - air_kg_m3 / body_kg_m3)


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


def lines_factor(line_share: Value) -> Value:
    """Square of the period of a mass on heavy lines over that on light ones of the same length.

    ``(1 + mu/3)/(1 + mu/2)``: the lines' inertia against their weight, each line as a rod. A
    string's own bend changes a gyradius by 1.2e-4 at mu = 0.05 and by 4.3e-4 at 0.1, for gyradii
    between half and twice the half spacing.

    Parameters
    ----------
    line_share
        ``mu``, mass of all lines over that of what hangs from them.
    """
    return (1.0 + line_share / 3.0) / (1.0 + line_share / 2.0)


def yaw_without_lines(
    gyradius_m: Value, line_share: Value, half_spacing_m: Value, *, by_sway: bool
) -> Value:
    """Yaw gyradius less what the lines' own mass does to it.

    By the period ``k^2 (1 + mu/2) - mu d^2/3``, by a ratio to sway ``k^2 (1 + mu/3) - mu d^2/3``.

    Parameters
    ----------
    gyradius_m
        As it follows for lines without mass.
    line_share
        See :func:`lines_factor`.
    by_sway
        Whether it comes from a ratio to sway, on which the lines' weight acts as on yaw.
    """
    square = gyradius_m * gyradius_m * (1.0 + line_share / (3.0 if by_sway else 2.0))
    return sqrt(square - line_share * half_spacing_m * half_spacing_m / 3.0)


def pitch_without_lines(
    gyradius_m: Value, depth_m: Value, line_share: Value
) -> tuple[Value, Value]:
    """Pitch gyradius and depth less what the lines' own mass does to them: exact for rods.

    With ``a = 1 + mu/3``: ``a l_2`` and ``sqrt(a k^2 - a (a - 1) l_2^2)``, from the two modes of
    ``a l_1 phi_1'' + l_2 phi_2'' + (1 + mu/2) g phi_1 = 0`` and the lines' own period.

    Parameters
    ----------
    gyradius_m, depth_m
        As they follow for lines without mass.
    """
    a = 1.0 + line_share / 3.0
    return sqrt(a * gyradius_m * gyradius_m - a * (a - 1.0) * depth_m * depth_m), a * depth_m


def square_frame(half_side_m: Value, depth_m: Value) -> tuple[Value, Value]:
    """Gyradii of a square frame of side 2d about the body's centre of gravity (eq 27).

    The results are level, upright: about an axis along a side, and about the vertical.

    Parameters
    ----------
    depth_m
        ``l_2``, of the centre of gravity below the frame.
    """
    square = half_side_m * half_side_m
    return sqrt(depth_m * depth_m + 2.0 * square / 3.0), 2.0 * half_side_m / math.sqrt(3.0)
