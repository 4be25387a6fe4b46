"""The figure of a value over time: intervals, limits, and what lies outside."""

from datetime import UTC, datetime
from typing import TYPE_CHECKING

import numpy as np

from pmm.archive.trends import Trend
from pmm.document.style import PALETTE, STEADY_SHADE, TRACE, drawn

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def trend_figure(found: Trend) -> "Figure":
    """Draw a coefficient over time with intervals and limits."""
    from matplotlib.dates import AutoDateLocator, ConciseDateFormatter

    times = np.array([_utc(row["recorded_utc"]) for row in found.rows], "datetime64[s]")
    values = np.array([row["value"] for row in found.rows])
    halves = np.array([row["half_width"] or 0.0 for row in found.rows])
    low, high = np.array([(one.low, one.high) for one in found.chart]).T
    outside = np.array([one.outside for one in found.chart])
    with drawn(7.5, 3.6) as figure:
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
        written = ConciseDateFormatter(locator)  # type: ignore[no-untyped-call]
        axes.xaxis.set_major_formatter(written)
        axes.set_ylabel(f"{found.name} ({found.unit})" if found.unit else found.name)
        axes.legend(ncols=4, loc="upper center", bbox_to_anchor=(0.5, -0.12))
        at = f", {found.frequency_hz:.4g} Hz" if found.frequency_hz else ""
        hull = f"{found.hull}, " if found.hull else ""
        figure.suptitle(f"{found.name}: {hull}{found.speed_m_s:.4g} m/s{at}")
    return figure


def _utc(time: str) -> datetime:
    """Return a time without its zone: an axis has one for all."""
    return datetime.fromisoformat(time).astimezone(UTC).replace(tzinfo=None)
