"""What the figures show against the numbers of the analysis that they show."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.patches import Ellipse
from numpy.typing import NDArray

from analysis.recording import Recording
from analysis.resolver.leakage import boxcar_leakage
from hardware.description.errors import ConfigurationError
from pmm.report.envelope import overview, tops, zigzag
from pmm.report.gate import fitted, reading_of, single_periods
from pmm.report.plots import FIGURES, gate_figure, phasor_figure, spectrum_figure
from pmm.report.region import ellipses, region_factor
from pmm.report.spectrum import gate_spectrum, leakage
from tests.pmm.report.runs import DRIFT_N_PER_S, FREQUENCY_HZ, SLOSH, analysed, run


class _Lazy:
    """Samples that count how many are read at a time."""

    def __init__(self, values: NDArray[np.float64]) -> None:
        self._values = values
        self.largest = 0

    @property
    def shape(self) -> tuple[int, ...]:
        return self._values.shape

    def __getitem__(self, key: tuple[object, slice], /) -> NDArray[np.float64]:
        part = self._values[key]  # type: ignore[index]
        self.largest = max(self.largest, part.shape[1])
        return np.asarray(part)


def test_the_fit_is_the_signal_without_its_noise() -> None:
    analysis = analysed(run(noise_n=0.0))
    reading = analysis.readings[0]
    time_s = np.linspace(reading.opened_s, reading.closed_s, 777)
    theta = 2.0 * np.pi * FREQUENCY_HZ * time_s
    expected = 3.0 + 20.0 * np.sin(theta) + 0.8 * np.cos(2.0 * theta) + DRIFT_N_PER_S * time_s
    # What the sloshing leaves in a gate of this length.
    assert np.abs(fitted(analysis, reading, time_s)[1] - expected).max() < 0.06


def test_the_fit_keeps_its_middle_where_periods_are_void() -> None:
    recording = run(noise_n=0.0)
    values = np.array(recording.samples[:, 0 : recording.sample_count])
    values[1:, 350:400] = np.nan
    analysis = analysed(replace(recording, samples=values), opens_s=2.0)
    time_s = analysis.recording.time_s(1200, 1500)
    residual = values[1, 1200:1500] - fitted(analysis, analysis.readings[0], time_s)[1]
    assert abs(residual.mean()) < 0.05


def test_loads_come_first_in_shown_units_and_the_zoom_ends_with_the_gate() -> None:
    analysis = analysed()
    axes = gate_figure(analysis).axes
    labels = [one.get_ylabel() for one in axes]
    assert labels[::3] == ["force_0\n(N)", "force_1\n(N)", "displacement_aft\n(mm)"]
    reading = analysis.readings[0]
    zoomed = axes[1].get_lines()[-1]
    x, y = (np.asarray(part) for part in zoomed.get_data())
    assert x[[0, -1]] == pytest.approx([reading.closed_s - 2.0 / FREQUENCY_HZ, reading.closed_s])
    assert y == pytest.approx(fitted(analysis, reading, x)[1])
    assert np.abs(np.asarray(axes[7].get_lines()[-1].get_ydata())).max() == pytest.approx(30.0)


def test_the_gate_is_shaded_where_it_lies() -> None:
    analysis = analysed(gate_periods=4)
    reading = analysis.readings[1]
    spans = {patch.get_label(): patch for patch in gate_figure(analysis, 1).axes[0].patches}
    left = spans["gate"].get_x()  # type: ignore[attr-defined]
    width = spans["gate"].get_width()  # type: ignore[attr-defined]
    assert (left, left + width) == pytest.approx((reading.opened_s, reading.closed_s))
    steady = analysis.steady_sums
    assert spans["steady stretch"].get_x() == pytest.approx(steady.opened_s[0])  # type: ignore[attr-defined]


def test_a_long_trace_touches_every_extreme_and_is_read_in_parts() -> None:
    rng = np.random.default_rng(3)
    values = rng.normal(size=(2, 700_001))
    values[0, 123_456], values[1, 654_321] = 50.0, -60.0
    values[1, :20_000] = np.nan
    lazy = _Lazy(values)
    recording = Recording("long", run(1).channels, lazy, 1000.0)  # type: ignore[arg-type]
    trace = overview(recording, 100)
    assert trace.values.shape == (2, 200)
    assert lazy.largest <= 200_000
    assert np.nanmax(trace.values, axis=1) == pytest.approx(values[:, 20_000:].max(axis=1))
    assert np.nanmin(trace.values, axis=1) == pytest.approx(values[:, 20_000:].min(axis=1))
    assert np.isnan(trace.values[1, :4]).all()
    assert trace.time_s[int(np.nanargmax(trace.values[0]))] == pytest.approx(123.456, abs=7.1)


def thinned_out() -> Recording:
    """Return the run with three of five rows left, at random, and a second without any."""
    whole, rng = run(), np.random.default_rng(3)
    kept = rng.random(whole.sample_count) < 0.6
    kept[400:500] = False
    at = np.flatnonzero(kept)
    time_s, values = whole.time_s()[at], whole.samples[:, 0 : whole.sample_count][:, at]
    rate_hz = (len(at) - 1) / float(np.ptp(time_s))
    return replace(
        whole,
        samples=values,
        stamps_s=time_s,
        start_s=float(time_s[0]),
        sample_rate_hz=rate_hz,
    )


def test_uneven_samples_are_drawn_at_their_times() -> None:
    """A ramp of the time itself: what is drawn of each stretch is about its middle."""
    recording = thinned_out()
    time_s = recording.time_s()
    ramp = replace(recording, samples=np.array([time_s]), channels=recording.channels[:1])
    for trace in (overview(ramp, 60), zigzag(time_s, np.array([time_s]), 60)):
        low, high = trace.values[0, ::2], trace.values[0, 1::2]
        assert trace.thinned
        assert trace.time_s[::2] == pytest.approx((low + high) / 2.0)


def test_the_spectrum_of_uneven_samples_has_the_harmonics_and_no_leakage_of_them() -> None:
    analysis = analysed(thinned_out())
    reading = analysis.readings[0]
    frequency_hz, amplitude, periods = gate_spectrum(analysis, reading)
    at = periods * np.arange(1, reading.order + 1) - 1
    assert frequency_hz[at] == pytest.approx(reading.frequency_hz * np.arange(1, reading.order + 1))
    assert amplitude[:, at] == pytest.approx(reading.amplitude)
    beside = np.delete(amplitude, at, axis=1)
    assert np.median(beside[1]) < 0.01 * reading.amplitude[1, 0]


def test_short_traces_are_handed_through_and_tops_keep_their_place() -> None:
    x = np.arange(50.0)
    assert zigzag(x, x[None], 25).values is not None
    assert not zigzag(x, x[None], 25).thinned
    values = np.zeros(1000)
    values[777] = 1.0
    where, highest = tops(np.arange(1000.0), values, 10)
    assert where[np.argmax(highest)] == 777.0
    assert len(where) == 10


def test_a_thinned_record_is_drawn_as_a_band() -> None:
    axes = gate_figure(analysed(run(seconds=60.0))).axes[0]
    assert any(isinstance(part, PolyCollection) for part in axes.collections)


def test_ellipses_lie_about_their_phasors_with_the_covariance_s_axes() -> None:
    analysis = analysed()
    reading = analysis.readings[0]
    panel = phasor_figure(analysis).axes[0]
    drawn = [patch for patch in panel.patches if isinstance(patch, Ellipse)]
    factor = region_factor(float(reading.degrees_of_freedom[1]))
    for patch, row in zip(drawn, (1, 2), strict=True):
        expected = np.array([reading.in_phase[row, 0], reading.quadrature[row, 0]])
        assert np.asarray(patch.get_center()) == pytest.approx(expected)
        axes = 2.0 * factor * np.sqrt(np.linalg.eigvalsh(reading.phasor_covariance()[row, 0]))
        assert (patch.get_height(), patch.get_width()) == pytest.approx(tuple(axes))
    assert panel.get_aspect() == 1.0
    assert "N" in phasor_figure(analysis).axes[3].get_xlabel()


def test_single_periods_have_the_reading_as_their_mean() -> None:
    analysis = analysed()
    reading = analysis.readings[0]
    singles = single_periods(analysis, reading)
    assert singles.shape == (reading.periods, 3, 3, 2)
    mean = reading.coefficients[:, 1:].reshape(3, 3, 2)
    # Each period is solved alone, the gate in one: edges between samples differ by a little.
    assert singles.mean(axis=0) == pytest.approx(mean, abs=2e-3)


def test_few_periods_have_no_ellipse_and_say_so() -> None:
    analysis = analysed(opens_s=2.0, periods=2)
    assert all(one is None for row in ellipses(analysis.readings[0]) for one in row)
    figure = phasor_figure(analysis)
    assert not [part for one in figure.axes for part in one.patches if isinstance(part, Ellipse)]
    legend = figure.subfigs[0].legends[0]
    assert any("too few periods" in text.get_text() for text in legend.get_texts())


def test_lines_at_the_harmonics_are_the_resolver_s() -> None:
    analysis = analysed()
    reading = analysis.readings[0]
    frequency_hz, amplitude, periods = gate_spectrum(analysis, reading)
    at = np.arange(1, 4) * periods - 1
    assert frequency_hz[at] == pytest.approx(reading.frequency_hz * np.arange(1, 4))
    assert amplitude[:, at] == pytest.approx(reading.amplitude, abs=2e-3)
    slosh = np.argmax(np.where(np.abs(frequency_hz / FREQUENCY_HZ - SLOSH) < 0.2, amplitude[1], 0))
    assert frequency_hz[slosh] == pytest.approx(SLOSH * FREQUENCY_HZ, abs=1.0 / 15.0)


def test_the_spectrum_passes_over_void_periods() -> None:
    recording = run()
    values = np.array(recording.samples[:, 0 : recording.sample_count])
    values[1, 500:520] = np.nan
    analysis = analysed(replace(recording, samples=values), opens_s=2.0)
    _, amplitude, periods = gate_spectrum(analysis, analysis.readings[0])
    assert np.isfinite(amplitude).all()
    assert periods < analysis.readings[0].periods


def test_leakage_is_the_resolver_s_and_a_hann_taper_s_falls_faster() -> None:
    reading = analysed().readings[0]
    orders = np.array([0.5, 1.0, SLOSH, 2.21, 6.5])
    plain = leakage(orders, reading)
    assert plain == pytest.approx(boxcar_leakage(orders, reading.periods, 3))
    tapered = leakage(orders, analysed(hann=True).readings[0])
    assert tapered[1, 0] == pytest.approx(1.0)
    far = [(2, 0), (3, 2), (4, 1)]
    assert all(tapered[k] < 0.1 * plain[k] for k in far if plain[k] > 1e-3)


@pytest.mark.slow
def test_the_spectrum_s_second_axis_counts_harmonics() -> None:
    figure = spectrum_figure(analysed())
    second = figure.axes[0].child_axes[0]
    figure.draw_without_rendering()
    top = np.array(figure.axes[0].get_xlim()) / FREQUENCY_HZ
    assert np.array(second.get_xlim()) == pytest.approx(top, rel=1e-3)


@pytest.mark.parametrize("kind", FIGURES)
def test_a_reading_that_is_not_there_is_refused(kind: str) -> None:
    with pytest.raises(ConfigurationError, match="numbered from 0 to 0"):
        FIGURES[kind](analysed(), 1)
    with pytest.raises(ConfigurationError, match="no reading -1"):
        reading_of(analysed(), -1)


@pytest.mark.parametrize(
    ("settings", "window"),
    [
        ({}, "steady stretch"),
        ({"opens_s": 3.0, "periods": 5}, "window given"),
        ({"steady_tolerance": 1e-9}, "steady stretch"),
    ],
)
def test_the_window_is_called_by_how_it_was_come_by(
    settings: dict[str, object], window: str
) -> None:
    labels = {patch.get_label() for patch in gate_figure(analysed(**settings)).axes[0].patches}
    assert labels == {"record", window, "gate"}


def test_a_run_that_is_nowhere_steady_is_not_called_so() -> None:
    recording = run(noise_n=0.0, loads=1)
    samples = np.array(recording.samples[:, 0 : recording.sample_count])
    samples[1] = samples[0] * np.linspace(200.0, 3000.0, samples.shape[1])
    analysis = analysed(replace(recording, samples=samples), steady_tolerance=0.02)
    labels = {patch.get_label() for patch in gate_figure(analysis).axes[0].patches}
    assert labels == {"record", "all periods, not steady", "gate"}


def test_the_panel_of_what_is_let_through_has_no_empty_half() -> None:
    panel = spectrum_figure(analysed()).axes[-1]
    low, _ = panel.get_ylim()
    lowest = min(float(np.min(line.get_ydata())) for line in panel.lines)  # type: ignore[arg-type]
    assert low == pytest.approx(lowest / 2.0)
