"""The figure of a value over time: intervals, limits, and what lies outside."""

from datetime import UTC, datetime
from typing import TYPE_CHECKING

import numpy as np

from pmm.archive.trends import Trend
from pmm.document.style import PALETTE, STEADY_SHADE, TRACE, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def trend_figure(trend: Trend) -> "Figure":
    """Draw a coefficient over time with intervals and limits."""
    from matplotlib.dates import AutoDateLocator, ConciseDateFormatter

    times = np.array([_utc(row["recorded_utc"]) for row in trend.rows], "datetime64[s]")
    values = np.array([row["value"] for row in trend.rows])
    halves = np.array([row["half_width"] or 0.0 for row in trend.rows])
    low, high = np.array([(point.low, point.high) for point in trend.chart]).T
    outside = np.array([point.outside for point in trend.chart])
    with new_figure(7.5, 3.6) as figure:
        axes = figure.subplots()
        if np.isfinite(low).any():
            axes.vlines(times, low, high, color=STEADY_SHADE, linewidth=12.0,
                        label="limits by the others")  # fmt: skip
        axes.axhline(values.mean(), color=TRACE, linewidth=0.6, label="mean")
        axes.errorbar(times, values, halves, fmt="o", color=PALETTE[0], markersize=4.0,
                      label="measured")  # fmt: skip
        if outside.any():
            axes.plot(times[outside], values[outside], "s", color=PALETTE[1], label="outside",
                      fillstyle="none", markersize=9.0)  # fmt: skip
        locator = AutoDateLocator(minticks=2)  # type: ignore[no-untyped-call]
        axes.xaxis.set_major_locator(locator)
        formatter = ConciseDateFormatter(locator)  # type: ignore[no-untyped-call]
        axes.xaxis.set_major_formatter(formatter)
        axes.set_ylabel(f"{trend.name} ({trend.unit})" if trend.unit else trend.name)
        axes.legend(ncols=4, loc="upper center", bbox_to_anchor=(0.5, -0.12))
        at = f", {trend.frequency_hz:.4g} Hz" if trend.frequency_hz else ""
        hull = f"{trend.hull}, " if trend.hull else ""
        figure.suptitle(f"{trend.name}: {hull}{trend.speed_m_s:.4g} m/s{at}")
    return figure


def _utc(time: str) -> datetime:
    """Return a time without its zone: an axis has one for all."""
    return datetime.fromisoformat(time).astimezone(UTC).replace(tzinfo=None)
