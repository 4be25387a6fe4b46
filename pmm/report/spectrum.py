"""The spectrum over a gate, and what the resolver lets through of each of its lines."""

from typing import TYPE_CHECKING

import numpy as np

from analysis.recording import Recording
from analysis.resolver.analysis import Analysis
from analysis.resolver.harmonics import Harmonics
from analysis.resolver.leakage import boxcar_leakage
from analysis.resolver.weights import gate_weights
from hardware.description.arrays import FloatArray
from pmm.document.labels import axis_label, display, loads_first, shown_name
from pmm.document.notation import counted
from pmm.document.style import FIT, PALETTE, TRACE, new_figure
from pmm.report.envelope import tops
from pmm.report.gate import caption, fitted, gate_sums, reading_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D


_READ_SAMPLES = 200_000
_FEW_LINES = 200
_POINTS = 3000  # of all channels together
_FLOOR = 1e-4  # of what is let through: nobody asks for less
_MOST_LOBES = 40  # beyond, only their tops are drawn
HANN = "Hann taper"


def spectrum_figure(analysis: Analysis, reading_index: int = 0) -> "Figure":
    """Draw the amplitude spectrum of each channel over one gate, and the resolver's response.

    Lines stand at whole multiples of 1/(m T), so harmonics fall on lines; the mean and the drift
    that the resolver took out are taken out. Below, on the same frequencies, the part of a
    vibration that appears in each harmonic at its worst phase.

    Raises
    ------
    ConfigurationError
        If there is no such reading.
    """
    reading = reading_of(analysis, reading_index)
    order = loads_first(analysis.recording)
    frequency_hz, amplitude, periods = gate_spectrum(analysis, reading)
    with new_figure(
        10.5, 3.3 + 1.7 * len(order), f"{shown_name(reading.run)}: {caption(reading)}"
    ) as figure:
        grid = figure.add_gridspec(len(order) + 1, 1, height_ratios=[*(1.0 for _ in order), 1.25])
        top: Axes | None = None
        for place, row in enumerate(order):
            axes = figure.add_subplot(grid[place], sharex=top)
            top = top or axes
            handles = _draw_spectrum(axes, analysis, reading, row, (frequency_hz, amplitude[row]))
            if place == 0:
                axes.set_title(f"amplitude of lines over {counted(periods, 'period')}", loc="left")
        below = figure.add_subplot(grid[-1], sharex=top)
        handles += _draw_leakage(below, reading, float(frequency_hz[-1]))
        if top is not None:
            _second_axis(top, reading)
        figure.legend(handles=handles, loc="outside lower left", ncols=5)
    return figure


def gate_spectrum(analysis: Analysis, reading: Harmonics) -> tuple[FloatArray, FloatArray, int]:
    """Return the lines of a gate's longest stretch without missing samples.

    The results are frequency_hz, amplitude, periods: their shapes are ``(lines,)`` and ``(channels,
    lines)``, in each channel's unit; the number of whole periods m that the lines rest on. The
    first line is 1/(m T), the last one lies below the Nyquist frequency and a little above the
    highest harmonic. On uneven time stamps the resolver's harmonics stand for theirs.
    """
    gate = gate_sums(analysis, reading)
    sound = np.isfinite(gate.moment).all(axis=(1, 2))
    breaks = np.flatnonzero(np.concatenate(([True], ~sound, [True])))
    longest = int(np.argmax(np.diff(breaks)))
    first, last = int(breaks[longest]), int(breaks[longest + 1]) - 1
    opened_s, closed_s, periods = gate.opened_s[first], gate.closed_s[last - 1], last - first
    recording = analysis.recording
    opening, closing = np.clip(
        recording.sample_number(np.array([opened_s, closed_s])), 0.0, recording.sample_count - 1.0
    )
    highest = max(8, 2 * reading.order + 2) * periods
    lines = np.arange(1, max(2, min(highest, int(np.ceil((closing - opening) / 2.0)) - 1)) + 1)
    if recording.stamps_s is not None:
        part = recording.between(float(opened_s), float(closed_s))
        amplitude = _lines_beside(analysis, reading, part, lines / float(closed_s - opened_s))
        orders = np.arange(1, min(reading.order, len(lines) // periods) + 1)
        amplitude[:, orders * periods - 1] = reading.amplitude[:, orders - 1]
    else:
        amplitude = _lines(recording, reading, float(opening), float(closing), len(lines))
    return lines / float(closed_s - opened_s), amplitude, periods


def _lines_beside(
    analysis: Analysis, reading: Harmonics, part: Recording, lines_hz: FloatArray
) -> FloatArray:
    """Amplitudes of what the fit leaves of samples that lie on no grid.

    The fit is taken off first: on such samples a strong line leaks into all others.
    """
    time_s = part.time_s()
    residual = part.samples[:, 0 : part.sample_count] - fitted(analysis, reading, time_s)
    mask = np.isfinite(residual)
    residual = np.where(mask, residual, 0.0)
    lines = [residual @ np.exp(-2j * np.pi * hz * time_s) for hz in lines_hz]
    return np.asarray(2.0 * np.abs(np.stack(lines, axis=1)) / mask.sum(axis=1)[:, None])


def _lines(
    recording: Recording, reading: Harmonics, opening: float, closing: float, count: int
) -> FloatArray:
    """Amplitudes of lines 1 to ``count`` of the samples between two fractional sample numbers."""
    from scipy.signal import czt

    first, weights = gate_weights(opening, closing, recording.sample_count)
    turn = -2j * np.pi / (closing - opening)  # of line 1, from one sample to the next
    total = np.zeros((len(recording.channels), count), dtype=np.complex128)
    middle_s = (reading.opened_s + reading.closed_s) / 2.0
    for start in range(0, len(weights), _READ_SAMPLES):
        part = weights[start : start + _READ_SAMPLES]
        begin = first + start
        time_s = recording.time_s(begin, begin + len(part))
        steady = reading.mean[:, None] + np.outer(reading.drift_per_s, time_s - middle_s)
        values = (recording.samples[:, begin : begin + len(part)] - steady) * part
        shift = np.exp(turn * (begin - opening) * np.arange(1, count + 1))
        total += shift * czt(values, m=count, w=np.exp(turn), a=np.exp(-turn), axis=1)
    return np.asarray(2.0 * np.abs(total) / (closing - opening))


def leakage(orders: FloatArray, reading: Harmonics) -> FloatArray:
    """Return the worst leakage of a reading's estimator at some multiples of its fundamental.

    That of a plain gate is :func:`analysis.resolver.leakage.boxcar_leakage`. A Hann taper adds half
    of each neighbouring bin: ``sinc(u) + sinc(u - 1) / 2 + sinc(u + 1) / 2`` in place of ``sinc``.

    Part of a vibration's amplitude, shape ``(orders, N)``.
    """
    if reading.estimator != HANN:
        return boxcar_leakage(orders, reading.periods, reading.order)
    n = np.arange(1, reading.order + 1)
    bins = [reading.periods * (orders[:, None] + sign * n) for sign in (-1.0, 1.0)]
    return np.asarray(
        sum(np.abs(np.sinc(u) + np.sinc(u - 1.0) / 2.0 + np.sinc(u + 1.0) / 2.0) for u in bins)
    )


def _draw_spectrum(
    axes: "Axes",
    analysis: Analysis,
    reading: Harmonics,
    row: int,
    lines: tuple[FloatArray, FloatArray],
) -> list["Line2D"]:
    channel = analysis.recording.channels[row]
    factor = display(channel.unit).factor
    bins = _POINTS // len(analysis.recording.channels)
    frequency_hz, amplitude = tops(*lines, bins)
    thinned = len(amplitude) < len(lines[1])
    (drawn,) = axes.semilogy(
        frequency_hz,
        amplitude * factor,
        ".-" if len(lines[1]) < _FEW_LINES else "-",
        color=TRACE,
        lw=0.8,
        ms=3.0,
        label="spectrum (highest of neighbouring lines)" if thinned else "spectrum",
    )
    (marked,) = axes.semilogy(
        reading.frequency_hz * np.arange(1, reading.order + 1),
        reading.amplitude[row] * factor,
        "o",
        mfc="none",
        mec=FIT,
        mew=1.4,
        ms=7.0,
        label="harmonics of the resolver",
    )
    axes.set_ylabel(axis_label(channel))
    axes.tick_params(labelbottom=False)
    _plain_numbers(axes, _range(amplitude * factor))
    return [drawn, marked]


def _draw_leakage(axes: "Axes", reading: Harmonics, highest_hz: float) -> list["Line2D"]:
    highest = highest_hz / reading.frequency_hz
    lobes = int(np.ceil(reading.periods * highest))
    orders = np.linspace(0.0, highest, 32 * lobes + 1)
    title = f"let through of a vibration at its worst phase ({reading.estimator})"
    if lobes > _MOST_LOBES:
        zeros = f"; nothing at whole multiples of f/{reading.periods}"
        title += ": top of each lobe" + (zeros if reading.estimator != HANN else "")
    drawn, lowest = [], 1.0
    for n, curve in enumerate(leakage(orders, reading).T, start=1):
        x, part = (
            tops(orders, curve, min(lobes, _POINTS // 4))
            if lobes > _MOST_LOBES
            else (
                orders,
                curve,
            )
        )
        lowest = min(lowest, float(part.min()))
        drawn += axes.semilogy(
            x * reading.frequency_hz,
            np.maximum(part, _FLOOR / 10.0),
            color=PALETTE[(n - 1) % len(PALETTE)],
            lw=1.0,
            label=f"into harmonic {n}",
        )
    axes.set_xlim(0.0, highest_hz)
    axes.set_xlabel("frequency (Hz)")
    axes.set_ylabel("let through\n(part of amplitude)")
    axes.set_title(title, loc="left")
    _plain_numbers(axes, (max(_FLOOR, lowest / 2.0), 2.0))
    return drawn


def _range(values: FloatArray) -> tuple[float, float]:
    """Limits for a logarithmic axis: two decades or more, no more than eight.

    What lies eight decades below the largest value is rounding.
    """
    present = values[values > 0.0]
    if not present.size:
        return 1e-2, 1.0
    high = 2.0 * float(present.max())
    return float(np.clip(present.min() / 2.0, 1e-8 * high, 1e-2 * high)), high


def _plain_numbers(axes: "Axes", limits: tuple[float, float]) -> None:
    """Write 0.001 for 10^-3: powers would need the mathematics that names must not reach."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

    axes.set_autoscaley_on(False)  # it would complain about a channel of zeros
    axes.set_ylim(*limits)
    axes.yaxis.set_major_locator(LogLocator(numticks=6))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_minor_locator(NullLocator())


def _second_axis(axes: "Axes", reading: Harmonics) -> None:
    """Multiples of the fundamental along the top."""
    frequency_hz = reading.frequency_hz
    second = axes.secondary_xaxis(
        "top",
        functions=(
            lambda hz: np.asarray(hz, dtype=np.float64) / frequency_hz,
            lambda order: np.asarray(order, dtype=np.float64) * frequency_hz,
        ),
    )
    second.set_xlabel("multiples of the fundamental")
