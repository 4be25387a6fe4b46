"""Light gates: the period passage by passage, and what the fit leaves of the times."""

from typing import TYPE_CHECKING

from pmm.document.labels import plain, shown_name
from pmm.document.style import FIT, PALETTE, drawing
from pmm.inertia.sources import PeriodRuns
from pmm.report.inertia_record import MOST_RUNS

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def gates_figure(runs: PeriodRuns) -> "Figure":
    """Draw the time of each whole swing, and below the residual of the passages' times."""
    from matplotlib.figure import Figure

    with drawing():
        figure = Figure(figsize=(10.5, 6.0), layout="constrained")
        figure.suptitle(f"{plain(runs.where)}: light gates")
        axes = figure.add_subplot(2, 1, 1)
        rest = figure.add_subplot(2, 1, 2, sharex=axes)
        for number, (seen, fit) in enumerate(runs.gates[:MOST_RUNS]):
            color = PALETTE[number % len(PALETTE)]
            whole = seen.number[2:] - seen.number[:-2] == 2
            swing = (seen.time_s[2:] - seen.time_s[:-2])[whole]
            name = shown_name(seen.name)
            axes.plot(seen.time_s[1:-1][whole], swing, ".", ms=3.0, color=color, label=name)
            axes.axhline(fit.period.value, color=FIT, lw=0.9)
            rest.plot(seen.time_s, 1e3 * fit.residual_s, ".", ms=3.0, color=color)
        axes.set_title("whole swings; the line is the period at no amplitude", loc="left")
        axes.set_ylabel("period (s)")
        axes.ticklabel_format(axis="y", useOffset=False)
        rest.set_ylabel("residual of the\npassages (ms)")
        rest.set_xlabel("time (s)")
        figure.legend(loc="outside lower left", ncols=4, markerscale=3.0)
    return figure
