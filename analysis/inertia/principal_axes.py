"""Principal axes in the centre plane and the inertia ellipse (eqs 3, 4, 25, 26 and 28).

``phi`` is the angle of an axis in the centre plane to the body's z axis; a body tilted by a pitch
angle turns about the axis at minus that angle. The principal x axis lies at ``psi`` to the body's.
"""

from dataclasses import dataclass

import numpy as np

from analysis.inertia.elementary_functions import Value, arctan, cos, sin, sqrt, tan
from analysis.uncertainty.estimate import Estimate, require_positive
from analysis.uncertainty.monte_carlo import Assessment, assess
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError


def principal_angle(roll_m: Value, yaw_m: Value, tilted_m: Value, axis_angle_rad: Value) -> Value:
    """Angle ``psi`` of the principal x axis from three gyradii (eq 4), within a quarter turn."""
    s, c = sin(axis_angle_rad), cos(axis_angle_rad)
    xx, zz = roll_m * roll_m, yaw_m * yaw_m
    product = tilted_m * tilted_m - xx * s * s - zz * c * c
    return 0.5 * arctan(product / ((xx - zz) * s * c))


def principal_gyradii(roll_m: Value, yaw_m: Value, angle_rad: Value) -> tuple[Value, Value]:
    """Principal gyradii ``(k_px, k_pz)`` from the body's own and the angle (eq 4)."""
    t2 = tan(angle_rad) * tan(angle_rad)
    xx, zz = roll_m * roll_m, yaw_m * yaw_m
    return sqrt((xx - zz * t2) / (1.0 - t2)), sqrt((zz - xx * t2) / (1.0 - t2))


def roll_from_tilts(
    level_m: Value, first_m: Value, second_m: Value, first_rad: Value, second_rad: Value
) -> Value:
    """Roll gyradius from three yaw tests: level, and about axes at two angles (eq 25).

    With the axes a right angle apart it is ``k_A^2 + k_B^2 - k_z^2`` (eq 26).
    """
    sa, sb = sin(first_rad), sin(second_rad)
    turned = first_m * first_m * sin(2.0 * second_rad) - second_m * second_m * sin(2.0 * first_rad)
    square = turned / (2.0 * sa * sb * sin(first_rad - second_rad))
    return sqrt(square + level_m * level_m / (tan(first_rad) * tan(second_rad)))


@dataclass(frozen=True)
class PrincipalAxes:
    """Principal axes in the centre plane: ``psi`` in rad, gyradii in m."""

    angle: Assessment
    roll: Assessment
    yaw: Assessment


def principal_axes(
    roll: Estimate, yaw: Estimate, tilted: Estimate, axis_angle: Estimate, *, seed: int = 0
) -> PrincipalAxes:
    """Return the principal axes from roll, yaw and one tilted yaw gyradius.

    Raises
    ------
    ConfigurationError
        For a gyradius that is not above zero.
    DataError
        If the axis is level or upright, which tells nothing, or the gyradii contradict each other.
    """
    require_positive("principal axes", roll_m=roll.value, yaw_m=yaw.value, tilted_m=tilted.value)
    if abs(np.sin(2.0 * axis_angle.value)) < 0.02:
        raise DataError(
            f"principal axes: an axis at {np.degrees(axis_angle.value):.2g} deg tells nothing "
            "beside the level and the upright one; tilt by 20 to 70 deg"
        )
    inputs = {
        "roll_m": roll,
        "yaw_m": yaw,
        "tilted_m": tilted,
        "axis_angle_rad": axis_angle,
    }

    def first(**gyradii: Value) -> Value:
        return principal_gyradii(gyradii["roll_m"], gyradii["yaw_m"], principal_angle(**gyradii))[0]

    def second(**gyradii: Value) -> Value:
        return principal_gyradii(gyradii["roll_m"], gyradii["yaw_m"], principal_angle(**gyradii))[1]

    return PrincipalAxes(
        assess("psi", principal_angle, inputs, unit="rad", seed=seed),
        assess("k_px", first, inputs, unit="m", seed=seed + 1),
        assess("k_pz", second, inputs, unit="m", seed=seed + 2),
    )


def roll_from_three_yaws(
    level: Estimate,
    first: Estimate,
    second: Estimate,
    first_angle: Estimate,
    second_angle: Estimate,
    *,
    seed: int = 0,
) -> Assessment:
    """Return the roll gyradius from three yaw tests with its budget (eq 25).

    Raises
    ------
    DataError
        If two of the three axes are the same, or the gyradii contradict each other.
    """
    angles = (first_angle.value, second_angle.value)
    if (
        min(abs(np.sin(angles[0])), abs(np.sin(angles[1])), abs(np.sin(angles[0] - angles[1])))
        < 0.1
    ):
        raise DataError(
            f"roll from yaws: axes at {np.degrees(angles[0]):.3g} and {np.degrees(angles[1]):.3g} "
            "deg are too near to each other or to the level one; tilt by 20 deg or more either way"
        )
    inputs = {
        "level_m": level,
        "first_m": first,
        "second_m": second,
        "first_rad": first_angle,
        "second_rad": second_angle,
    }
    return assess("k_roll", roll_from_tilts, inputs, unit="m", seed=seed)


def inertia_ellipse(px_m: float, pz_m: float, angle_rad: float, points: int = 181) -> FloatArray:
    """Points ``(x, z)`` of the inertia ellipse in body axes, shape ``(points, 2)``, in 1/m.

    The radius in a direction is the inverse of the gyradius about it.
    """
    directions = np.linspace(0.0, 2.0 * np.pi, points)
    turned = directions + angle_rad
    radius = 1.0 / np.hypot(px_m * np.sin(turned), pz_m * np.cos(turned))
    return np.column_stack([radius * np.sin(directions), radius * np.cos(directions)])
