"""The figures of an inertia job.

For each source of records: the fit over them with what is left, period against amplitude with the
extrapolation, and spectrum with beats. For a swing's levers: tilts and their fit. For each job:
budget bars, and the inertia ellipse or the error over the lines' length where there is one.
"""

from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING, Final

from pmm.document.content import Figure
from pmm.inertia.outcome import Outcome
from pmm.report.inertia_amplitude import amplitude_figure
from pmm.report.inertia_budget import budget_figure
from pmm.report.inertia_ellipse import ellipse_figure
from pmm.report.inertia_gates import gates_figure
from pmm.report.inertia_line import line_figure
from pmm.report.inertia_record import record_figure
from pmm.report.inertia_spectrum import spectrum_figure
from pmm.report.inertia_static import static_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

    from pmm.inertia.sources import PeriodRuns

_RECORDS: "Final[dict[str, tuple[str, Callable[[PeriodRuns], Drawing]]]]" = {
    "record": ("The fit over the records, with what is left.", record_figure),
    "amplitude": ("Period against amplitude, with the extrapolation.", amplitude_figure),
    "spectrum": ("Spectrum, with beats.", spectrum_figure),
}


def figures(outcome: Outcome) -> Iterator[Figure]:
    """Yield what there is to draw."""
    yield from _records(outcome)
    for test in outcome.statics:
        caption = f"{test.where}. Tilts under weights, and their fit."
        yield Figure(_file_name(test.where), caption, partial(static_figure, test))
    if any(one.assessment is not None for one in outcome.findings):
        caption = "Where the uncertainty of each result comes from."
        yield Figure("budget", caption, partial(budget_figure, outcome))
    axes, lines = outcome.axes, outcome.line_errors
    if axes is not None:
        draw = partial(ellipse_figure, outcome.name, axes)
        yield Figure("ellipse", "The inertia ellipse in the centre plane.", draw)
    if lines is not None:
        caption = "The gyradius' error over the lines' length."
        yield Figure("line", caption, partial(line_figure, outcome, lines))


def _records(outcome: Outcome) -> Iterator[Figure]:
    taken: set[str] = set()
    for at, runs in enumerate(outcome.periods, 1):
        own = _file_name(runs.where)
        own = f"{own}-{at}" if own in taken else own
        taken.add(own)
        if runs.records:
            for kind, (caption, draw) in _RECORDS.items():
                yield Figure(f"{own}-{kind}", f"{runs.where}. {caption}", partial(draw, runs))
        if runs.gates:
            caption = f"{runs.where}. The gate's passages."
            yield Figure(f"{own}-gates", caption, partial(gates_figure, runs))


def _file_name(where: str) -> str:
    """Return a place in a file as part of a file's name."""
    kept = "".join(c if c.isalnum() else " " for c in where.removeprefix("suspensions"))
    return "-".join(kept.split())
