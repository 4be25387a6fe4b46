"""The figure of a control chart: repeats, centre, limits, and the step if there is one."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from pmm.evaluation.control_chart import Chart

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def chart_figure(charts: Sequence[Chart]) -> "Figure":
    """Return one panel a quantity over the numbers of the repeats."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import MaxNLocator

    figure = Figure(figsize=(7.0, 1.8 * len(charts) + 0.6), layout="constrained")
    panels = figure.subplots(len(charts), 1, sharex=True, squeeze=False)[:, 0]
    for panel, one in zip(panels, charts, strict=True):
        numbers = range(1, one.values.size + 1)
        panel.axhline(one.centre, color="0.5", lw=0.8)
        for limit in (one.low, one.high):
            panel.axhline(limit, color="tab:red", lw=0.8, ls="--")
        panel.plot(numbers, one.values, "o-", color="tab:blue", ms=4, lw=0.8)
        outside = list(one.outside)
        panel.plot([i + 1 for i in outside], one.values[outside], "o", color="tab:red", ms=6)
        if one.step_at is not None:
            panel.axvline(one.step_at[0] + 0.5, color="tab:orange", lw=1.2)
        panel.set_ylabel(f"{one.quantity}\n[{one.unit}]")
        panel.xaxis.set_major_locator(MaxNLocator(integer=True))
    panels[-1].set_xlabel("repeat of the control condition")
    return figure
