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


def centre_of_lines(lines: Sequence[PlumbLine], *, what: str = "plumb lines") -> HangingCentre:
    """Return where plumb lines cross, by least squares.

    Raises
    ------
    DataError
        For fewer than two lines, or lines that are nearly parallel.
    """
    angles = np.array([one.angle.value for one in lines])
    apart = np.abs(np.sin(angles[:, None] - angles))
    if len(lines) < 2 or apart.max() < _SPREAD:
        at = ", ".join(f"{angle:.3g}" for angle in np.degrees(angles))
        raise DataError(
            f"{what}: {len(lines)} lines, at {at} deg; two or more are needed that cross at 6 deg "
            "or more: hang the body from another point"
        )
    whole = joint([value for one in lines for value in (one.x, one.z, one.angle)])
    x, z, _ = whole.values.reshape(-1, 3).T
    s, c = np.sin(angles), np.cos(angles)
    matrix, crossing = np.column_stack([c, -s]), x * c - z * s
    at_x, at_z = np.linalg.lstsq(matrix, crossing, rcond=None)[0]
    slope = np.zeros((len(lines), whole.values.size))
    for k in range(len(lines)):
        below = (at_x - x[k]) * s[k] + (at_z - z[k]) * c[k]
        slope[k, 3 * k : 3 * k + 3] = c[k], -s[k], below
    seen = whole.carried(crossing, slope)
    names = [one.name for one in lines]
    found, agreement = best_fit(matrix, seen, what=what, results=IN_PLANE, data=names)
    ahead, down = (Estimate(found.taken([k]), "m") for k in (0, 1))
    return HangingCentre(ahead, down, agreement)
