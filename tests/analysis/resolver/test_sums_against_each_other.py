"""Every way to sum gives the same: in threads, lazily read, at the ends; and what must be refused.

The oracle of the quick sums is the general way, which takes a sine and a cosine of each sample and
order and sums the basis itself instead of a series in closed form.
"""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.recording import Recording
from analysis.resolver import sums as sums_module
from analysis.resolver.estimate import resolve
from analysis.resolver.general_sums import sum_any
from analysis.resolver.period_values import solve_periods
from analysis.resolver.photocell import from_photocell
from analysis.resolver.reference import PhaseReference, ReferenceSource, from_frequency
from analysis.resolver.sample_sums import ROW
from analysis.resolver.straight_sums import Gates
from analysis.resolver.sums import PeriodSums, period_sums, whole_periods
from hardware.description.errors import ConfigurationError, DataError
from tests.analysis.resolver.signals import FloatArray, recording, series

RATE_HZ = 100.0
CONTENT = np.array([10.0, 1.0, 0.4, -0.3, 0.2, 0.15, -0.1])
GENERATOR = np.random.default_rng(10)
VALUES = GENERATOR.normal(size=(4, 5000)) + 3.0
EDGES = 0.4 + np.cumsum(0.98 + 0.01 * np.sin(np.arange(45.0)))


class Lazy:
    """Samples that count what they are asked for."""

    def __init__(self, values: FloatArray) -> None:
        self.values = values
        self.asked: list[tuple[int, int]] = []

    @property
    def shape(self) -> tuple[int, ...]:
        return self.values.shape

    def __getitem__(self, key: tuple[slice, slice]) -> FloatArray:
        rows, when = key
        first, last, _ = when.indices(self.values.shape[1])
        self.asked.append((first, last))
        return self.values[rows, first:last].copy()


def encoder(reference: PhaseReference) -> PhaseReference:
    """Return a reference with knots within the periods, as an encoder gives them."""
    knots = reference.cycles[0] + np.arange(0.0, 44.0, 0.1)
    times = reference.times_at(knots) + 1e-3 * np.sin(2.0 * np.pi * knots)
    return PhaseReference(ReferenceSource.ENCODER, times, knots)


def exactly(one: PeriodSums, other: PeriodSums) -> None:
    for name in ("gram", "moment", "ramp"):
        assert getattr(one, name).tobytes() == getattr(other, name).tobytes(), name


def same(one: PeriodSums, other: PeriodSums, tolerance: float = 1e-11) -> None:
    near(one, (other.gram, other.moment, other.ramp), tolerance)


def near(one: PeriodSums, exact: tuple[FloatArray, ...], tolerance: float = 1e-11) -> None:
    for found, wanted in zip((one.gram, one.moment, one.ramp), exact, strict=True):
        assert found == pytest.approx(wanted, abs=tolerance * np.abs(wanted).max())


def plainly(
    run: Recording, reference: PhaseReference, harmonics: int
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Sum with a sine and a cosine of every sample; each period in its own straight line."""
    cycles = whole_periods(run, reference)
    numbers = np.clip(run.sample_number(reference.times_at(cycles)), 0.0, run.sample_count - 1.0)
    gates = Gates(numbers[:-1], numbers[1:], cycles[:-1], cycles[1:])
    orders = np.arange(1.0, harmonics + 1.0)
    found = []
    for k in range(len(cycles) - 1):
        gate = gates[slice(k, k + 1)]
        samples = run.samples[:, 0 : run.sample_count]
        found.append(sum_any(samples, gate, gate.cycles_of_first, orders))
    gram, moment, ramp = (np.stack(part) for part in zip(*found, strict=True))
    return gram, moment, ramp / run.sample_rate_hz


@pytest.mark.sample(5)
@pytest.mark.parametrize("harmonics", [1, 3, 12])
@pytest.mark.parametrize("times", [1, 30])
@pytest.mark.parametrize("channels", [1, 4])
def test_quick_sums_against_a_sine_of_every_sample(
    harmonics: int, times: int, channels: int
) -> None:
    """Periods of 98 samples, less than a row of the quick sums, and of 2940, several rows."""
    values = np.repeat(VALUES[:channels], times, axis=1)
    run = recording(values, times * RATE_HZ)
    reference = from_photocell(EDGES)
    near(period_sums(run, reference, harmonics), plainly(run, reference, harmonics))


@given(st.integers(20, 4 * ROW), st.integers(1, 4), st.floats(0.0, 0.999))
def test_quick_sums_at_any_length_of_a_period(
    samples: int, harmonics: int, opening_cycle: float
) -> None:
    """Whole rows with nothing over, one sample over, one missing, and all in between."""
    run = recording(VALUES[:2, : 3 * samples], RATE_HZ)
    reference = from_frequency(RATE_HZ / samples, 0.0, run.end_s, 2.0 * np.pi * opening_cycle)
    near(period_sums(run, reference, harmonics), plainly(run, reference, harmonics))


@given(
    st.integers(20, 6 * ROW),
    st.lists(st.integers(0, 2 * ROW), min_size=1, max_size=8),
    st.integers(0, 49),
)
def test_quick_sums_of_periods_of_unlike_lengths(least: int, more: list[int], missing: int) -> None:
    """Neighbours that are summed together, and apart; a missing sample is its own periods' only."""
    edges_s = (3.3 + np.cumsum([0, *(least + np.array(more))])) / RATE_HZ
    values = np.tile(VALUES[:2], 4)[:, : int(edges_s[-1] * RATE_HZ) + 5]
    values[1, missing * values.shape[1] // 50] = np.nan
    run = recording(values, RATE_HZ)
    knots = np.arange(float(len(edges_s)))
    reference = PhaseReference(ReferenceSource.ENCODER, edges_s, knots)
    sums, exact = period_sums(run, reference), plainly(run, reference, 3)
    for found, wanted in zip((sums.gram, sums.moment, sums.ramp), exact, strict=True):
        near = pytest.approx(wanted, abs=1e-11 * np.nanmax(np.abs(wanted)), nan_ok=True)
        assert found == near


def test_quick_sums_take_samples_that_are_not_contiguous() -> None:
    run, reference = recording(np.asfortranarray(VALUES), RATE_HZ), from_photocell(EDGES)
    exactly(period_sums(run, reference), period_sums(recording(VALUES, RATE_HZ), reference))


@pytest.mark.parametrize("bent", [False, True])
@pytest.mark.parametrize("at_once", [40, 700, 200_000])
def test_any_number_of_threads_gives_the_same_bits(
    bent: bool, at_once: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also where fewer threads than stretches, or more, share the work."""
    monkeypatch.setattr(sums_module, "_STRETCH_SAMPLES", at_once)
    gap = VALUES.copy()
    gap[1, 2345] = np.nan
    run, reference = recording(gap, RATE_HZ), from_photocell(EDGES)
    if bent:
        reference = encoder(reference)
    alone = period_sums(run, reference, threads=1)
    for threads in (2, 4, 100):
        exactly(period_sums(run, reference, threads=threads), alone)


def test_an_error_in_a_thread_reaches_who_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    class Damaged(Lazy):
        def __getitem__(self, key: tuple[slice, slice]) -> FloatArray:
            if (key[1].start or 0) > 2000:
                raise DataError("damaged.nc: the file has changed since it was opened")
            return super().__getitem__(key)

    monkeypatch.setattr(sums_module, "_STRETCH_SAMPLES", 300)
    run = recording(VALUES, RATE_HZ)
    read = Recording("damaged", run.channels, Damaged(VALUES), RATE_HZ)
    with pytest.raises(DataError, match="has changed"):
        period_sums(read, from_photocell(EDGES), threads=3)


@pytest.mark.parametrize("at_once", [300, 1000, 200_000])
@pytest.mark.parametrize("bent", [False, True])
def test_samples_read_lazily_give_the_same(
    at_once: int, bent: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sums_module, "_STRETCH_SAMPLES", at_once)
    lazy, run = Lazy(VALUES), recording(VALUES, RATE_HZ)
    reference = from_photocell(EDGES)
    if bent:
        reference = encoder(reference)
    read = Recording("lazy", run.channels, lazy, RATE_HZ)
    exactly(period_sums(read, reference), period_sums(run, reference))
    asked = np.array(lazy.asked)
    assert (asked[:, 1] - asked[:, 0]).max() <= at_once + 10
    # All is read once, but for the few samples that two neighbouring stretches share.
    assert (asked[:, 1] - asked[:, 0]).sum() <= VALUES.shape[1] + 10 * len(asked)


def test_a_period_longer_than_what_is_read_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sums_module, "_STRETCH_SAMPLES", 40)
    run = recording(VALUES, RATE_HZ)
    read = Recording("lazy", run.channels, Lazy(VALUES), RATE_HZ)
    reference = from_photocell(EDGES)
    same(period_sums(read, reference), period_sums(run, reference))


@given(st.floats(0.0, 0.05), st.floats(0.0, 0.05))
def test_the_ends_of_a_record_are_exact_too(before: float, after: float) -> None:
    """Gates that open on the first samples and close on the last."""
    cycles = np.arange(401) / 100.0
    run = recording(series(CONTENT, cycles))
    edges = np.array([before, 1.0, 2.0, 4.0 - after])
    knots = PhaseReference(ReferenceSource.FREQUENCY, np.array([0.0, 4.0]), np.array([0.0, 4.0]))
    sums = period_sums(run, knots, edges_cycles=edges)
    assert resolve(run, sums, take_out_drift=False).coefficients[0] == pytest.approx(
        CONTENT, abs=1e-11
    )


def test_wavering_speed_at_the_ends_is_summed_as_inside() -> None:
    """A period's phase is its own, though the next one's differs and the record ends there."""
    run, reference = recording(VALUES, RATE_HZ), from_photocell(EDGES)
    edges = np.array([10.0, 11.0, 12.0])
    inside = period_sums(run, reference, edges_cycles=edges)
    first, last = run.sample_number(EDGES[[10, 12]]).astype(int) + np.array([-1, 3])
    short = recording(VALUES[:, first:last], RATE_HZ, start_s=first / RATE_HZ)
    alone = period_sums(short, reference, edges_cycles=edges)
    assert alone.gram[:, 0] == pytest.approx(inside.gram[:, 0], abs=1e-6)


def test_sums_are_additive_in_the_record() -> None:
    """A gate of ten periods solved at once is the gate that its periods add up to."""
    run, reference = recording(VALUES, RATE_HZ), from_photocell(EDGES)
    whole = period_sums(run, reference)
    some = period_sums(run, reference, edges_cycles=np.arange(5.0, 16.0))
    same(whole[5:15], some)


@pytest.mark.parametrize(("harmonics", "samples"), [(3, 6.0), (3, 5.0), (10, 20.0), (1, 2.0)])
def test_harmonics_beyond_nyquist_are_refused(harmonics: int, samples: float) -> None:
    run = recording(VALUES, RATE_HZ)
    reference = from_frequency(RATE_HZ / samples, 0.0, run.end_s)
    kind = DataError if samples <= 2.0 else ConfigurationError  # no fewer than one would do
    with pytest.raises(kind, match=rf"cannot carry harmonic {harmonics}; take fewer"):
        period_sums(run, reference, harmonics)


@pytest.mark.parametrize(("harmonics", "samples"), [(3, 6.3), (10, 20.7), (1, 2.3)])
def test_harmonics_just_below_nyquist_are_exact(harmonics: int, samples: float) -> None:
    content = np.random.default_rng(11).normal(size=2 * harmonics + 1)
    run = recording(series(content, 0.1 + np.arange(1000) / samples), RATE_HZ)
    reference = from_frequency(RATE_HZ / samples, 0.0, run.end_s, 2.0 * np.pi * 0.1)
    result = resolve(run, period_sums(run, reference, harmonics))
    assert result.coefficients[0] == pytest.approx(content, abs=1e-9)


@pytest.mark.parametrize("count", [3, 4, 5])
def test_a_record_of_a_few_samples_is_refused(count: int) -> None:
    run = recording(np.ones(count), RATE_HZ)
    reference = from_frequency(RATE_HZ / 2.1, 0.0, 1.0)
    with pytest.raises(DataError, match=rf"{count} samples are too few; at least 6"):
        period_sums(run, reference, 1, edges_cycles=np.array([0.0, 0.9]))


@pytest.mark.parametrize("edges", [(-0.5, 0.5, 1.5), (47.5, 48.5, 49.5, 50.5), (60.0, 61.0)])
def test_a_gate_outside_the_record_is_refused(edges: tuple[float, ...]) -> None:
    run = recording(VALUES, RATE_HZ)
    reference = from_frequency(1.0, 0.0, run.end_s)
    with pytest.raises(DataError, match=r"is not within the record, 0\.000 s to 49\.990 s"):
        period_sums(run, reference, edges_cycles=np.array(edges))


@pytest.mark.parametrize("at_s", [7.3, 10.02])
def test_a_missing_sample_voids_only_the_periods_it_touches(at_s: float) -> None:
    gap = VALUES.copy()
    gap[2, int(at_s * RATE_HZ)] = np.nan
    reference = from_frequency(1.0, 0.0, 49.9)
    broken = period_sums(recording(gap, RATE_HZ), reference)
    whole = period_sums(recording(VALUES, RATE_HZ), reference)
    void = np.isnan(broken.moment).any(axis=(1, 2))
    touched = [7] if at_s < 10.0 else [9, 10]  # the edges' weights reach three samples on
    assert np.flatnonzero(void).tolist() == touched
    assert np.isfinite(broken.moment[:, [0, 1, 3]]).all()
    assert broken.moment[~void] == pytest.approx(whole.moment[~void], abs=1e-12)
    kept = resolve(recording(gap, RATE_HZ), broken[5:15])
    assert np.isfinite(kept.coefficients).all()
    assert kept.periods == 10


def test_nothing_but_missing_samples_is_refused() -> None:
    run = recording(np.full(500, np.nan))
    sums = period_sums(run, from_frequency(1.0, 0.0, run.end_s))
    assert np.isnan(solve_periods(sums).coefficients).all()
    with pytest.raises(DataError, match=r"all 4 periods from 0\.000 s to 4\.000 s have missing"):
        resolve(run, sums)


def test_channels_of_opposite_scale_do_not_spoil_each_other() -> None:
    cycles = 1.03 * np.arange(1000) / 100.0
    signal = series(CONTENT, cycles)
    run = recording(np.stack((1e9 * signal, signal, 1e-9 * signal)))
    result = resolve(run, period_sums(run, from_frequency(1.03, 0.0, run.end_s)))
    scale = np.array([1e9, 1.0, 1e-9])[:, None]
    assert result.coefficients / scale == pytest.approx(np.tile(CONTENT, (3, 1)), abs=1e-11)
