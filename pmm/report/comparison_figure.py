"""Two channels on one clock, what is left, and the lag and the gain along the record."""

from typing import TYPE_CHECKING, Final

import numpy as np

from analysis.comparison.result import ChannelComparison
from analysis.uncertainty.freedom import student_factor
from hardware.description.arrays import FloatArray
from pmm.document.labels import shown_name
from pmm.document.style import FIT, PALETTE, TRACE, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_PERIODS: Final = 8.0  # that the enlarged part shows
_POINTS: Final = 4000


def comparison_figure(comparison: ChannelComparison, level: float = 0.95) -> "Figure":
    """Draw a comparison.

    Above, the second channel over what the first one, with gain, lag and clock rate, makes expect,
    for some periods where the motion is largest; what is left over the whole record; below, lag and
    gain of the parts of the record with their intervals, and over frequency.

    Parameters
    ----------
    level
        Probability of the intervals.
    """
    factor = float(student_factor(np.array([np.inf]), level)[0])
    with new_figure(
        10.5, 8.5, f"{shown_name(comparison.second)} over {shown_name(comparison.first)}"
    ) as figure:
        grid = figure.add_gridspec(4, 2)
        _enlarged(figure.add_subplot(grid[0, :]), comparison)
        _plot_remainder(figure.add_subplot(grid[1, :]), comparison)
        times, bins = comparison.over_time, comparison.over_frequency
        line_ms = 1e3 * (
            comparison.clock_rate.value * (times.at - comparison.mid_s) + comparison.lag_s.value
        )
        axes = figure.add_subplot(grid[2, 0])
        axes.plot(times.at, line_ms, color=FIT, label="line")
        _bars(axes, times.at, line_ms + 1e3 * times.lag_s, 1e3 * factor * times.lag_uncertainty_s)
        axes.set_ylabel("lag (ms)")
        axes = figure.add_subplot(grid[3, 0])
        _bars(axes, times.at, times.gain, factor * times.gain_uncertainty)
        axes.axhline(1.0, color=FIT)
        axes.set_ylabel("gain over its mean")
        axes.set_xlabel("time on the second's clock (s)")
        lag_ms = 1e3 * (comparison.lag_s.value + bins.lag_s)
        axes = figure.add_subplot(grid[2, 1])
        _bars(axes, bins.at, lag_ms, 1e3 * factor * bins.lag_uncertainty_s)
        axes.axhline(1e3 * comparison.lag_s.value, color=FIT)
        axes.set_ylabel("lag (ms)")
        axes = figure.add_subplot(grid[3, 1])
        _bars(axes, bins.at, bins.gain, factor * bins.gain_uncertainty)
        axes.axhline(1.0, color=FIT)
        axes.set_ylabel("gain over its mean")
        axes.set_xlabel("frequency (Hz)")
    return figure


def _enlarged(axes: "Axes", comparison: ChannelComparison) -> None:
    trace = comparison.trace
    half_s = _PERIODS / 2.0 / max(comparison.motion_hz, 1e-12)
    power = trace.measured**2
    middle_s = float(trace.time_s @ power / power.sum())
    near = np.abs(trace.time_s - middle_s) <= half_s
    axes.plot(trace.time_s[near], trace.measured[near], color=TRACE, label="second channel")
    axes.plot(
        trace.time_s[near], trace.expected[near], "--", color=FIT, label="expected of the first"
    )
    axes.legend(loc="upper right", ncols=2)
    axes.set_ylabel(f"{shown_name(comparison.second)}\n({comparison.unit})")


def _plot_remainder(axes: "Axes", comparison: ChannelComparison) -> None:
    trace = comparison.trace
    step = -(-len(trace.time_s) // _POINTS)
    axes.plot(
        trace.time_s[::step], (trace.measured - trace.expected)[::step], color=PALETTE[0], lw=0.6
    )
    axes.set_ylabel(f"what is left\n({comparison.unit})")
    axes.set_xlabel("time on the second's clock (s)")


def _bars(axes: "Axes", positions: FloatArray, values: FloatArray, half_width: FloatArray) -> None:
    axes.errorbar(positions, values, half_width, fmt="o", color=TRACE, ms=3.0, capsize=2.0)
