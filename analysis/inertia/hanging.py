"""The centre of gravity from plumb lines: a body that hangs from a point has it below that point.

In the x-z plane the line through (x, z) at an angle a from body z (down) towards body x has the
centre of gravity (X, Z) on it:

    X cos a - Z sin a = x cos a - z sin a

Two lines determine it, more check it. An error of an angle counts by the distance to the centre of
gravity.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from analysis.uncertainty.estimate import Estimate, joint
from analysis.uncertainty.redundancy import Redundancy, best_fit
from hardware.description.errors import DataError

IN_PLANE = ("cg_x_m", "cg_z_m")
_SPREAD = 0.1  # sine of the angle between lines that are too near to each other


@dataclass(frozen=True)
class PlumbLine:
    """A plumb line on the body: a point of it forward and down, m, and its angle, rad."""

    name: str
    x: Estimate
    z: Estimate
    angle: Estimate


@dataclass(frozen=True)
class HangingCentre:
    """The centre of gravity in the x-z plane, m, and how more than two lines agree."""

    x: Estimate
    z: Estimate
    redundancy: Redundancy


def centre_of_lines(lines: Sequence[PlumbLine], *, subject: str = "plumb lines") -> HangingCentre:
    """Return where plumb lines cross, by least squares.

    Raises
    ------
    DataError
        For fewer than two lines, or lines that are nearly parallel.
    """
    angles = np.array([line.angle.value for line in lines])
    crossing_sines = np.abs(np.sin(angles[:, None] - angles))
    if len(lines) < 2 or crossing_sines.max() < _SPREAD:
        degrees = ", ".join(f"{angle:.3g}" for angle in np.degrees(angles))
        raise DataError(
            f"{subject}: {len(lines)} lines, at {degrees} deg; two or more are needed that cross "
            "at 6 deg or more: hang the body from another point"
        )
    inputs = joint([value for line in lines for value in (line.x, line.z, line.angle)])
    x, z, _ = inputs.values.reshape(-1, 3).T
    s, c = np.sin(angles), np.cos(angles)
    matrix, crossing = np.column_stack([c, -s]), x * c - z * s
    at_x, at_z = np.linalg.lstsq(matrix, crossing, rcond=None)[0]
    slope = np.zeros((len(lines), inputs.values.size))
    for k in range(len(lines)):
        below = (at_x - x[k]) * s[k] + (at_z - z[k]) * c[k]
        slope[k, 3 * k : 3 * k + 3] = c[k], -s[k], below
    crossings = inputs.carried(crossing, slope)
    names = [line.name for line in lines]
    crossing_point, agreement = best_fit(
        matrix, crossings, subject=subject, results=IN_PLANE, data=names
    )
    ahead, down = (Estimate(crossing_point.select([k]), "m") for k in (0, 1))
    return HangingCentre(ahead, down, agreement)
