"""Where the uncertainty of each coefficient comes from, as bars that add up to all of it."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from analysis.coefficients.campaign_budget import CoefficientBudget, budget
from analysis.coefficients.campaign_result import CampaignCoefficients
from pmm.report.labels import plain
from pmm.report.rounding import rounded
from pmm.report.style import PALETTE, drawing

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST_BARS: Final = 32
_OTHER: Final = "others"
_MOST_SOURCES: Final = len(PALETTE) - 1
_INK: Final = "#B0B0B0"


def budget_rows(found: CampaignCoefficients, speed_m_s: float) -> list[int]:
    """Return the rows that are drawn: those with an uncertainty, of many an even choice."""
    spread = found.uncertain.standard_uncertainty
    rows = [k for k in found.rows(speed_m_s=speed_m_s) if spread[k] > 0.0]
    if len(rows) <= MOST_BARS:
        return rows
    return [rows[k] for k in np.linspace(0, len(rows) - 1, MOST_BARS).astype(int)]


def budget_figure(found: CampaignCoefficients, rows: Sequence[int], speed_m_s: float) -> "Figure":
    """Draw a bar for each value, made of what each kind of input adds to its variance."""
    from matplotlib.figure import Figure

    budgets = [budget(found, k) for k in rows]
    sources = _sources(budgets)
    with drawing():
        figure = Figure(figsize=(10.5, 1.5 + 0.27 * len(rows)), layout="constrained")
        figure.suptitle(
            plain(f"Where the uncertainty comes from, {speed_m_s:g} m/s; {found.normalisation}")
        )
        axes = figure.subplots()
        _draw(axes, budgets, sources)
        axes.set_yticks(range(len(rows)), [_label(found, k) for k in rows])
        axes.set_ylim(len(rows) - 0.4, -0.6)
        axes.set_xlim(0.0, 100.0)
        axes.set_xlabel("share of the variance (%)")
        axes.grid(visible=False, axis="y")
        figure.legend(loc="outside lower center", ncols=4)
    return figure


def _draw(axes: "Axes", budgets: Sequence[CoefficientBudget], sources: Sequence[str]) -> None:
    left = np.zeros(len(budgets))
    for number, source in enumerate(sources):
        shares = np.array([_share(one, source, sources) for one in budgets])
        color = _INK if source == _OTHER else PALETTE[number]
        axes.barh(range(len(budgets)), shares, 0.72, left=left, color=color, label=source)
        left += shares


def _sources(budgets: Sequence[CoefficientBudget]) -> list[str]:
    """Return the kinds of input, largest over all values first; small ones are put together."""
    total: dict[str, float] = {}
    for one in budgets:
        for line in one.lines:
            total[line.source] = total.get(line.source, 0.0) + line.share
    order = sorted(total, key=lambda source: -total[source])
    return order if len(order) <= _MOST_SOURCES else [*order[:_MOST_SOURCES], _OTHER]


def _share(one: CoefficientBudget, source: str, sources: Sequence[str]) -> float:
    if source == _OTHER:
        return 100.0 * sum(line.share for line in one.lines if line.source not in sources)
    return 100.0 * sum(line.share for line in one.lines if line.source == source)


def _label(found: CampaignCoefficients, row: int) -> str:
    entry = found.entries[row]
    at = "" if math.isnan(entry.frequency_hz) else f", {entry.frequency_hz:.3g} Hz"
    way = f", {1e3 * entry.translation_amplitude_m:.3g} mm" if entry.translation_amplitude_m else ""
    value = rounded(float(found.values[row]), float(found.half_widths[row]))
    return f"{entry.name}{at}{way}: {value}"
