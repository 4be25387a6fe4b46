"""Period against amplitude, the laws through it, and the period at no amplitude."""

from typing import TYPE_CHECKING

import numpy as np

from analysis.inertia.record import ModeAnalysis, RecordAnalysis
from pmm.document.labels import display, plain, shown_name
from pmm.document.style import PALETTE, TRACE, new_figure
from pmm.inertia.sources import PeriodRuns
from pmm.report.inertia_record import MOST_RUNS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LAWS = {0: "constant", 1: "linear", 2: "quadratic"}
_DASHES = {0: ":", 1: "--", 2: "-"}
_SEEN = 0.02  # weight of a law that is drawn


def amplitude_figure(runs: PeriodRuns) -> "Figure":
    """Draw the period of each part of each record over its amplitude, a panel per oscillation.

    Bars are one standard uncertainty. The laws are drawn down to no amplitude, those of little
    weight left out; the point there is their mean with the uncertainty of fits and choice.
    """
    count = len(runs.records[0].modes)
    with new_figure(
        10.5, 1.2 + 3.4 * count, f"{plain(runs.where)}: period against amplitude"
    ) as figure:
        for mode in range(count):
            axes = figure.add_subplot(count, 1, mode + 1)
            for number, run in enumerate(runs.records[:MOST_RUNS]):
                _draw_run(axes, run, run.modes[mode], PALETTE[number % len(PALETTE)])
            unit = display(runs.records[0].part.series.unit)
            axes.set_xlabel(f"amplitude ({unit.label})")
            axes.set_ylabel("period (s)")
            axes.ticklabel_format(axis="y", useOffset=False)
            axes.set_xlim(left=-0.03 * axes.get_xlim()[1])
            axes.set_title(_title(runs, mode), loc="left")
            _add_legend(axes, runs, mode)
    return figure


def _title(runs: PeriodRuns, mode: int) -> str:
    period = runs.periods[mode]
    return f"used, undamped: {period.value:.6g} s, u = {period.uncertainty:.2g} s"


def _draw_run(axes: "Axes", run: RecordAnalysis, mode: ModeAnalysis, color: str) -> None:
    factor = display(run.part.series.unit).factor
    local, zero = mode.local, mode.at_no_amplitude
    axes.errorbar(
        factor * local.amplitude,
        local.period_s,
        local.uncertainty_s,
        fmt="o",
        ms=3.5,
        lw=0.9,
        color=color,
        label=shown_name(run.part.series.name),
    )
    along = np.linspace(0.0, float(local.amplitude.max()), 80)
    for law in zero.laws:
        if law.weight >= _SEEN:
            axes.plot(factor * along, law.at(along), _DASHES[law.power], color=color, lw=0.9)
    axes.errorbar(
        [0.0],
        [zero.period.value],
        [zero.period.uncertainty],
        fmt="D",
        ms=5.0,
        mfc="white",
        capsize=4.0,
        color=color,
    )


def _add_legend(axes: "Axes", runs: PeriodRuns, mode: int) -> None:
    """Name the runs by colour, the laws by dashes with their mean weights."""
    from matplotlib.lines import Line2D

    handles, _ = axes.get_legend_handles_labels()
    run_laws = [run.modes[mode].at_no_amplitude.laws for run in runs.records]
    for k, law in enumerate(run_laws[0]):
        weight = float(np.mean([laws[k].weight for laws in run_laws]))
        label = f"{_LAWS[law.power]}, weight {weight:.2f}"
        handles.append(Line2D([], [], ls=_DASHES[law.power], color=TRACE, label=label))
    handles.append(
        Line2D([], [], ls="", marker="D", mfc="white", color=TRACE, label="mean of the laws, ±u")
    )
    axes.legend(handles=handles, loc="center left", bbox_to_anchor=(1.01, 0.5))
