"""Intervals against published values and closed forms."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.sealed.scoring.intervals import auroc, mean, median, share, wilson

SHARES = st.lists(st.sampled_from([0.0, 0.5, 1.0]), min_size=1, max_size=60)


@pytest.mark.parametrize(
    ("hits", "count", "low", "high"),
    [
        # Newcombe, Two-sided confidence intervals for the single proportion (1998), table I,
        # method 3.
        (81, 263, 0.2553, 0.3662),
        (15, 148, 0.0624, 0.1605),
        (0, 20, 0.0, 0.1611),
        (1, 29, 0.0061, 0.1718),
    ],
)
def test_wilson_s_interval(hits: int, count: int, low: float, high: float) -> None:
    assert wilson(hits, count) == pytest.approx((low, high), abs=5e-5)


@given(SHARES)
def test_intervals_hold_their_figures(hits: list[float]) -> None:
    for figure in (share(hits), mean(hits), median(hits)):
        assert figure is not None
        assert figure.low - 1e-12 <= figure.value <= figure.high + 1e-12


def test_bootstrap_of_a_mean_is_as_wide_as_its_standard_error() -> None:
    values = [float(i % 10) for i in range(400)]
    found = mean(values)
    assert found is not None
    assert found.high - found.low == pytest.approx(2 * 1.96 * (8.25 / 400) ** 0.5, rel=0.1)


@pytest.mark.slow
@given(st.lists(st.floats(0, 1), min_size=1, max_size=20), st.lists(st.floats(0, 1), min_size=1,
       max_size=20))  # fmt: skip
def test_auroc_turns_round_with_its_classes(one: list[float], two: list[float]) -> None:
    there, back = auroc(one, two), auroc(two, one)
    assert there is not None
    assert back is not None
    assert there.value + back.value == pytest.approx(1.0)


def test_no_cases_give_no_figure() -> None:
    assert share([]) is mean([]) is median([]) is auroc([], [1.0]) is None
