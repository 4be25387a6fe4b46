"""The fit over each record, which part of it was used, and what the fit leaves."""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from analysis.inertia.record import RecordAnalysis
from analysis.inertia.series import Series
from hardware.description.arrays import FloatArray
from pmm.document.labels import display, plain, shown_name
from pmm.document.style import FIT, STEADY_SHADE, TRACE, new_figure
from pmm.inertia.sources import PeriodRuns
from pmm.report.envelope import zigzag

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST_RUNS = 4  # drawn; the numbers are those of all
_BINS = 2000  # more than a picture has columns
_MOST_POINTS = 6000
_POINTS_PER_PERIOD = 16
_FIT_POINTS_PER_PERIOD = 24


def record_figure(runs: PeriodRuns) -> "Figure":
    """Draw each record with its used part and the fit, and the residual below on its own scale."""
    records = runs.records[:MOST_RUNS]
    with new_figure(
        10.5, 1.3 + 2.5 * len(records), f"{plain(runs.where)}: fit over record{_and_more(runs)}"
    ) as figure:
        grid = figure.add_gridspec(2 * len(records), 1, height_ratios=(2.0, 1.0) * len(records))
        handles: list[Artist] = []
        for place, run in enumerate(records):
            axes = figure.add_subplot(grid[2 * place])
            rest = figure.add_subplot(grid[2 * place + 1], sharex=axes)
            handles = _draw_run(axes, run, runs.whole_records[place])
            _draw_rest(rest, run)
            axes.tick_params(labelbottom=False)
            if place == len(records) - 1:
                rest.set_xlabel("time (s)")
            else:
                rest.tick_params(labelbottom=True)
        figure.legend(handles=handles, loc="outside lower left", ncols=3)
    return figure


def _and_more(runs: PeriodRuns) -> str:
    surplus = len(runs.records) - MOST_RUNS
    return f" (first {MOST_RUNS} of {len(runs.records)} runs)" if surplus > 0 else ""


def _draw_run(axes: "Axes", run: RecordAnalysis, record: Series) -> list["Artist"]:
    series = run.part.series
    unit = display(series.unit)
    time_s, values = thin(record.time_s, record.values, run.part.period_s)
    span = axes.axvspan(
        float(series.time_s[0]), float(series.time_s[-1]), color=STEADY_SHADE, label="used"
    )
    smooth_s = _smooth(run)
    smooth_s, fitted = thin(smooth_s, unit.factor * run.fit.values(smooth_s), run.part.period_s)
    # a wide band behind the record: neither hides the other, however long the record is
    (fit,) = axes.plot(smooth_s, fitted, color=FIT, lw=2.6, alpha=0.55, label="fit")
    (trace,) = axes.plot(time_s, unit.factor * values, color=TRACE, lw=0.7, label="record")
    axes.set_title(f"{shown_name(series.name)}: {_periods(run)}", loc="left")
    axes.set_ylabel(f"{shown_name(series.channel)}\n({unit.label})")
    axes.set_xlim(float(record.time_s[0]), float(record.time_s[-1]))
    return [trace, fit, span]


def _draw_rest(axes: "Axes", run: RecordAnalysis) -> None:
    unit = display(run.part.series.unit)
    series = run.part.series
    time_s, values = thin(series.time_s, residual_on_grid(run), run.part.period_s)
    axes.plot(time_s, unit.factor * values, color=TRACE, lw=0.6)
    axes.axhline(0.0, color=FIT, lw=0.8)
    rms = unit.factor * float(np.sqrt(np.mean(run.fit.residual**2)))
    axes.set_ylabel(f"residual\n({unit.label})")
    axes.annotate(
        f"rms {rms:.2g} {unit.label}",
        (1.0, 1.0),
        xycoords="axes fraction",
        ha="right",
        va="bottom",
        fontsize=8.0,
    )


def _periods(run: RecordAnalysis) -> str:
    """Return the fit's periods, and what the tables go on with: undamped, at no amplitude."""
    fitted, at_none = (", ".join(f"{period_s:.5g}" for period_s in periods) for periods in (
        [mode.period_s for mode in run.fit.modes],
        [mode.rates.undamped(run.period(k).value) for k, mode in enumerate(run.modes)],
    ))  # fmt: skip
    return f"{fitted} s as fitted; {at_none} s undamped, at no amplitude"


def _smooth(run: RecordAnalysis) -> FloatArray:
    start, stop = run.fit.time_s[0], run.fit.time_s[-1]
    fastest = min(mode.period_s for mode in run.fit.modes)
    wanted = int(_FIT_POINTS_PER_PERIOD * (stop - start) / fastest)
    return np.linspace(start, stop, max(wanted, 200))


def residual_on_grid(run: RecordAnalysis) -> FloatArray:
    """Return the residual on the used part's even samples, NaN where none was recorded."""
    series = run.part.series
    if series.stamps_s is not None:
        residual = replace(series, values=run.fit.residual, stamps_s=run.fit.time_s)
        return residual.roughly_even().values
    values = np.full(series.values.size, np.nan)
    positions = (run.fit.time_s - series.start_s) * series.sample_rate_hz
    values[np.clip(np.rint(positions).astype(int), 0, values.size - 1)] = run.fit.residual
    return values


def thin(time_s: FloatArray, values: FloatArray, period_s: float) -> tuple[FloatArray, FloatArray]:
    """Return a curve with few enough points that it still looks the same.

    Every second, third ... sample, while these show a period's shape; else each stretch's extremes.
    """
    step = -(-time_s.size // _MOST_POINTS)
    if step * (time_s[1] - time_s[0]) * _POINTS_PER_PERIOD <= period_s:
        return time_s[::step], values[::step]
    if not np.isfinite(values).all():
        return time_s, values
    trace = zigzag(time_s, values.reshape(1, -1), _BINS)
    return trace.time_s, trace.values[0]
