"""Waves cut off at a known level are found with the share that was cut off; crests are not."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.gap.observe.plateau import plateau
from hardware.description.arrays import FloatArray

COUNT, PERIODS = 1600, 10
ANGLE = 2.0 * math.pi * PERIODS * np.arange(COUNT) / COUNT


def wave(third: float, phase: float) -> FloatArray:
    """Return a fundamental of 50 and its third order; a ninth of it makes the crest flattest."""
    return 50.0 * (np.sin(ANGLE + phase) + third * np.sin(3.0 * (ANGLE + phase)))


def digitised(values: FloatArray, noise: float, step: float, seed: int = 0) -> FloatArray:
    noisy = values + noise * np.random.default_rng(seed).standard_normal(len(values))
    return noisy if step == 0.0 else np.round(noisy / step) * step


steps = st.sampled_from([0.0, 1e-3, 0.05, 0.5, 5.0, 20.0])
noises = st.sampled_from([0.0, 0.02, 0.5, 3.0])
phases = st.floats(0.0, 2.0 * math.pi)


@given(st.floats(-0.2, 1.0 / 9.0), noises, steps, phases)
def test_a_crest_is_no_plateau(third: float, noise: float, step: float, phase: float) -> None:
    """However coarse the digitiser and flat the crest, and whether or not there is noise."""
    assert plateau(digitised(wave(third, phase), noise, step)).share == 0.0


@given(st.floats(0.6, 0.95), st.sampled_from([0.0, 0.02, 0.5]), st.sampled_from([0.0, 1e-3, 0.05]),
       phases, st.sampled_from([1.0, -1.0]))  # fmt: skip
def test_what_is_cut_off_is_found(
    limit: float, noise: float, step: float, phase: float, side: float
) -> None:
    whole = side * digitised(wave(0.0, phase), noise, step)
    found = plateau(side * np.minimum(whole, 50.0 * limit))
    assert found.share == pytest.approx(np.mean(whole >= 50.0 * limit), abs=0.03)
    assert found.levels == pytest.approx((side * 50.0 * limit,))


def test_both_ends_count() -> None:
    found = plateau(np.clip(wave(0.0, 0.3), -20.0, 35.0))
    assert found.levels == pytest.approx((35.0, -20.0))
    cut = math.acos(35.0 / 50.0) / math.pi + math.acos(20.0 / 50.0) / math.pi
    assert found.share == pytest.approx(cut, abs=0.01)


@pytest.mark.parametrize("values", [np.zeros(COUNT), np.full(COUNT, math.nan)], ids=["dead", "nan"])
def test_a_channel_without_values_is_not_judged(values: FloatArray) -> None:
    assert plateau(values).share == 0.0
