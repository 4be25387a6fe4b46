"""Oracle: a damped cosine, whose amplitude and phase are known at every time."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.gap.pendulum.swings import KINDS, Windows, scatter, swings_of_samples

WINDOWS = Windows(0.0, 2.0 * math.pi / 1.8, 1, 12)
DECAY_PER_S, FASTER_RAD_S = 0.03, 0.01
DECAY, PERIOD = KINDS.index("decay"), KINDS.index("period")


def damped(time_s: np.ndarray) -> np.ndarray:
    turned = (WINDOWS.reference_rad_s + FASTER_RAD_S) * time_s
    return np.asarray(np.exp(-DECAY_PER_S * time_s) * np.cos(turned))


@given(st.integers(0, 2**31), st.floats(0.0, 0.2), st.booleans())
def test_samples_that_are_missing_change_nothing(seed: int, share: float, rows: bool) -> None:
    """Left out as rows or as no numbers, in other places of windows that have as many."""
    rng = np.random.default_rng(seed)
    time_s = np.arange(0.0, 12 * 1.8, 0.02)
    values = damped(time_s)
    lost = rng.random(time_s.size) < share
    if rows:
        found = swings_of_samples(time_s[~lost], values[~lost], WINDOWS)
    else:
        found = swings_of_samples(time_s, np.where(lost, np.nan, values), WINDOWS)
    there = np.isfinite(found[DECAY])
    assert there.sum() >= 10
    at_s = WINDOWS.centres_s[there]
    assert found[DECAY, there] == pytest.approx(-DECAY_PER_S * at_s, abs=2e-4)
    assert found[PERIOD, there] == pytest.approx(FASTER_RAD_S * at_s, abs=2e-4)


@given(st.floats(0.35, 1.0), st.integers(1, 9))
def test_a_window_with_a_hole_has_no_swing(hole_s: float, number: int) -> None:
    """A sixth of a swing is 0.3 s; its neighbours are as they are without it."""
    time_s = np.arange(0.0, 12 * 1.8, 0.02)
    middle_s = WINDOWS.centres_s[number]
    there = np.abs(time_s - middle_s) > 0.5 * hole_s
    found = swings_of_samples(time_s[there], damped(time_s[there]), WINDOWS)
    assert np.isnan(found[:, number]).all()
    assert np.isfinite(np.delete(found, number, axis=1)).all()


def test_windows_that_are_missing_do_not_look_like_noise() -> None:
    time_s = np.arange(0.0, 12 * 1.8, 0.02)
    noisy = damped(time_s) + np.random.default_rng(4).normal(0.0, 1e-4, time_s.size)
    whole = swings_of_samples(time_s, noisy, WINDOWS)
    holed = whole.copy()
    holed[:, [4, 5]] = np.nan
    kinds = (DECAY, PERIOD)
    before, after = (np.nanmedian(scatter(one)[kinds, :], axis=1) for one in (whole, holed))
    assert (after < 2.0 * before).all()
