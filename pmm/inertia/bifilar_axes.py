"""Roll from tilted yaw tests, and the principal axes in the centre plane."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from analysis.inertia.elementary_functions import Value
from analysis.inertia.principal_axes import (
    principal_angle,
    principal_axes,
    principal_gyradii,
    roll_from_three_yaws,
    roll_from_tilts,
)
from analysis.uncertainty.budget import Formula
from analysis.uncertainty.estimate import Estimate
from analysis.uncertainty.monte_carlo import assess
from hardware.description.errors import ConfigurationError
from pmm.inertia.outcome import Finding, PlaneAxes, assessed
from pmm.inertia.sources import AngledPeriod

_WORDS = {
    "psi_rad": "principal x axis, from body x",
    "k_px_m": "principal gyradius near roll",
    "k_pz_m": "principal gyradius near yaw",
}


@dataclass(frozen=True)
class TiltedTable(AngledPeriod):
    """A yaw test of the tilted body: the axis' angle to body z, and the period.

    Lines and spacing are those of the level test unless given.
    """

    half_spacing_m: float | None = None
    u_half_spacing_m: float = 0.0
    line_m: float | None = None
    u_line_m: float = 0.0


def plane_axes(
    level: Estimate,
    roll: Estimate | None,
    tests: Sequence[tuple[Estimate, Estimate]],
    seed: int,
) -> tuple[list[Finding], PlaneAxes]:
    """Return the findings and the ellipse.

    Parameters
    ----------
    level, roll
        Yaw gyradius of the level body, and the roll gyradius if it was measured by itself.
    tests
        Angle and gyradius of each tilted yaw test.

    Raises
    ------
    ConfigurationError
        If the roll gyradius is not known and only one tilted test is there.
    """
    points = ((0.0, level), *((angle.value, gyradius) for angle, gyradius in tests))
    if roll is not None:
        (angle, tilted), *_ = tests
        found = principal_axes(roll, level, tilted, angle, seed=seed)
        trio = (found.angle, found.roll, found.yaw)
        rows = [assessed(n, _WORDS[n], one) for n, one in zip(_WORDS, trio, strict=True)]
        values = [one.budget.result.value for one in trio]
        points = (*points, (0.5 * math.pi, roll))
        return rows, PlaneAxes(values[1], values[2], values[0], points)
    if len(tests) < 2:
        raise ConfigurationError(
            "one tilted yaw test alone tells nothing; measure roll by itself, or tilt a second time"
        )
    (first_angle, first), (second_angle, second) = tests[:2]
    own = roll_from_three_yaws(level, first, second, first_angle, second_angle, seed=seed)
    inputs = {
        "level_m": level,
        "first_m": first,
        "second_m": second,
        "first_rad": first_angle,
        "second_rad": second_angle,
    }
    rows = [assessed("k_roll_m", "roll gyradius by three yaw tests", own)]
    for k, (name, formula) in enumerate(_FORMULAS.items()):
        unit = "rad" if name == "psi_rad" else "m"
        made = assess(name, formula, inputs, unit=unit, seed=seed + 1 + k)
        rows.append(assessed(name, _WORDS[name], made))
    psi, px, pz = (
        one.assessment.budget.result.value for one in rows[1:] if one.assessment is not None
    )
    return rows, PlaneAxes(px, pz, psi, points)


def _psi(
    level_m: Value, first_m: Value, second_m: Value, first_rad: Value, second_rad: Value
) -> Value:
    roll = roll_from_tilts(level_m, first_m, second_m, first_rad, second_rad)
    return principal_angle(roll, level_m, first_m, first_rad)


def _px(**given: Value) -> Value:
    return principal_gyradii(roll_from_tilts(**given), given["level_m"], _psi(**given))[0]


def _pz(**given: Value) -> Value:
    return principal_gyradii(roll_from_tilts(**given), given["level_m"], _psi(**given))[1]


_FORMULAS: dict[str, Formula] = {"psi_rad": _psi, "k_px_m": _px, "k_pz_m": _pz}
