"""The gate in its record: what was recorded, which part was used, how well the fit lies on it."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from analysis.resolver.analysis import Analysis
from analysis.resolver.basis import harmonic_basis
from analysis.resolver.harmonics import Harmonics
from analysis.resolver.period_values import solve_periods, usable
from analysis.resolver.sums import PeriodSums
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from pmm.document.labels import Display, axis_label, display, loads_first, shown_name
from pmm.document.notation import counted
from pmm.document.style import (
    FIT,
    GATE_SHADE,
    PALETTE,
    RECORD_SHADE,
    STEADY_SHADE,
    TRACE,
    new_figure,
)
from pmm.harmonics.rows import window_kind
from pmm.report.envelope import Trace, overview, zigzag

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_POINTS = 3400  # of one kind of curve, shared by all channels: an SVG stays small
_FIT_POINTS_PER_PERIOD = 24
_MOST_TICKS = 400  # of one kind, shared by all channels
_DENSE = 60  # periods: beyond, the fit is drawn as its outline
# What a window is called by how it was come by.
WINDOWS = {
    "found steady": "steady stretch",
    "given": "window given",
    "run's gate": "the run's own gate",
    "not steady": "all periods, not steady",
}


@dataclass(frozen=True)
class _Curves:
    """What is drawn: the record, the fit in the gate, and both again over the last periods."""

    record: Trace
    fit: Trace
    zoom: list[tuple[Trace, Trace, Trace]]  # of each channel: trace, fit, residual


def gate_figure(analysis: Analysis, reading_index: int = 0) -> "Figure":
    """Draw each channel over the whole record, and over the last two periods of one gate.

    Shaded are the record, the steady stretch (or the window given) and the gate. The fit (mean,
    harmonics and drift) lies over the trace inside the gate; what it leaves is below the last two
    periods. Ticks along the bottom are where whole periods meet, those along the top the
    photocell's pulses.

    Raises
    ------
    ConfigurationError
        If there is no such reading.
    """
    reading = reading_of(analysis, reading_index)
    order = loads_first(analysis.recording)
    curves = _curves(analysis, reading, max(60, _POINTS // (2 * len(order))))
    with new_figure(
        10.5, 1.3 + 1.9 * len(order), f"{shown_name(reading.run)}: {caption(reading)}"
    ) as figure:
        heights = (2.2, 1.0) * len(order)
        grid = figure.add_gridspec(len(heights), 2, width_ratios=(2.0, 1.0), height_ratios=heights)
        first: Axes | None = None
        for place, row in enumerate(order):
            axes = figure.add_subplot(grid[2 * place : 2 * place + 2, 0], sharex=first)
            first = first or axes
            zoom = figure.add_subplot(grid[2 * place, 1])
            rest = figure.add_subplot(grid[2 * place + 1, 1], sharex=zoom)
            last = place == len(order) - 1
            handles = _draw_record(axes, analysis, reading, curves, row)
            _draw_zoom(zoom, rest, curves, row, display(analysis.recording.channels[row].unit))
            for panel in (axes, rest):
                panel.tick_params(labelbottom=last)
                panel.set_xlabel("time (s)" if last else "")
            if place == 0:
                axes.set_title("whole record", loc="left")
                zoom.set_title("end of the gate, and residual", loc="left")
        figure.legend(handles=handles, loc="outside lower left", ncols=4)
    return figure


def _curves(analysis: Analysis, reading: Harmonics, bins: int) -> _Curves:
    density = min(reading.periods * max(_FIT_POINTS_PER_PERIOD, 8 * reading.order), 100_000)
    inside_s = np.linspace(reading.opened_s, reading.closed_s, density + 1)
    fit = zigzag(inside_s, fitted(analysis, reading, inside_s), bins)
    channels = range(len(analysis.recording.channels))
    return _Curves(
        overview(analysis.recording, bins),
        fit,
        [_zoom(analysis, reading, row, bins // 3) for row in channels],
    )


def _zoom(
    analysis: Analysis, reading: Harmonics, row: int, bins: int
) -> tuple[Trace, Trace, Trace]:
    recording, gate = analysis.recording, gate_sums(analysis, reading)
    begin_s, end_s = float(gate.opened_s[-2:][0]), float(gate.closed_s[-1])
    start, stop = recording.sample_number(np.array([begin_s, end_s])).round(9)
    first, last = int(np.ceil(start)), int(np.floor(stop)) + 1
    time_s = recording.time_s(first, last)
    values = recording.samples[row : row + 1, first:last]
    residual = values - fitted(analysis, reading, time_s)[row]
    smooth_s = np.linspace(begin_s, end_s, 2 * max(_FIT_POINTS_PER_PERIOD, 8 * reading.order) + 1)
    smooth = Trace(smooth_s, fitted(analysis, reading, smooth_s)[row : row + 1])
    return zigzag(time_s, values, bins), smooth, zigzag(time_s, residual, bins)


def _draw_record(
    axes: "Axes", analysis: Analysis, reading: Harmonics, curves: _Curves, row: int
) -> list["Artist"]:
    recording, steady = analysis.recording, analysis.steady_sums
    unit = display(recording.channels[row].unit)
    window = WINDOWS[window_kind(analysis)]
    axes.set_ylabel(axis_label(recording.channels[row]))
    axes.set_xlim(recording.start_s, recording.end_s)
    shades = [
        axes.axvspan(
            float(start_s), float(stop_s), margin, 1.0 - margin, color=color, zorder=0, label=label
        )
        # Each lower than the one around it, so that it is seen even where the times are the same.
        for start_s, stop_s, margin, color, label in (
            (recording.start_s, recording.end_s, 0.0, RECORD_SHADE, "record"),
            (steady.opened_s[0], steady.closed_s[-1], 0.0, STEADY_SHADE, window),
            (reading.opened_s, reading.closed_s, 0.12, GATE_SHADE, "gate"),
        )
    ]
    trace = _draw_trace(axes, curves.record, row, unit.factor)
    fit = _draw_fit(axes, reading, curves.fit, row, unit.factor)
    return [trace, fit, *shades, *_draw_ticks(axes, analysis)]


def _draw_trace(axes: "Axes", trace: Trace, row: int, factor: float) -> "Artist":
    """Draw what was measured: a line, or the band between the extremes where it was thinned."""
    values = trace.values[row] * factor
    if trace.thinned:
        low, high = values[::2], values[1::2]
        return axes.fill_between(
            trace.time_s[::2], low, high, color=TRACE, lw=0.6, label="measured"
        )
    (line,) = axes.plot(trace.time_s, values, color=TRACE, lw=0.8, label="measured")
    return line


def _draw_fit(axes: "Axes", reading: Harmonics, fit: Trace, row: int, factor: float) -> "Artist":
    """Draw the fit; of many periods only its two bounds, so that the trace stays in sight."""
    values = fit.values[row] * factor
    label = "mean + harmonics + drift"
    if reading.periods > _DENSE:
        axes.plot(fit.time_s[::2], values[::2], color=FIT, lw=1.0)
        values, time_s = values[1::2], fit.time_s[1::2]
        label += " (bounds)"
    else:
        time_s = fit.time_s
    (line,) = axes.plot(time_s, values, color=FIT, lw=0.9, label=label)
    return line


def _draw_ticks(axes: "Axes", analysis: Analysis) -> list["Artist"]:
    edges_s = np.append(analysis.sums.opened_s, analysis.sums.closed_s[-1])
    pulses_s = analysis.recording.photocell_edges_s
    most = max(40, _MOST_TICKS // len(analysis.recording.channels))
    ticks: list[Artist] = [_ticks(axes, edges_s, most, (0.0, 0.07), "whole periods meet")]
    if pulses_s is not None and len(pulses_s):
        ticks.append(_ticks(axes, pulses_s, most, (0.93, 1.0), "photocell pulses"))
    return ticks


def _ticks(
    axes: "Axes", times_s: FloatArray, most: int, reach: tuple[float, float], label: str
) -> "Artist":
    """Draw ticks along an edge, as one path; where there are very many, every so many-th."""
    step = -(-len(times_s) // most)
    ticks_s = times_s[::step]
    (line,) = axes.plot(
        np.repeat(ticks_s, 3),
        np.tile((*reach, np.nan), len(ticks_s)),
        color=PALETTE[0] if reach[0] == 0.0 else "black",
        lw=0.9,
        transform=axes.get_xaxis_transform(),
        label=label if step == 1 else f"{label} (1 in {step})",
    )
    return line


def _draw_zoom(zoom: "Axes", rest: "Axes", curves: _Curves, row: int, unit: Display) -> None:
    trace, fit, residual = curves.zoom[row]
    _draw_trace(zoom, trace, 0, unit.factor)
    zoom.plot(fit.time_s, fit.values[0] * unit.factor, color=FIT, lw=1.0)
    zoom.tick_params(labelbottom=False)
    zoom.locator_params(axis="x", nbins=5)
    zoom.set_xlim(fit.time_s[0], fit.time_s[-1])
    _draw_trace(rest, residual, 0, unit.factor)
    rest.axhline(0.0, color=FIT, lw=0.8)
    rest.set_ylabel(f"residual\n({unit.label})")


def reading_of(analysis: Analysis, reading_index: int) -> Harmonics:
    """Return one reading.

    Raises
    ------
    ConfigurationError
        If there is no such reading.
    """
    count = len(analysis.readings)
    if not 0 <= reading_index < count:
        raise ConfigurationError(
            f"{analysis.recording.name}: no reading {reading_index}; "
            f"it has {count}, numbered from 0 to {count - 1}"
        )
    return analysis.readings[reading_index]


def gate_sums(analysis: Analysis, reading: Harmonics) -> PeriodSums:
    """Return the periods of a reading's gate, those with missing samples included."""
    sums = analysis.sums
    slack = 1e-6 * (sums.closed_s[0] - sums.opened_s[0])
    inside = (sums.opened_s > reading.opened_s - slack) & (sums.closed_s < reading.closed_s + slack)
    return sums[np.asarray(inside)]


def fitted(analysis: Analysis, reading: Harmonics, time_s: FloatArray) -> FloatArray:
    """Return mean, harmonics and drift of a reading at some times, shape ``(channels, times)``."""
    gate = usable(gate_sums(analysis, reading))
    # The mean belongs to the middle of the periods that were used, from the first sample on.
    middle_s = np.linalg.solve(gate.gram.sum(axis=0), gate.ramp.sum(axis=0))[0]
    elapsed_s = time_s - analysis.recording.start_s - middle_s
    basis = harmonic_basis(analysis.reference.cycles_at(time_s), gate.orders)
    return np.asarray(reading.coefficients @ basis + np.outer(reading.drift_per_s, elapsed_s))


def single_periods(analysis: Analysis, reading: Harmonics) -> FloatArray:
    """Return ``(S_n, C_n)`` of each period of the gate, shape ``(periods, channels, N, 2)``.

    The drift that was taken out of the reading is taken out of them too; periods with missing
    samples are left out.
    """
    values = solve_periods(usable(gate_sums(analysis, reading)))
    steady = values.coefficients - reading.drift_per_s[:, None] * values.ramp[:, None, :]
    return steady[:, :, 1:].reshape(*steady.shape[:2], reading.order, 2)


def caption(reading: Harmonics) -> str:
    """Return where a gate lies, in words."""
    return (
        f"gate of {counted(reading.periods, 'period')}, {reading.opened_s:.3f} s to "
        f"{reading.closed_s:.3f} s, {reading.frequency_hz:.5g} Hz"
    )
