"""How loud single runs are comes back as it was put in; where they are alike nothing is found."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.gap.observe.spectrum import Lines, levels, loudness


def records(log_powers: list[float], seed: int, count: int = 60) -> list[Lines]:
    """Return lines of white noise whose mean power is the exponential of each number."""
    rng = np.random.default_rng(seed)
    at_hz = np.linspace(0.1, 6.0, count)
    return [Lines(at_hz, math.exp(one) * rng.exponential(size=count)) for one in log_powers]


def found(log_powers: list[float], seed: int) -> tuple[float, tuple[float, ...]]:
    lines = records(log_powers, seed)
    together = loudness(lines)
    assert together is not None
    own = levels(lines, together)
    middle = together.at(3.0)
    return own.spread, tuple(math.log(middle) + one for one in own.values)


def test_levels_that_differ_come_back() -> None:
    put_in = [0.0, 0.0, 4.0, 4.0, 0.0, 4.0, 0.0, 4.0]
    errors, spreads = [], []
    for seed in range(20):
        spread, values = found(put_in, seed)
        errors.append(np.array(values) - np.array(put_in))
        spreads.append(spread)
    # A median of 40 lines that count tells a level to 1 / (ln 2 root 40) = 0.23.
    assert np.std(errors) < 0.3
    assert np.abs(np.mean(errors, axis=0)).max() < 0.2
    assert np.mean(spreads) == pytest.approx(np.std(put_in, ddof=1), rel=0.1)


def test_runs_that_are_alike_have_hardly_a_level_of_their_own() -> None:
    spreads = [found([1.0] * 10, seed)[0] for seed in range(40)]
    assert np.median(spreads) < 0.1
    assert np.max(spreads) < 0.35


@given(
    shift=st.floats(-20.0, 20.0),
    powers=st.lists(st.floats(-2.0, 2.0), min_size=3, max_size=8),
)
def test_a_channels_unit_changes_no_level(shift: float, powers: list[float]) -> None:
    lines = records(powers, 7)
    together = loudness(lines)
    assert together is not None
    other = [Lines(one.frequency_hz, math.exp(shift) * one.density) for one in lines]
    again = loudness(other)
    assert again is not None
    assert levels(other, again).values == pytest.approx(levels(lines, together).values, abs=1e-6)
