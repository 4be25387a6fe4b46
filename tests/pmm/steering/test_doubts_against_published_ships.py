"""What ``pmm steering`` doubts: nothing of KVLCC2 and KCS, all that a wrong unit makes of them."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analysis.steering.identification import identified
from analysis.steering.observations import Particulars, SteeringRuns
from pmm.steering.plausibility import BOUNDS, doubts
from tests.analysis.manoeuvring.published import Published, kcs, kvlcc2
from tests.analysis.steering.captive import KNOWN, STRAIGHT, known, runs

PAGE = Path(__file__).parents[3] / "docs" / "steering.md"


def told(seen: SteeringRuns, drawn: Particulars) -> list[str]:
    return list(doubts(identified(seen, drawn), seen, drawn))


@pytest.mark.parametrize("ship", [kvlcc2, kcs])
def test_published_parameters_are_believed(ship: Published) -> None:
    assert told(runs(None, ship=ship), known(ship)) == []


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({"rudder_x_m": 3.5}, "x_H'"),
        ({"area_m2": KNOWN.area_m2 * 100.0}, "epsilon"),
        ({"length_m": KNOWN.length_m / 3.0}, "l_R'"),
    ],
)
def test_a_number_in_another_unit_or_place_is_doubted(change: dict[str, float], name: str) -> None:
    several = told(runs(None), replace(KNOWN, **change))
    assert any(one.startswith(f"{name} = ") for one in several), several


X, Y, N, THRUST, NORMAL = range(5)  # rows of what a run measures


@pytest.mark.parametrize("ship", [kvlcc2, kcs])
@pytest.mark.parametrize(
    ("rows", "rudder", "named"),
    [
        ((X,), 1.0, "force_x is not positive ahead"),
        ((THRUST,), 1.0, "propeller_thrust is not positive ahead"),
        ((), -1.0, "rudder_angle is not positive to turn to starboard"),
        ((NORMAL,), 1.0, "rudder_normal_force is not positive to port"),
        ((NORMAL,), -1.0, "rudder_angle and rudder_normal_force are those of a rudder"),
        ((Y, N), 1.0, "the struts' forces are not positive to starboard"),
        ((Y, N, NORMAL), -1.0, "drift is not positive with the bow to starboard"),
    ],
)
def test_a_turned_sign_is_named_alone(
    ship: Published, rows: tuple[int, ...], rudder: float, named: str
) -> None:
    """With errors drawn for every gauge, so that none of it rests on exact numbers."""
    seen = runs(np.random.default_rng(1963), ship=ship)
    values = seen.values.copy()
    values[list(rows)] *= -1.0
    turned = replace(seen, values=values, rudder_rad=rudder * seen.rudder_rad)
    (said,) = told(turned, known(ship))
    assert f"below 0, as where {named}" in said
    assert said.endswith("turn that sign")


def test_a_drift_with_the_other_sign_is_asked_after_where_runs_turn() -> None:
    seen = runs(np.random.default_rng(1963))
    turned = np.diag([1.0, -1.0, 1.0]) @ seen.motion
    said = told(replace(seen, motion=turned), KNOWN)
    (inflow,) = [one for one in said if one.startswith("misfit of the inflow")]
    assert "are drift (bow to starboard), turn rate and rudder angle" in inflow


def test_without_oblique_tows_either_sign_that_does_it_is_named() -> None:
    seen = runs(None, tuple(STRAIGHT))
    values = seen.values.copy()
    values[[Y, N]] *= -1.0
    (said,) = told(replace(seen, values=values), KNOWN)
    assert "of a rudder that is positive to port, or the struts' forces are not positive" in said


@pytest.mark.parametrize(
    ("key", "factor", "named"),
    [
        ("rate_hz", 60.0, "are revolutions in 1/s? Give rpm / 60 as revolutions_hz"),
        ("rudder_rad", 57.3, "is rudder_angle_deg in degrees"),
        ("rudder_rad", 1.0 / 57.3, "is rudder_angle_deg in degrees"),
    ],
)
def test_a_stated_number_in_another_unit_is_named_first(
    key: str, factor: float, named: str
) -> None:
    seen = runs(None)
    first, *_ = told(replace(seen, **{key: factor * getattr(seen, key)}), KNOWN)
    assert named in first


def test_what_the_runs_hardly_tell_is_not_doubted() -> None:
    found = identified(runs(None), replace(KNOWN, rudder_x_m=3.5))
    vague = replace(found, covariance=found.covariance + 100.0)
    assert list(doubts(vague, runs(None), KNOWN)) == []


def test_the_page_has_the_table_of_bounds() -> None:
    page = PAGE.read_text(encoding="utf-8")
    for name, bound in BOUNDS.items():
        assert re.search(rf"\| {re.escape(name)} \| {bound.low:g} to {bound.high:g} \|", page), name
