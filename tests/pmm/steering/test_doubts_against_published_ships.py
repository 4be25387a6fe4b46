"""What ``pmm steering`` doubts: nothing of KVLCC2 and KCS, all that a wrong unit makes of them."""

import re
from dataclasses import replace
from pathlib import Path

import pytest

from analysis.steering.identification import identified
from pmm.steering.plausibility import BOUNDS, doubts
from tests.analysis.manoeuvring.published import Published, kcs, kvlcc2
from tests.analysis.steering.captive import KNOWN, known, runs

PAGE = Path(__file__).parents[3] / "docs" / "steering.md"


@pytest.mark.parametrize("ship", [kvlcc2, kcs])
def test_published_parameters_are_believed(ship: Published) -> None:
    assert list(doubts(identified(runs(None, ship=ship), known(ship)))) == []


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({"rudder_x_m": 3.5}, "x_H'"),
        ({"area_m2": KNOWN.area_m2 * 100.0}, "epsilon"),
        ({"length_m": KNOWN.length_m / 3.0}, "l_R'"),
    ],
)
def test_a_number_in_another_unit_or_place_is_doubted(change: dict[str, float], name: str) -> None:
    told = list(doubts(identified(runs(None), replace(KNOWN, **change))))
    assert any(one.startswith(f"{name} = ") for one in told), told


def test_what_the_runs_hardly_tell_is_not_doubted() -> None:
    found = identified(runs(None), replace(KNOWN, rudder_x_m=3.5))
    vague = replace(found, covariance=found.covariance + 100.0)
    assert list(doubts(vague)) == []


def test_the_page_has_the_table_of_bounds() -> None:
    page = PAGE.read_text(encoding="utf-8")
    for name, bound in BOUNDS.items():
        assert re.search(rf"\| {re.escape(name)} \| {bound.low:g} to {bound.high:g} \|", page), name
