"""The running average of 1963 against the closed forms of a first-order low-pass."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.recording import Recording
from analysis.resolver.classic import ClassicMode, mode_for
from analysis.resolver.classic_average import AverageState, NeedleReadings, RunningAverage
from analysis.resolver.classic_recording import running_average
from analysis.resolver.reference import PhaseReference, from_frequency
from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel
from hardware.description.errors import ConfigurationError, DataError
from tests.analysis.resolver.classic_errors import (
    average_ripple,
    average_step_left,
    average_variance_ratio,
)

RATE_HZ = 400.0
PHASES = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)


def record(samples: FloatArray, rate_hz: float = RATE_HZ) -> tuple[Recording, PhaseReference]:
    channels = tuple(Channel(f"c{k}", "N") for k in range(len(samples)))
    recording = Recording("run", channels, samples, rate_hz)
    return recording, from_frequency(1.0, 0.0, recording.end_s)


def component(frequency: float, seconds: float) -> FloatArray:
    """One channel per phase."""
    time = np.arange(round(seconds * RATE_HZ)) / RATE_HZ
    return np.sin(2.0 * np.pi * frequency * time + PHASES[:, None])


def test_needles_settle_to_in_phase_and_quadrature() -> None:
    time = np.arange(20_000) / RATE_HZ
    theta = 2.0 * np.pi * time
    signal = 2.0 * np.sin(theta) - 0.7 * np.cos(theta) + 0.3 * np.sin(3 * theta + 0.4)
    needles = running_average(*record(signal[None]), time_constant_s=1.5)
    last = slice(-400, None)
    assert needles.in_phase[0, :, last].mean(axis=-1) == pytest.approx(
        [2.0, 0.0, 0.3 * np.cos(0.4)], abs=1e-4
    )
    assert needles.quadrature[0, :, last].mean(axis=-1) == pytest.approx(
        [-0.7, 0.0, 0.3 * np.sin(0.4)], abs=1e-4
    )


def test_filter_is_exact_for_a_product_that_is_a_ramp() -> None:
    # With the shaft stopped at a quarter turn, 2 sin(theta) is 2; a ramp t gives t - tau(1 - e).
    time = np.arange(2000) / RATE_HZ
    mode = RunningAverage(("c",), RATE_HZ, 1.0, 1.5)
    _, needles = mode.advance(AverageState(0.0), time[None], lambda t: np.full_like(t, 0.25))
    expected = 2.0 * (time + 1.5 * np.expm1(-time / 1.5))
    assert needles.in_phase[0, 0] == pytest.approx(expected, abs=1e-12)


@pytest.mark.sample(2)
@pytest.mark.parametrize(("order", "x"), [(1, 0), (2, 0), (1, 2), (2, 1), (3, 3), (1, 1.37)])
def test_ripple_is_the_closed_form(order: int, x: float) -> None:
    seconds = 120.0 if x % 1 else 40.0
    samples = component(x, seconds) if x else np.ones((1, round(seconds * RATE_HZ)))
    needles = running_average(*record(samples), time_constant_s=1.5)
    steady = needles.times_s > 25.0
    wanted = np.cos(PHASES) if order == x else np.zeros(len(samples))
    worst = np.abs(needles.in_phase[:, order - 1, steady] - wanted[:, None]).max()
    bound = average_ripple(order, x, 1.5)
    assert bound * 0.99 < worst < bound * 1.001


def test_ripple_from_the_mean_is_that_of_the_document() -> None:
    assert average_ripple(1, 0, 1.5) == pytest.approx(2.0 / np.hypot(1.0, 3.0 * np.pi))


def test_settled_lights_when_one_percent_of_the_step_is_left() -> None:
    # A constant product: the shaft stands still.
    mode = RunningAverage(("c",), RATE_HZ, 1.0, 1.5)
    values = np.ones((1, 4000))
    _, needles = mode.advance(AverageState(0.0), values, lambda t: np.full_like(t, 0.25))
    first = int(np.argmax(needles.settled))
    assert needles.times_s[first] == pytest.approx(4.6 * 1.5, abs=1.0 / RATE_HZ)
    left = 1.0 - needles.in_phase[0, 0] / 2.0
    assert left == pytest.approx(np.exp(-needles.times_s / 1.5), abs=1e-12)
    assert left[first] == pytest.approx(average_step_left(4.6), rel=0.01)
    assert average_step_left(4.6) == pytest.approx(0.01, rel=0.01)


@pytest.mark.parametrize(("waiting", "squared"), [(4.6, 1.517), (6.9, 1.86)])
def test_variance_against_least_squares_of_the_same_waiting_time(
    waiting: float, squared: float
) -> None:
    rate_hz, trials = 50.0, 3000
    count = round(waiting * 1.5 * rate_hz) + 1
    noise = np.random.default_rng(3).standard_normal((trials, count))
    needles = running_average(*record(noise, rate_hz), time_constant_s=1.5, harmonics=2)
    # The needle's variance pulses at twice n w; its mean over half a period is the closed form's.
    last = slice(-25, None)
    variance = np.mean(needles.quadrature[:, 1, last] ** 2)
    ratio = variance / (2.0 / count)
    assert ratio == pytest.approx(average_variance_ratio(waiting), rel=0.06)
    assert average_variance_ratio(waiting) == pytest.approx(squared**2, rel=0.01)


@given(st.lists(st.integers(0, 90), max_size=12), st.integers(0, 2**32 - 1))
def test_needles_do_not_depend_on_blocks(lengths: list[int], seed: int) -> None:
    values = np.random.default_rng(seed).standard_normal((2, 300))
    reference = from_frequency(1.013, 0.0, 10.0, 0.3)
    mode = RunningAverage(("a", "b"), 37.0, 1.013, 2.0)
    _, whole = mode.advance(AverageState(5.0), values, reference.cycles_at)
    state, parts = AverageState(5.0), []
    cuts = np.minimum(np.cumsum([0, *lengths, 300]), 300)
    for start, stop in pairwise(cuts):
        state, part = mode.advance(state, values[:, start:stop], reference.cycles_at)
        parts.append(part)
    assert state.sample_count == 300
    assert np.array_equal(joined(parts, "in_phase"), whole.in_phase)
    assert np.array_equal(joined(parts, "quadrature"), whole.quadrature)
    assert np.array_equal(joined(parts, "settled"), whole.settled)


def joined(parts: list[NeedleReadings], name: str) -> FloatArray:
    return np.concatenate([getattr(part, name) for part in parts], axis=-1)


def test_a_short_time_constant_is_refused_with_its_limit() -> None:
    with pytest.raises(ConfigurationError, match=r"time_constant_s = 2\.9 s is below 3 s"):
        RunningAverage(("c",), 100.0, 0.5, 2.9)


def test_a_frequency_that_is_none_is_refused() -> None:
    with pytest.raises(ConfigurationError, match="frequency_hz = 0: must be above 0"):
        RunningAverage(("c",), 100.0, 0.0, 1.5)


def test_an_empty_recording_is_refused() -> None:
    recording = Recording("run", (Channel("c", "N"),), np.empty((1, 0)), RATE_HZ)
    with pytest.raises(DataError, match="run: no samples"):
        running_average(recording, from_frequency(1.0, 0.0, 2.0))


def test_too_slow_sampling_is_refused() -> None:
    with pytest.raises(ConfigurationError, match=r"sample_rate_hz = 6 .* exceed 6 Hz"):
        RunningAverage(("c",), 6.0, 1.0, 1.5)


def test_a_missing_sample_is_named() -> None:
    samples = np.ones((2, 800))
    samples[1, 200] = np.nan
    with pytest.raises(DataError, match=r"c1: sample at 0\.5 s is missing"):
        running_average(*record(samples))


def test_needles_that_have_not_settled_give_no_reading() -> None:
    with pytest.raises(DataError, match=r"not settled after 5 s"):
        running_average(*record(np.ones((1, 2001)))).reading()
    in_phase, quadrature = running_average(*record(np.ones((1, 4001)))).reading()
    assert in_phase.shape == quadrature.shape == (1, 3)


def test_rows_that_are_not_the_channels_are_refused() -> None:
    mode = RunningAverage(("c",), 100.0, 1.0, 1.5)
    with pytest.raises(ConfigurationError, match=r"shape \(2, 5\) came where 1 rows"):
        mode.advance(AverageState(0.0), np.ones((2, 5)), np.copy)


@pytest.mark.parametrize(
    ("frequency_hz", "mode"),
    [
        (0.01, ClassicMode.GATED_INTEGRATION),
        (0.4999, ClassicMode.GATED_INTEGRATION),
        (0.5, ClassicMode.RUNNING_AVERAGE),
        (2.0, ClassicMode.RUNNING_AVERAGE),
    ],
)
def test_the_switch_is_at_half_a_hertz(frequency_hz: float, mode: ClassicMode) -> None:
    assert mode_for(frequency_hz) is mode


@pytest.mark.parametrize("frequency_hz", [0.0, -1.0, np.nan, np.inf])
def test_the_switch_refuses_what_is_no_frequency(frequency_hz: float) -> None:
    with pytest.raises(ConfigurationError, match="must be above 0"):
        mode_for(frequency_hz)
