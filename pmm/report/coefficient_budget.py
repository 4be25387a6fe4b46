"""How well each recommended value is known, and where its uncertainty comes from."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from analysis.coefficients.campaign_budget import CoefficientBudget, budget
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.recommendation import recommended
from pmm.document.labels import plain
from pmm.document.notation import rounded
from pmm.document.style import PALETTE, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST_BARS: Final = 32
_OTHER: Final = "others"
_MOST_SOURCES: Final = len(PALETTE) - 1
_INK: Final = "#B0B0B0"
_WHOLE: Final = 100.0  # %: an interval as large as the value; longer bars end here
_SPAN: Final = 100.0  # last over first of the axis, at least: three ticks with numbers


def budget_rows(coefficients: CampaignCoefficients, speed_m_s: float) -> list[int]:
    """Return the rows that are drawn: recommended ones with an uncertainty, of many a choice."""
    spread = coefficients.uncertain.standard_uncertainty
    rows = [
        k
        for k in recommended(coefficients)
        if spread[k] > 0.0 and coefficients.entries[k].speed_m_s == speed_m_s
    ]
    if len(rows) <= MOST_BARS:
        return rows
    return [rows[k] for k in np.linspace(0, len(rows) - 1, MOST_BARS).astype(int)]


def budget_figure(
    coefficients: CampaignCoefficients, rows: Sequence[int], speed_m_s: float
) -> "Figure":
    """Draw for each value its interval in per cent of it, and what each kind of input adds."""
    budgets = [budget(coefficients, k) for k in rows]
    with new_figure(
        10.5,
        1.5 + 0.27 * len(rows),
        plain(f"How well each value is known, {speed_m_s:g} m/s; {coefficients.normalisation}"),
    ) as figure:
        sizes, shares = figure.subplots(1, 2, sharey=True, width_ratios=(2, 3))
        _draw_sizes(sizes, budgets)
        _draw_shares(shares, budgets)
        sizes.set_yticks(range(len(rows)), [_label(coefficients, k) for k in rows])
        sizes.set_ylim(len(rows) - 0.4, -0.6)
        sizes.set_xlabel(f"interval of {100.0 * coefficients.level:g} % (% of the value)")
        shares.set_xlabel("share of the variance (%)")
        shares.set_xlim(0.0, 100.0)
        for axes in (sizes, shares):
            axes.grid(visible=False, axis="y")
            axes.tick_params(axis="y", length=0)
        figure.legend(loc="outside lower center", ncols=4)
    return figure


def _draw_sizes(axes: "Axes", budgets: Sequence[CoefficientBudget]) -> None:
    """Bars from a whole decade on; one as long as the value ends there and is hatched."""
    part = np.array([_relative(value_budget) for value_budget in budgets])
    low = 10.0 ** math.floor(math.log10(part.min()))
    for place, size in enumerate(part):
        hatch = "///" if size >= _WHOLE else None
        axes.barh(place, size - low, 0.72, left=low, color=_INK, hatch=hatch, edgecolor="white")
    axes.set_xscale("log")
    axes.set_xlim(low, max(float(part.max()) * 1.5, low * _SPAN))
    axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.xaxis.set_minor_formatter(lambda *_: "")


def _relative(value_budget: CoefficientBudget) -> float:
    """Return the half width in per cent of the value, at most all of it."""
    size = abs(value_budget.value)
    return _WHOLE if value_budget.half_width >= size else 100.0 * value_budget.half_width / size


def _draw_shares(axes: "Axes", budgets: Sequence[CoefficientBudget]) -> None:
    sources = _sources(budgets)
    left = np.zeros(len(budgets))
    for number, source in enumerate(sources):
        shares = np.array([_share(value_budget, source, sources) for value_budget in budgets])
        color = _INK if source == _OTHER else PALETTE[number]
        axes.barh(range(len(budgets)), shares, 0.72, left=left, color=color, label=source)
        left += shares


def _sources(budgets: Sequence[CoefficientBudget]) -> list[str]:
    """Return the kinds of input, largest over all values first; small ones are put together."""
    total: dict[str, float] = {}
    for value_budget in budgets:
        for line in value_budget.lines:
            total[line.source] = total.get(line.source, 0.0) + line.share
    order = sorted(total, key=lambda source: -total[source])
    return order if len(order) <= _MOST_SOURCES else [*order[:_MOST_SOURCES], _OTHER]


def _share(value_budget: CoefficientBudget, source: str, sources: Sequence[str]) -> float:
    if source == _OTHER:
        return 100.0 * sum(line.share for line in value_budget.lines if line.source not in sources)
    return 100.0 * sum(line.share for line in value_budget.lines if line.source == source)


def _label(coefficients: CampaignCoefficients, row: int) -> str:
    entry = coefficients.entries[row]
    at = f", {entry.frequency_hz:.3g} Hz" if entry.frequency_hz > 0.0 else ""
    unit = "" if entry.unit == "1" else f" {entry.unit}"
    value = rounded(float(coefficients.values[row]), float(coefficients.half_widths[row]))
    return f"{entry.name}{at}: {value}{unit}"
