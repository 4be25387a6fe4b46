"""The figures of an inertia job.

For each source of records: the fit over them with what is left, period against amplitude with the
extrapolation, and spectrum with beats. For a swing's levers: tilts and their fit. For each job:
budget bars, and the inertia ellipse or the error over the lines' length where there is one.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from pmm.document import content
from pmm.document.labels import plain, shown_name
from pmm.document.style import FIT, PALETTE, TRACE, new_figure
from pmm.inertia.outcome import Outcome, StaticTest
from pmm.inertia.sources import PeriodRuns
from pmm.report.inertia_amplitude import amplitude_figure
from pmm.report.inertia_budget import budget_figure
from pmm.report.inertia_ellipse import ellipse_figure
from pmm.report.inertia_record import MOST_RUNS, record_figure
from pmm.report.inertia_setup import photo_figure, setup_figure
from pmm.report.inertia_spectrum import spectrum_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_RECORDS: "Final[dict[str, tuple[str, Callable[[PeriodRuns], Figure]]]]" = {
    "record": ("The fit over the records, with what is left.", record_figure),
    "amplitude": ("Period against amplitude, with the extrapolation.", amplitude_figure),
    "spectrum": ("Spectrum, with beats.", spectrum_figure),
}


def figures(outcome: Outcome) -> Iterator[content.Figure]:
    """Yield what there is to draw."""
    if outcome.sketches:
        draw_setup = partial(setup_figure, outcome.name, outcome.sketches)
        yield content.Figure("setup", "The set-up, to scale.", draw_setup)
    if outcome.photo is not None:
        yield content.Figure("photo", "The set-up.", partial(photo_figure, outcome.photo))
    yield from _records(outcome)
    for test in outcome.statics:
        caption = f"{test.where}. Tilts under weights, and their fit."
        yield content.Figure(_file_name(test.where), caption, partial(static_figure, test))
    if any(finding.assessment is not None for finding in outcome.findings):
        caption = "Where the uncertainty of each result comes from."
        yield content.Figure("budget", caption, partial(budget_figure, outcome))
    axes, lines = outcome.axes, outcome.line_errors
    if axes is not None:
        draw = partial(ellipse_figure, outcome.name, axes)
        yield content.Figure("ellipse", "The inertia ellipse in the centre plane.", draw)
    if lines is not None:
        caption = "The gyradius' error over the lines' length."
        yield content.Figure("line", caption, partial(line_figure, outcome, lines))


def _records(outcome: Outcome) -> Iterator[content.Figure]:
    names: set[str] = set()
    for number, runs in enumerate(outcome.periods, 1):
        name = _file_name(runs.where)
        name = f"{name}-{number}" if name in names else name
        names.add(name)
        if runs.records:
            for kind, (caption, draw) in _RECORDS.items():
                yield content.Figure(
                    f"{name}-{kind}", f"{runs.where}. {caption}", partial(draw, runs)
                )
        if runs.gates:
            caption = f"{runs.where}. The gate's passages."
            yield content.Figure(f"{name}-gates", caption, partial(gates_figure, runs))


def _file_name(where: str) -> str:
    """Return a place in a file as part of a file's name."""
    text = "".join(c if c.isalnum() else " " for c in where.removeprefix("suspensions"))
    return "-".join(text.split())


def gates_figure(runs: PeriodRuns) -> "Figure":
    """Draw the time of each whole swing, and below the residual of the passages' times."""
    with new_figure(10.5, 6.0, f"{plain(runs.where)}: light gates") as figure:
        axes = figure.add_subplot(2, 1, 1)
        rest = figure.add_subplot(2, 1, 2, sharex=axes)
        for number, (gate, fit) in enumerate(runs.gates[:MOST_RUNS]):
            color = PALETTE[number % len(PALETTE)]
            whole_swings = gate.number[2:] - gate.number[:-2] == 2
            swing = (gate.time_s[2:] - gate.time_s[:-2])[whole_swings]
            name = shown_name(gate.name)
            axes.plot(gate.time_s[1:-1][whole_swings], swing, ".", ms=3.0, color=color, label=name)
            axes.axhline(fit.period.value, color=FIT, lw=0.9)
            rest.plot(gate.time_s, 1e3 * fit.residual_s, ".", ms=3.0, color=color)
        axes.set_title("whole swings; the line is the period at no amplitude", loc="left")
        axes.set_ylabel("period (s)")
        axes.ticklabel_format(axis="y", useOffset=False)
        rest.set_ylabel("residual of the\npassages (ms)")
        rest.set_xlabel("time (s)")
        figure.legend(loc="outside lower left", ncols=4, markerscale=3.0)
    return figure


_WORDS = {"fixed": "depth known (fig 17)", "joint": "depth measured along"}


def line_figure(outcome: Outcome, errors: Mapping[str, Sequence[tuple[float, float]]]) -> "Figure":
    """Draw the error of the gyradius per error of the periods; the best line is where it is least.

    Parameters
    ----------
    errors
        By reading: line length in m, and metres per second.
    """
    values = {finding.name: finding.estimate.value for finding in outcome.findings}
    with new_figure(10.5, 4.6, f"{plain(outcome.name)}: lines for the pitch gyradius") as figure:
        axes = figure.add_subplot()
        for number, (reading, rows) in enumerate(errors.items()):
            line, error = np.array(rows).T
            best = values[f"bifilar_best_line_{reading}_m"]
            color = PALETTE[number]
            label = f"{_WORDS[reading]}: best {best:.2f} m"
            axes.loglog(line, 1e3 * error, color=color, label=label)
            axes.plot(best, 1e3 * float(np.interp(best, line, error)), "o", color=color)
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter(lambda value, _: f"{value:g}")
            axis.set_minor_formatter(lambda _value, _place: "")
        axes.set_xlabel("line length (m)")
        axes.set_ylabel("error of the gyradius per\nerror of both periods (mm/s)")
        axes.grid(visible=True, which="minor", lw=0.3)
        axes.legend(loc="upper right")
    return figure


def static_figure(test: StaticTest) -> "Figure":
    """Draw the tilts' tangents over weight times lever, with the fit, and the residuals below.

    Residuals tell levers apart that the upper panel shows on one line.
    """
    pooled = test.result.pooled
    slope, offset = 1.0 / pooled.moment.value, pooled.offset_rad.value
    with new_figure(10.5, 6.0, f"{plain(test.where)}: tilts under weights") as figure:
        grid = figure.add_gridspec(2, 1, height_ratios=(2.0, 1.0))
        axes = figure.add_subplot(grid[0])
        rest = figure.add_subplot(grid[1], sharex=axes)
        for number, series in enumerate(test.series):
            pull, tangent = series.pull_kg_m(offset), np.tan(series.tilt_rad)
            color, marker = PALETTE[number % len(PALETTE)], "osDv^P*"[number % 7]
            label = f"{shown_name(series.name)}, lever {series.lever_m:g} m"
            axes.plot(pull, tangent, marker, ms=5.0, color=color, label=label)
            residual = 1e3 * (tangent - offset - slope * pull)
            rest.plot(pull, residual, marker, ms=5.0, color=color)
        furthest = max(float(series.pull_kg_m(offset).max()) for series in test.series)
        axes.plot([0.0, furthest], [offset, offset + slope * furthest], color=TRACE, label="fit")
        axes.set_title(
            f"first moment {pooled.moment.value:.5g} kg m, u of the fit "
            f"{pooled.moment.uncertainty:.2g}; offset {1e3 * offset:.3g} mrad",
            loc="left",
        )
        axes.set_ylabel("tangent of the tilt")
        axes.tick_params(labelbottom=False)
        rest.axhline(0.0, color=TRACE, lw=0.9)
        rest.set_ylabel("residual\n(mrad)")
        rest.set_xlabel("weight times lever (kg m)")
        figure.legend(loc="outside lower left", ncols=4)
    return figure
