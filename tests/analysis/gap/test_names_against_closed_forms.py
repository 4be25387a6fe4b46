"""What a name deserves, and how sure it is: against closed forms and what must hold of odds."""

import math
from types import SimpleNamespace
from typing import TYPE_CHECKING, cast

import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.gap.hypotheses import Named
from analysis.gap.verdict import (
    DEMANDED,
    NONE,
    TEMPER,
    TOLERATED,
    UNKNOWN,
    deserved,
    tempered,
)

if TYPE_CHECKING:
    from analysis.gap.fit import Fit
    from analysis.gap.unknown import Deviation

SHARES = st.lists(st.floats(1e-12, 1.0), min_size=2, max_size=8)


def named(remainder: float, *names: str) -> Named:
    fit = cast("Fit", SimpleNamespace(names=names or ("friction",)))
    return Named(fit, 0.0, remainder, cast("Deviation", None))


def answers(shares: list[float]) -> dict[str, float]:
    whole = sum(shares)
    names = (NONE, UNKNOWN, *(f"effect-{number}" for number in range(len(shares))))
    return {
        name: share / whole for name, share in zip(names, shares, strict=False) if share / whole
    }


def test_a_name_that_leaves_as_much_as_is_tolerated_is_worth_half() -> None:
    assert deserved(named(TOLERATED), 0.0) == pytest.approx(0.5)
    assert deserved(named(0.99), DEMANDED) == pytest.approx(0.5, abs=0.01)
    assert deserved(named(1.01), 1e6) < 0.01
    assert deserved(named(0.0), 0.0) == pytest.approx(1.0)
    assert deserved(named(TOLERATED, "one", "other"), 0.0) == pytest.approx(0.4)


@given(st.floats(0.01, 10.0), st.floats(0.01, 10.0), st.floats(0.0, 200.0), st.floats(0.0, 200.0))
def test_less_left_and_more_demanded_never_costs_a_name(
    left: float, more: float, margin: float, wider: float
) -> None:
    assert deserved(named(left), margin) >= deserved(named(left + more), margin)
    assert deserved(named(left), margin + wider) >= deserved(named(left), margin)


@given(SHARES)
def test_only_which_name_it_is_gets_less_sure(shares: list[float]) -> None:
    before = answers(shares)
    after = tempered(before)
    assert sum(after.values()) == pytest.approx(1.0)
    names = [name for name in before if name not in (NONE, UNKNOWN)]
    assert all(after[one] == before[one] for one in before if one not in names)
    for one in names:
        for other in names:
            odds = math.log(before[one] / before[other])
            assert math.log(after[one] / after[other]) == pytest.approx(odds / TEMPER, abs=1e-6)
