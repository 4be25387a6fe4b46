"""The spectrum of each record with the fitted periods, and beats where two oscillations are."""

from typing import TYPE_CHECKING

import numpy as np

from analysis.inertia.beats import beat_period
from analysis.inertia.record import RecordAnalysis
from analysis.inertia.spectrum import spectrum
from hardware.description.arrays import FloatArray
from pmm.document.labels import display, plain, shown_name
from pmm.document.style import FIT, PALETTE, TRACE, new_figure
from pmm.inertia.sources import PeriodRuns
from pmm.report.envelope import zigzag
from pmm.report.inertia_record import MOST_RUNS, residual_on_grid, thin

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_REACH = 4.0  # times the highest fitted frequency
_MOST_POINTS = 1500
_BINS = 700


def spectrum_figure(runs: PeriodRuns) -> "Figure":
    """Draw amplitude spectra of records and residuals, and the beats of the first record.

    The envelope of the beats is that of the fit: the sum and the difference of both amplitudes are
    its bounds, and quiet moments are a beat period apart.
    """
    beating = len(runs.records[0].fit.modes) == 2
    with new_figure(10.5, 4.2 + 3.0 * beating) as figure:
        title = "spectrum and beats" if beating else "spectrum"
        figure.suptitle(f"{plain(runs.where)}: {title}")
        axes = figure.add_subplot(1 + beating, 1, 1)
        _draw_spectra(axes, runs)
        if beating:
            _draw_beats(figure.add_subplot(2, 1, 2), runs.records[0])
    return figure


def _draw_spectra(axes: "Axes", runs: PeriodRuns) -> None:
    first = runs.records[0]
    unit = display(first.part.series.unit)
    top_hz = _REACH / min(mode.period_s for mode in first.fit.modes)
    for number, run in enumerate(runs.records[:MOST_RUNS]):
        color = PALETTE[number % len(PALETTE)]
        name = shown_name(run.part.series.name)
        series = run.part.series.roughly_even()
        rate = series.sample_rate_hz
        hz, amplitude = _lines(series.values, rate, top_hz)
        axes.semilogy(hz, unit.factor * amplitude, color=color, lw=0.9, label=name)
        hz, rest = _lines(residual_on_grid(run), rate, top_hz)
        axes.semilogy(hz, unit.factor * rest, ":", color=color, lw=0.9, label=f"{name}, residual")
    for mode in first.fit.modes:
        axes.axvline(1.0 / mode.period_s, color=FIT, lw=0.8, zorder=0)
        axes.annotate(
            f"{mode.period_s:.4g} s",
            (1.0 / mode.period_s, 1.01),
            xycoords=("data", "axes fraction"),
            ha="right" if mode is first.fit.modes[0] else "left",
            fontsize=8.0,
            color=FIT,
        )
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.set_xlim(0.0, top_hz)
    axes.set_xlabel("frequency (Hz)")
    axes.set_ylabel(f"amplitude ({unit.label})")
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))


def _lines(values: FloatArray, rate_hz: float, top_hz: float) -> tuple[FloatArray, FloatArray]:
    lines = spectrum(values, rate_hz)
    inside = (lines.frequency_hz > 0.0) & (lines.frequency_hz <= top_hz)
    hz, amplitude = lines.frequency_hz[inside], lines.amplitude[inside]
    if hz.size <= _MOST_POINTS:
        return hz, amplitude
    trace = zigzag(hz, amplitude.reshape(1, -1), _BINS)
    return trace.time_s, trace.values[0]


def _draw_beats(axes: "Axes", run: RecordAnalysis) -> None:
    series, (slow, fast) = run.part.series, run.fit.modes
    unit = display(series.unit)
    time_s, values = thin(series.time_s, series.values, fast.period_s)
    axes.plot(time_s, unit.factor * (values - run.fit.offset), color=TRACE, lw=0.8, label="record")
    along = np.linspace(float(time_s[0]), float(time_s[-1]), 800)
    t = along - run.fit.start_s
    first = slow.amplitude * np.exp(-slow.decay_1_s * t)
    second = fast.amplitude * np.exp(-fast.decay_1_s * t)
    turn = 2.0 * np.pi * t * (1.0 / slow.period_s - 1.0 / fast.period_s)
    turn += slow.phase_rad - fast.phase_rad
    envelope = np.abs(first + second * np.exp(-1j * turn))
    label = "envelope of the fit"
    for side in (envelope, -envelope):
        axes.plot(along, unit.factor * side, color=FIT, lw=1.0, label=label)
        label = ""
    beat = abs(beat_period(slow.period_s, fast.period_s))
    axes.set_title(
        f"{shown_name(series.name)}: a beat every {beat:.4g} s, "
        f"ratio of the periods {slow.period_s / fast.period_s:.5f}",
        loc="left",
    )
    axes.margins(x=0.0)
    axes.set_xlabel("time (s)")
    axes.set_ylabel(f"{shown_name(series.channel)}\n({unit.label})")
    axes.legend(loc="upper right", ncols=2)
