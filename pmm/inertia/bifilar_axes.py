"""Roll from tilted yaw tests, and the principal axes in the centre plane."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from analysis.inertia.elementary_functions import Value, arctan, cos, sqrt
from analysis.inertia.plane_inertia import plane_inertia
from analysis.inertia.principal_axes import (
    principal_angle,
    principal_axes,
    principal_gyradii,
    roll_from_three_yaws,
    roll_from_tilts,
)
from analysis.uncertainty.budget import Formula
from analysis.uncertainty.estimate import Estimate, exactly
from analysis.uncertainty.monte_carlo import assess
from analysis.uncertainty.redundancy import Redundancy
from hardware.description.errors import ConfigurationError
from pmm.inertia.outcome import Finding, PlaneAxes, assessed
from pmm.inertia.period_source import AngledPeriod

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
) -> tuple[list[Finding], PlaneAxes, tuple[Redundancy, ...]]:
    """Return the findings, the ellipse, and how tests agree that are more than three.

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
    if len(tests) + (roll is not None) > 2:
        return _from_many(level, roll, tests, seed)
    if roll is not None:
        (angle, tilted), *_ = tests
        principal = principal_axes(roll, level, tilted, angle, seed=seed)
        trio = (principal.angle, principal.roll, principal.yaw)
        rows = [
            assessed(n, _WORDS[n], assessment) for n, assessment in zip(_WORDS, trio, strict=True)
        ]
        values = [assessment.budget.result.value for assessment in trio]
        points = (*points, (0.5 * math.pi, roll))
        return rows, PlaneAxes(values[1], values[2], values[0], points), ()
    if len(tests) < 2:
        raise ConfigurationError(
            "one tilted yaw test alone tells nothing; measure roll by itself, or tilt a second time"
        )
    (first_angle, first), (second_angle, second) = tests[:2]
    roll_by_yaws = roll_from_three_yaws(level, first, second, first_angle, second_angle, seed=seed)
    inputs = {
        "level_m": level,
        "first_m": first,
        "second_m": second,
        "first_rad": first_angle,
        "second_rad": second_angle,
    }
    rows = [assessed("k_roll_m", "roll gyradius by three yaw tests", roll_by_yaws)]
    for k, (name, formula) in enumerate(_FORMULAS.items()):
        unit = "rad" if name == "psi_rad" else "m"
        made = assess(name, formula, inputs, unit=unit, seed=seed + 1 + k)
        rows.append(assessed(name, _WORDS[name], made))
    psi, px, pz = (
        row.assessment.budget.result.value for row in rows[1:] if row.assessment is not None
    )
    return rows, PlaneAxes(px, pz, psi, points), ()


def _from_many(
    level: Estimate,
    roll: Estimate | None,
    tests: Sequence[tuple[Estimate, Estimate]],
    seed: int,
) -> tuple[list[Finding], PlaneAxes, tuple[Redundancy, ...]]:
    """Fit the squares of all gyradii in the plane (eqs 3 and 4 for any number of axes)."""
    rows = [(exactly(0.0, "rad"), level), *tests]
    if roll is not None:
        rows.append((exactly(0.5 * math.pi, "rad"), roll))
    squares = [gyradius.following(gyradius.value**2, 2.0 * gyradius.value) for _, gyradius in rows]
    plane = plane_inertia(squares, [angle for angle, _ in rows], results=_SQUARES)
    inputs = {name: plane.estimate(k) for k, name in enumerate(_SQUARES)}
    formulas = _OF_SQUARES if roll is None else _OF_SQUARES[1:]
    findings = [
        assessed(name, words, assess(name, formula, inputs, unit=unit, seed=seed + k))
        for k, (name, words, unit, formula) in enumerate(formulas)
    ]
    psi, px, pz = (finding.estimate.value for finding in findings[-3:])
    points = tuple((angle.value, gyradius) for angle, gyradius in rows)
    agreement = plane.redundancy.of(
        ("k_roll_m", "k_yaw_m"), lambda values: np.sqrt(values[..., :2])
    )
    return findings, PlaneAxes(px, pz, psi, points), (agreement,)


_SQUARES = ("roll_square_m2", "yaw_square_m2", "product_m2")


def _roll_of(roll_square_m2: Value, **_others: Value) -> Value:
    return sqrt(roll_square_m2)


def _psi_of(roll_square_m2: Value, yaw_square_m2: Value, product_m2: Value) -> Value:
    return 0.5 * arctan(2.0 * product_m2 / (yaw_square_m2 - roll_square_m2))


def _px_of(**squares: Value) -> Value:
    return sqrt(_principal(squares)[0])


def _pz_of(**squares: Value) -> Value:
    return sqrt(_principal(squares)[1])


def _principal(squares: Mapping[str, Value]) -> tuple[Value, Value]:
    """Return both principal squares, each near its own axis."""
    double = 2.0 * _psi_of(**squares)
    middle = 0.5 * (squares["roll_square_m2"] + squares["yaw_square_m2"])
    half = 0.5 * (squares["yaw_square_m2"] - squares["roll_square_m2"]) / cos(double)
    return middle - half, middle + half


_OF_SQUARES: tuple[tuple[str, str, str, Formula], ...] = (
    ("k_roll_m", "roll gyradius by tilted yaw tests", "m", _roll_of),
    ("psi_rad", _WORDS["psi_rad"], "rad", _psi_of),
    ("k_px_m", _WORDS["k_px_m"], "m", _px_of),
    ("k_pz_m", _WORDS["k_pz_m"], "m", _pz_of),
)


def _psi(
    level_m: Value, first_m: Value, second_m: Value, first_rad: Value, second_rad: Value
) -> Value:
    roll = roll_from_tilts(level_m, first_m, second_m, first_rad, second_rad)
    return principal_angle(roll, level_m, first_m, first_rad)


def _px(**inputs: Value) -> Value:
    return principal_gyradii(roll_from_tilts(**inputs), inputs["level_m"], _psi(**inputs))[0]


def _pz(**inputs: Value) -> Value:
    return principal_gyradii(roll_from_tilts(**inputs), inputs["level_m"], _psi(**inputs))[1]


_FORMULAS: dict[str, Formula] = {"psi_rad": _psi, "k_px_m": _px, "k_pz_m": _pz}
