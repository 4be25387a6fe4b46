"""Which laws of damping can be told apart, and which causes are named."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import pytest

from analysis.gap.pendulum.laws import DampingLaw, open_laws
from analysis.gap.pendulum.verdict import TOLD_APART
from analysis.inertia.spread import cause_statement

if TYPE_CHECKING:
    from analysis.gap.search.fit import Fit


@dataclass
class Named:
    """As much of a fit as a law's standing needs."""

    names: tuple[str, ...]


def law(name: str, log_ratio: float, *withheld: float) -> DampingLaw:
    return DampingLaw(name, cast("Fit", Named((name,))), log_ratio, withheld)


BEST = law("linear and cubic", 0.0, 5.1, 21.5)
FACTOR = -math.log(TOLD_APART)


@pytest.mark.parametrize(
    ("other", "apart"),
    [
        (law("within a factor of 20", FACTOR + 0.1, 9.0, 30.0), False),
        (law("behind, whatever it foretells", FACTOR - 0.1, 3.4, 9.8), True),
        (law("far behind, not asked", -100.0), True),
    ],
    ids=lambda one: one.name if isinstance(one, DampingLaw) else "",
)
def test_odds_tell_laws_apart(other: DampingLaw, apart: bool) -> None:
    assert other.told_apart is apart
    assert (other in open_laws((BEST, other))) is not apart


@pytest.mark.parametrize("share", [-0.2, 0.0, 0.5])
def test_a_cause_that_is_not_told_is_the_likeliest(share: float) -> None:
    said = cause_statement("line_twist", share, certain=False)
    assert said.startswith("the cause cannot be told; likeliest cause: line_twist")
    assert f"accounts for {100.0 * max(share, 0.0):.0f} %" in said


def test_a_cause_that_is_told_is_named() -> None:
    said = cause_statement("line_twist", 0.93, certain=True)
    assert said.startswith("the cause: line_twist, which predicts 93 %")
