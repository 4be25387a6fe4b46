"""The steady stretch of runs whose ramps, rests and steps were put there."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.resolver.period_values import solve_periods
from analysis.resolver.reference import from_frequency
from analysis.resolver.steady_stretch import Stretch, find_steady, limits
from analysis.resolver.sums import period_sums
from tests.analysis.resolver.signals import FloatArray, recording

RATE_HZ = 50.0
PERIODS = 40
TIME = np.arange(int(RATE_HZ * PERIODS) + 1) / RATE_HZ  # at 1 Hz
MOTION = np.sin(2.0 * np.pi * TIME + 0.4)


def stretch_of(*channels: FloatArray, tolerance: float = 0.02) -> Stretch:
    run = recording(np.array(channels), RATE_HZ)
    sums = period_sums(run, from_frequency(1.0, 0.0, run.end_s))
    return find_steady(solve_periods(sums), tolerance)


def noise(size: float, seed: int = 0) -> FloatArray:
    return size * np.random.default_rng(seed).normal(size=TIME.size)


def test_a_steady_run_is_steady_throughout() -> None:
    found = stretch_of(MOTION, 3.0 * MOTION + 100.0)
    assert (found.start, found.stop) == (0, PERIODS)
    assert found.spread < 1e-9


@pytest.mark.parametrize("size", [0.0, 0.01])
def test_ramps_and_rests_are_left_out(size: float) -> None:
    envelope = np.interp(TIME, [5.0, 10.0, 30.0, 34.0], [0.0, 1.0, 1.0, 0.0])
    found = stretch_of(envelope * MOTION + noise(size))
    assert (found.start, found.stop) == (10, 30)


@given(st.integers(0, 12), st.integers(1, 6), st.integers(8, 15), st.integers(1, 6))
def test_any_ramp_is_left_out(rest: int, rise: int, steady: int, fall: int) -> None:
    corners = np.cumsum([rest, rise, steady, fall])
    envelope = np.interp(TIME, corners, [0.0, 1.0, 1.0, 0.0])
    found = stretch_of(envelope * MOTION)
    assert (found.start, found.stop) == (rest + rise, rest + rise + steady)


def test_a_step_in_one_channel_ends_the_stretch_for_all() -> None:
    stepped = np.where(TIME < 25.0, 1.0, 1.3) * MOTION
    found = stretch_of(MOTION, stepped)
    assert (found.start, found.stop) == (0, 25)
    wide = stretch_of(MOTION, stepped, tolerance=0.2)
    assert (wide.start, wide.stop) == (0, PERIODS)
    assert wide.channel == 1


def test_a_step_of_phase_counts_too() -> None:
    turned = np.where(TIME < 15.0, MOTION, np.sin(2.0 * np.pi * TIME + 0.7))
    found = stretch_of(turned)
    assert (found.start, found.stop) == (15, PERIODS)


@pytest.mark.parametrize("seed", range(5))
def test_a_channel_of_noise_does_not_stand_in_the_way(seed: int) -> None:
    envelope = np.interp(TIME, [5.0, 10.0, 30.0, 34.0], [0.0, 1.0, 1.0, 0.0])
    found = stretch_of(envelope * MOTION, noise(1.0, seed))
    assert (found.start, found.stop) == (10, 30)


@pytest.mark.parametrize("periods", [1, 2, 3, 4, 10])
@pytest.mark.parametrize("level", [0.0, 9.81, -1e5])
def test_a_constant_channel_does_not_stand_in_the_way(periods: int, level: float) -> None:
    """Its harmonics are rounding, however few periods there are to tell."""
    run_samples = int(RATE_HZ * periods) + 1
    values = np.stack((MOTION[:run_samples], np.full(run_samples, level)))
    run = recording(values, RATE_HZ)
    sums = period_sums(run, from_frequency(1.0, 0.0, run.end_s))
    found = find_steady(solve_periods(sums), 0.05)
    assert (found.start, found.stop) == (0, periods)


def test_a_gap_splits_the_run() -> None:
    gap = MOTION.copy()
    gap[int(14.5 * RATE_HZ)] = np.nan
    found = stretch_of(MOTION, gap)
    assert (found.start, found.stop) == (15, PERIODS)
    assert np.isfinite(found.spread)


def test_a_single_usable_period_is_found() -> None:
    gap = np.full(TIME.size, np.nan)
    first, last = int(6.0 * RATE_HZ) - 5, int(7.0 * RATE_HZ) + 5
    gap[first:last] = MOTION[first:last]
    found = stretch_of(gap)
    assert (found.start, found.stop) == (6, 7)


def test_nothing_usable_is_one_period_that_strays_without_end() -> None:
    found = stretch_of(np.full(TIME.size, np.nan))
    assert found.period_count == 1
    assert np.isinf(found.spread)


def test_a_single_period_is_a_stretch() -> None:
    run = recording(MOTION[: int(1.5 * RATE_HZ)], RATE_HZ)
    sums = period_sums(run, from_frequency(1.0, 0.0, run.end_s))
    assert find_steady(solve_periods(sums), 0.05) == Stretch(0, 1, 0.0, 0)


def test_outliers_do_not_widen_what_is_allowed() -> None:
    """One period hit by a blow is left out, and its blow is not taken for the channel's noise."""
    hit = MOTION + noise(0.01)
    hit[int(12.2 * RATE_HZ) : int(12.4 * RATE_HZ)] += 5.0
    found = stretch_of(hit)
    assert (found.start, found.stop) == (13, PERIODS)


def test_slow_growth_is_allowed_only_within_the_tolerance() -> None:
    found = stretch_of((1.0 + 0.01 * TIME) * MOTION)
    # 1 % a period against 2 % to either side of 1.36, the usual size, in the larger part.
    assert 5 <= found.period_count <= 7


def test_a_channel_that_alone_ends_the_stretch_is_named() -> None:
    late = np.where(TIME < 20.0, MOTION, 1.3 * MOTION)
    run = recording(np.stack((MOTION, late)), RATE_HZ)
    values = solve_periods(period_sums(run, from_frequency(1.0, 0.0, run.end_s)))
    found = find_steady(values, 0.05)
    (limit,) = limits(values, found, 0.05)
    assert limit.channel == 1
    assert limit.period == (found.stop if found.start == 0 else found.start - 1)
    assert limit.spread == pytest.approx(0.15 / 1.3, rel=0.1)


def test_where_all_channels_end_the_stretch_none_is_named() -> None:
    late = np.where(TIME < 20.0, MOTION, 1.3 * MOTION)
    run = recording(np.stack((late, 2.0 * late)), RATE_HZ)
    values = solve_periods(period_sums(run, from_frequency(1.0, 0.0, run.end_s)))
    assert limits(values, find_steady(values, 0.05), 0.05) == []


@given(st.integers(8, 32), st.integers(-12, 12), st.floats(0.5, 2.0), st.integers(0, 49))
def test_what_a_channel_is_beyond_is_what_it_was_made(
    period: int, lost: int, gain: float, within: int
) -> None:
    """Samples that are lost turn it, by the hand's angle; an amplifier's gain scales it."""
    at = period * int(RATE_HZ) + within
    other = np.sin(2.0 * np.pi * (TIME + lost / RATE_HZ) + 0.4)
    changed = np.where(np.arange(TIME.size) < at, MOTION, gain * other)
    run = recording(np.stack((MOTION, changed)), RATE_HZ)
    values = solve_periods(period_sums(run, from_frequency(1.0, 0.0, run.end_s)))
    found = find_steady(values, 0.05)
    factor = gain * np.exp(2j * np.pi * lost / RATE_HZ)
    for limit in limits(values, found, 0.05):
        assert limit.channel == 1
        expected = factor if found.start == 0 else 1.0 / factor
        assert limit.beyond == 1.0 or abs(limit.beyond - expected) < 0.02 * abs(expected)
        if abs(factor - 1.0) > 0.3:  # twice what may pass for steady, with room
            assert limit.lasts
            assert limit.turned == (abs(np.angle(expected)) > abs(np.log(gain)))


def test_a_single_period_that_strays_does_not_last() -> None:
    hit = MOTION + noise(0.001)
    hit[int(12.2 * RATE_HZ) : int(12.4 * RATE_HZ)] += 5.0
    run = recording(np.stack((MOTION, hit)), RATE_HZ)
    values = solve_periods(period_sums(run, from_frequency(1.0, 0.0, run.end_s)))
    (limit,) = limits(values, find_steady(values, 0.02), 0.02)
    assert limit.period == 12
    assert not limit.lasts
