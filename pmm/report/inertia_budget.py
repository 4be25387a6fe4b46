"""Budget bars: which input's uncertainty each result's is made of."""

from textwrap import shorten
from typing import TYPE_CHECKING

from analysis.uncertainty.monte_carlo import Assessment
from pmm.document.labels import plain
from pmm.document.notation import rounded
from pmm.document.style import PALETTE, TRACE, new_figure
from pmm.inertia.outcome import Finding, Outcome

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


_MOST_BARS = 8  # inputs by name; the rest together
_LONGEST = 60  # characters of a result's words over its bars


def budget_figure(outcome: Outcome) -> "Figure":
    """Draw the shares of each result's variance, and its intervals by budget and Monte Carlo."""
    rows = outcome.budgeted
    sizes = [1.2 + 0.28 * len(_lines(assessment)) for _, assessment in rows]
    with new_figure(
        10.5, 1.0 + sum(sizes), f"{plain(outcome.name)}: where the uncertainty comes from"
    ) as figure:
        grid = figure.add_gridspec(len(rows), 2, width_ratios=(2.2, 1.0), height_ratios=sizes)
        for place, (finding, assessment) in enumerate(rows):
            bars, spans = (figure.add_subplot(grid[place, column]) for column in (0, 1))
            _draw_bars(bars, finding, assessment)
            _draw_intervals(spans, assessment)
            if place == len(rows) - 1:
                bars.set_xlabel("share of the variance (%)")
    return figure


def _lines(assessment: Assessment) -> list[tuple[str, float]]:
    lines = [line for line in assessment.budget.shares if line.input.uncertainty > 0.0]
    bars = [(plain(line.name), 100.0 * line.share) for line in lines[:_MOST_BARS]]
    rest = lines[_MOST_BARS:]
    if rest:
        bars.append((f"{len(rest)} more", 100.0 * sum(line.share for line in rest)))
    return bars


def _draw_bars(axes: "Axes", finding: Finding, assessment: Assessment) -> None:
    lines = _lines(assessment)[::-1]
    bars = axes.barh([name for name, _ in lines], [share for _, share in lines], color=PALETTE[0])
    axes.bar_label(bars, fmt="%.1f", padding=3, fontsize=8.0)
    least = min([0.0, *(share for _, share in lines)])
    axes.set_xlim(1.15 * least, 112.0)
    axes.grid(visible=False, axis="y")
    value = rounded(finding.estimate.value, finding.estimate.uncertainty)
    title = shorten(plain(finding.what), _LONGEST, placeholder=" …")
    axes.set_title(f"{title}: {value} {finding.estimate.unit}", loc="left")


def _draw_intervals(axes: "Axes", assessment: Assessment) -> None:
    """Draw both intervals of 95 % as differences from the value."""
    budget, trial = assessment.budget.result, assessment.monte_carlo
    centre, factor, unit = budget.value, 1.0, budget.unit
    if unit == "m":
        factor, unit = 1e3, "mm"
    for row, (low, high), color in (
        (1.0, budget.interval(), PALETTE[0]),
        (0.0, (trial.low, trial.high), PALETTE[1]),
    ):
        ends = [factor * (low - centre), factor * (high - centre)]
        axes.plot(ends, [row, row], "|-", color=color, ms=10.0, lw=2.0)
    axes.axvline(0.0, color=TRACE, lw=0.8)
    axes.set_yticks([1.0, 0.0], ["budget", "Monte Carlo"])
    axes.set_ylim(-0.6, 1.6)
    axes.locator_params(axis="x", nbins=5)
    axes.grid(visible=False, axis="y")
    axes.set_xlabel(f"95 % less the value ({unit})", fontsize=8.0)
    if not assessment.linear_good_enough:
        axes.set_title("budget not good enough", loc="left", color=PALETTE[1])
