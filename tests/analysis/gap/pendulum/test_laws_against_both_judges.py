"""Which laws of damping can be told apart: what the record as a whole says, and withheld swings."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import pytest

from analysis.gap.pendulum.verdict import TOLD_APART, Law, open_laws, told_apart
from analysis.inertia.spread import SURE, cause_statement

if TYPE_CHECKING:
    from analysis.gap.pendulum.hypothesis import Hypothesis


@dataclass
class Named:
    """As much of a hypothesis as a law's standing needs."""

    names: tuple[str, ...]


def law(name: str, log_ratio: float, *withheld: float) -> Law:
    return Law(name, cast("Hypothesis", Named((name,))), log_ratio, withheld)


BEST = law("linear and cubic", 0.0, 5.1, 21.5)
FAR = -math.log(TOLD_APART) - 1.0


@pytest.mark.parametrize(
    ("other", "apart"),
    [
        (law("within a factor of 20", -math.log(TOLD_APART) + 0.1, 9.0, 30.0), False),
        (law("behind in both", FAR, 5.2, 21.6), True),
        (law("behind, but foretells small swings better", FAR, 3.4, 30.0), False),
        (law("behind, but foretells large swings better", FAR, 9.0, 9.8), False),
        (law("behind, foretells better by a chance of noise", FAR, 5.0, 21.4), True),
        (law("far behind, not asked", -100.0), True),
        (BEST, False),
    ],
    ids=lambda one: one.name if isinstance(one, Law) else "",
)
def test_both_have_to_say_so(other: Law, apart: bool) -> None:
    assert told_apart(BEST, other) is apart
    assert (other in open_laws((BEST, other))) is not apart


@pytest.mark.parametrize("share", [-0.2, 0.0, 0.5, SURE - 1e-3])
def test_a_cause_that_foretells_little_is_not_named(share: float) -> None:
    said = cause_statement("line_twist", share)
    assert said.startswith("the cause cannot be told; likeliest cause: line_twist")
    assert f"accounts for {100.0 * max(share, 0.0):.0f} %" in said


def test_a_cause_that_foretells_most_is_named() -> None:
    assert cause_statement("line_twist", 0.93).startswith(
        "the cause: line_twist, which predicts 93 %"
    )
