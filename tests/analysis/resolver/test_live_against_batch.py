"""The live resolver's final readings are the batch's, however samples and pulses arrive."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from analysis.readers.conditioning import without_spikes
from analysis.recording import Recording
from analysis.resolver.estimate import resolve
from analysis.resolver.harmonics import Harmonics
from analysis.resolver.live_resolver import LiveResolver, Provisional
from analysis.resolver.photocell import from_photocell
from analysis.resolver.sums import period_sums
from hardware.description.errors import DataError
from tests.analysis.resolver.signals import FloatArray, recording, series

RATE_HZ = 100.0
COUNT = 1000
CONTENT = np.array([10.0, 1.0, 0.4, -0.3, 0.2, 0.15, -0.1])
EDGES = 0.537 + np.cumsum(0.97 + 0.004 * np.sin(np.arange(9.0)))  # the speed wavers


def run(start_s: float = 0.0, noise: float = 0.05) -> Recording:
    time = np.arange(COUNT) / RATE_HZ
    cycles = from_photocell(EDGES).cycles_at(time)
    white = noise * np.random.default_rng(9).normal(size=(3, COUNT))
    values = np.array([1.0, -2.0, 0.1])[:, None] * series(CONTENT, cycles) + 0.2 * time + white
    return recording(values, RATE_HZ, start_s=start_s)


def batch(
    record: Recording, edges: FloatArray, periods: int, **calibration: float
) -> Iterator[Harmonics]:
    sums = period_sums(record, from_photocell(edges, **calibration))
    for k in range(sums.period_count - periods + 1):
        yield resolve(record, sums[k : k + periods])


def feed(
    live: LiveResolver, record: Recording, edges: FloatArray, blocks: list[int], delays: list[float]
) -> list[Harmonics]:
    """Hand over samples block by block and each pulse with its own delay, then finish."""
    readings: list[Harmonics] = []
    due = list(np.maximum.accumulate(edges + np.resize(delays, len(edges))))
    waiting, at, k = list(edges), 0, 0
    while at < COUNT:
        size = min(blocks[k % len(blocks)], COUNT - at)
        readings += live.push(record.samples[:, at : at + size])
        at, k = at + size, k + 1
        while waiting and due[0] <= record.start_s + at / RATE_HZ:
            due.pop(0)
            readings += live.pulse(waiting.pop(0))
    for edge in waiting:
        readings += live.pulse(edge)
    return readings + live.finish()


def same(ours: list[Harmonics], theirs: list[Harmonics]) -> None:
    assert len(ours) == len(theirs) > 0
    for one, other in zip(ours, theirs, strict=True):
        scale = np.abs(other.coefficients).max()
        assert one.coefficients == pytest.approx(other.coefficients, abs=1e-11 * scale)
        assert one.opened_s == pytest.approx(other.opened_s, abs=1e-12)
        assert one.closed_s == pytest.approx(other.closed_s, abs=1e-12)
        assert one.covariance == pytest.approx(
            other.covariance, rel=1e-8, abs=1e-11 * scale**2, nan_ok=True
        )
        assert one.drift_per_s == pytest.approx(other.drift_per_s, abs=1e-10 * scale)
        assert one.drift_source == other.drift_source
        assert one.interval_source == other.interval_source


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.integers(1, 200), min_size=1, max_size=6),
    st.lists(st.floats(-0.9, 0.3), min_size=1, max_size=5),
    st.sampled_from([1, 2, 3, 8]),
)
def test_any_blocks_and_any_arrival_of_pulses(
    blocks: list[int], delays: list[float], periods: int
) -> None:
    """Pulses may come before their samples (a block late) or after them (a bus late)."""
    record = run()
    live = LiveResolver(record.channels, RATE_HZ, periods=periods)
    same(feed(live, record, EDGES, blocks, delays), list(batch(record, EDGES, periods)))


@pytest.mark.parametrize("block", [1, 7, 100])
@pytest.mark.parametrize("late_s", [0.0, 0.8])
def test_late_pulses_within_a_second(block: int, late_s: float) -> None:
    record = run()
    live = LiveResolver(record.channels, RATE_HZ)
    same(feed(live, record, EDGES, [block], [late_s]), list(batch(record, EDGES, 1)))


@pytest.mark.parametrize("start_s", [0.3, -5.0, 1.7e5])
def test_a_clock_that_does_not_start_at_zero(start_s: float) -> None:
    record = run(start_s)
    edges = EDGES + start_s
    live = LiveResolver(record.channels, RATE_HZ, periods=2, start_s=start_s)
    ours = feed(live, record, edges, [10], [0.0])
    theirs = list(batch(record, edges, 2))
    assert len(ours) == len(theirs) > 0
    for one, other in zip(ours, theirs, strict=True):
        # The clock itself is rounded to 3e-11 s after two days.
        assert one.coefficients == pytest.approx(other.coefficients, abs=1e-8)


def test_calibration_is_the_batch_s() -> None:
    record = run()
    live = LiveResolver(record.channels, RATE_HZ, latency_s=0.013, angle_offset_rad=0.7)
    ours = feed(live, record, EDGES, [10], [0.0])
    same(ours, list(batch(record, EDGES, 1, latency_s=0.013, angle_offset_rad=0.7)))


@pytest.mark.parametrize("harmonics", [1, 2, 6])
def test_any_number_of_harmonics(harmonics: int) -> None:
    record = run()
    live = LiveResolver(record.channels, RATE_HZ, harmonics=harmonics)
    ours = feed(live, record, EDGES, [10], [0.0])
    sums = period_sums(record, from_photocell(EDGES), harmonics)
    same(ours, [resolve(record, sums[k : k + 1]) for k in range(sums.period_count)])


@pytest.mark.parametrize("missed", [[3], [3, 4], [5, 7], [7]])
def test_missed_pulses_are_bridged_as_in_the_batch(missed: list[int]) -> None:
    record, edges = run(), np.delete(EDGES, missed)
    live = LiveResolver(record.channels, RATE_HZ)
    ours = feed(live, record, edges, [10], [0.0])
    same(ours, list(batch(record, edges, 1)))
    assert len(ours) == 8


@pytest.mark.parametrize("fraction", [0.01, 0.2, 0.5, 0.6])
def test_extra_pulses_soon_after_a_true_one_are_dropped(fraction: float) -> None:
    record = run()
    edges = np.sort(np.append(EDGES, EDGES[4] + fraction))
    live = LiveResolver(record.channels, RATE_HZ)
    same(feed(live, record, edges, [10], [0.0]), list(batch(record, edges, 1)))


@pytest.mark.parametrize(
    "start",
    [
        [0.0, 2.0],  # the second pulse missed
        [0.0, 0.001],  # a bounce on the first
        [0.0, 0.3],  # a stray one in the first revolution
        [-9.0, -4.0, -2.0, -0.7, 0.3],  # spinning up from rest
    ],
)
def test_an_odd_start_is_forgotten_within_seven_pulses(start: list[float]) -> None:
    """The usual period is that of all pulses, so that a wrong first guess does not last."""
    later = np.arange(max(np.ceil(start[-1] + 1e-9), 1.0), 20.0)
    edges = np.concatenate((start, later)) + 9.5
    cycles = np.arange(3000) / RATE_HZ - 9.5
    record = recording(series(CONTENT, cycles), RATE_HZ)
    live = LiveResolver(record.channels, RATE_HZ)
    readings = live.push(record.samples[:, :950])
    for edge in edges:
        readings += live.pulse(edge)
    readings += live.push(record.samples[:, 950:])
    last = readings[-8:]
    assert [reading.frequency_hz for reading in last] == pytest.approx([1.0] * 8, abs=1e-9)
    for reading in last:
        assert reading.coefficients[0] == pytest.approx(CONTENT, abs=1e-9)


def test_pulses_before_the_first_sample_only_tell_the_speed() -> None:
    record = run(start_s=3.0)
    live = LiveResolver(record.channels, RATE_HZ, start_s=3.0)
    edges = np.concatenate((EDGES, 0.97 + EDGES[-1] + 0.97 * np.arange(4.0)))
    readings = [one for edge in edges for one in live.pulse(edge)]
    assert readings == []
    ours = live.push(record.samples[:, :]) + live.finish()
    same(ours, list(batch(record, edges, 1)))
    assert ours[0].opened_s > 3.0


def test_a_pulse_on_the_first_and_on_the_last_sample() -> None:
    """Rounding of the clock does not cost the first or the last period."""
    start_s = 0.1 + 0.2
    record = run(start_s)
    edges = 0.3 + 9.99 * np.arange(4.0) / 3.0
    live = LiveResolver(record.channels, RATE_HZ, start_s=start_s)
    ours = feed(live, record, edges, [100], [0.0])
    assert len(ours) == 3
    same(ours, list(batch(record, edges, 1)))


def test_finish_gives_what_waited_for_samples_beyond_the_edge() -> None:
    record = run()
    live = LiveResolver(record.channels, RATE_HZ)
    last = int(EDGES[3] * RATE_HZ) + 2  # one sample past the edge, of the three it wants
    readings = live.push(record.samples[:, :last])
    for edge in EDGES[:4]:
        readings += live.pulse(edge)
    assert len(readings) == 2
    (waited,) = live.finish()
    assert waited.closed_s == pytest.approx(EDGES[3])
    short = recording(record.samples[:, :last], RATE_HZ)
    same([waited], list(batch(short, EDGES[:4], 1))[-1:])
    assert live.finish() == []


def test_needles_are_provisional_and_within_the_noise() -> None:
    record = run(noise=0.01)
    live = LiveResolver(record.channels, RATE_HZ, periods=2)
    assert live.provisional() is None
    waiting, needles = list(EDGES), []
    for at in range(0, COUNT, 10):
        finals = live.push(record.samples[:, at : at + 10])
        while waiting and waiting[0] <= at / RATE_HZ:
            finals += live.pulse(waiting.pop(0))
        assert all(isinstance(one, Harmonics) for one in finals)
        needle = live.provisional()
        if needle is not None:
            assert isinstance(needle, Provisional)
            assert not isinstance(needle, Harmonics)
            needles.append(needle.coefficients)
    harmonics = np.array(needles)[:, 0, 1:]
    assert len(needles) > 50
    # Noise of 0.01, the drift of 0.2 per period that only finals are free of, a wavering speed.
    assert np.abs(harmonics - CONTENT[1:]).max() < 0.1


def test_needles_do_not_change_what_is_final() -> None:
    record = run()
    live, waiting, ours = LiveResolver(record.channels, RATE_HZ), list(EDGES), []
    for at in range(0, COUNT, 10):
        ours += live.push(record.samples[:, at : at + 10])
        live.provisional()
        while waiting and waiting[0] <= at / RATE_HZ:
            ours += live.pulse(waiting.pop(0))
        live.provisional()
    same(ours, list(batch(record, EDGES, 1)))


@pytest.mark.parametrize("shape", [(2, 10), (4, 10), (3,), (10, 3), (1, 3, 10)])
def test_a_block_of_another_shape_is_refused(shape: tuple[int, ...]) -> None:
    live = LiveResolver(run().channels, RATE_HZ)
    with pytest.raises(DataError, match="does not fit 3 channels"):
        live.push(np.zeros(shape))


@pytest.mark.parametrize("time_s", [1.0, 0.5, float("nan")])
def test_a_pulse_out_of_order_is_refused_and_forgotten(time_s: float) -> None:
    record = run()
    live = LiveResolver(record.channels, RATE_HZ)
    live.pulse(1.0)
    with pytest.raises(DataError, match=r"does not come after the last at 1\.000000 s"):
        live.pulse(time_s)
    live.pulse(1.97)
    assert len(live.push(record.samples[:, :])) == 1


def test_memory_before_the_first_pulse_is_bounded() -> None:
    live = LiveResolver(run().channels, RATE_HZ)
    sizes = []
    for _ in range(2000):
        live.push(np.zeros((3, 50)))
        sizes.append(live._buffer.nbytes)
    assert max(sizes) <= 3 * 8 * 1024 * 2


@pytest.mark.slow
def test_memory_does_not_grow_with_the_run() -> None:
    live = LiveResolver(run().channels, RATE_HZ)
    readings = 0
    for k in range(3000):
        readings += len(live.push(np.ones((3, 50))))
        if k % 2:
            readings += len(live.pulse(0.5 * k))
    assert readings > 1400
    assert live._buffer.nbytes <= 3 * 8 * 1024 * 2


def test_periods_whose_samples_are_gone_are_left_out() -> None:
    """Eight seconds before the first pulse is told: too late for it, not for those to come."""
    record = run()
    live = LiveResolver(record.channels, RATE_HZ)
    for at in range(0, 800, 10):
        live.push(record.samples[:, at : at + 10])
    readings = [one for edge in EDGES for one in live.pulse(edge)]
    readings += live.push(record.samples[:, 800:]) + live.finish()
    assert 0 < len(readings) < 8
    exact = list(batch(record, EDGES, 1))[-len(readings) :]
    for one, other in zip(readings, exact, strict=True):
        assert one.coefficients == pytest.approx(other.coefficients, abs=1e-6)


@pytest.mark.parametrize("periods", [1, 2])
def test_missing_samples_cost_their_periods_and_no_more(periods: int) -> None:
    values = run().samples[:, :].copy()
    values[1, int(100 * EDGES[2]) + 40] = np.nan
    record = recording(values, RATE_HZ)
    live = LiveResolver(record.channels, RATE_HZ, periods=periods)
    ours = feed(live, record, EDGES, [10], [0.0])
    assert len(ours) == 7  # of 8, or all of 7 gates of two, for one period of each is sound
    for one in ours:
        assert np.isfinite(one.coefficients).all()
    sums = period_sums(record, from_photocell(EDGES))
    same(
        ours[-3:],
        [resolve(record, sums[k : k + periods]) for k in range(9 - periods - 3, 9 - periods)],
    )


@pytest.mark.slow
@pytest.mark.parametrize("length", [1, 2, 3])
def test_a_spike_is_taken_out_wherever_a_period_ends(length: int) -> None:
    """What has come when a period is summed up ends in the middle of a spike, too."""
    edge = int(EDGES[3] * RATE_HZ)
    clean = run()
    for at in range(edge - 10, edge + 30):
        spoilt = np.array(clean.samples[:, 0:COUNT])
        spoilt[1, at : at + length] -= 50.0
        record = replace(clean, samples=spoilt)
        live = LiveResolver(record.channels, RATE_HZ)
        same(feed(live, record, EDGES, [1], [0.0]), list(batch(without_spikes(record), EDGES, 1)))
        assert [taken.number for taken in live.spikes()] == [at]


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.integers(1, 200), min_size=1, max_size=6),
    st.lists(st.floats(-0.9, 0.3), min_size=1, max_size=5),
    st.sampled_from([1, 2, 8]),
    st.integers(170, 800),
    st.integers(1, 3),
    st.sampled_from([-50.0, 1e4]),
)
def test_a_spike_is_taken_out_of_both(
    blocks: list[int],
    delays: list[float],
    periods: int,
    at: int,
    length: int,
    size: float,
) -> None:
    """Wherever it stands, on a period's edge too, and however the samples arrive."""
    record = run()
    spoilt = np.array(record.samples[:, 0:COUNT])
    spoilt[1, at : at + length] += size
    record = replace(record, samples=spoilt)
    whole = without_spikes(record)
    assert [flag.code for flag in whole.flags] == ["spike"]
    live = LiveResolver(record.channels, RATE_HZ, periods=periods)
    same(feed(live, record, EDGES, blocks, delays), list(batch(whole, EDGES, periods)))
    (taken,) = live.spikes()
    assert (taken.row, taken.number) == (1, at)
    assert taken.spike.size == pytest.approx(size, abs=3.0)
    assert live.spikes() == []
