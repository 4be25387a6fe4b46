"""The figures of an inertia job, and writing them to files.

For each source of records: the fit over them with what is left, period against amplitude with the
extrapolation, and spectrum with beats. For a swing's levers: tilts and their fit. For each job:
budget bars, and the inertia ellipse or the error over the lines' length where there is one.
"""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from pmm.inertia.outcome import Outcome
from pmm.report.inertia_amplitude import amplitude_figure
from pmm.report.inertia_budget import budget_figure
from pmm.report.inertia_ellipse import ellipse_figure
from pmm.report.inertia_gates import gates_figure
from pmm.report.inertia_line import line_figure
from pmm.report.inertia_record import record_figure
from pmm.report.inertia_spectrum import spectrum_figure
from pmm.report.inertia_static import static_figure
from pmm.report.style import write_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def save_figures(
    outcome: Outcome, folder: Path, stem: str, formats: Sequence[str] = ("svg", "png")
) -> list[Path]:
    """Write the figures of an outcome.

    Parameters
    ----------
    folder
        Made if it is not there.
    stem
        Files are named ``<stem>-budget.svg``, ``<stem>-<source>-record.svg`` ...
    formats
        Any of ``svg``, ``png`` and ``pdf``.

    Returns
    -------
    list of Path
        The files written.

    Raises
    ------
    ConfigurationError
        If a format is not known.
    """
    written = []
    for kind, draw in _figures(outcome):
        written += write_figure(draw(), folder, f"{stem}-{kind}", formats)
    return written


def _figures(outcome: Outcome) -> Iterator[tuple[str, Callable[[], "Figure"]]]:
    """Yield what there is to draw."""
    taken: set[str] = set()
    for number, runs in enumerate(outcome.periods, 1):
        own = _file_name(runs.where)
        own = f"{own}-{number}" if own in taken else own
        taken.add(own)
        if runs.records:
            yield f"{own}-record", lambda runs=runs: record_figure(runs)  # type: ignore[misc]
            yield f"{own}-amplitude", lambda runs=runs: amplitude_figure(runs)  # type: ignore[misc]
            yield f"{own}-spectrum", lambda runs=runs: spectrum_figure(runs)  # type: ignore[misc]
        if runs.gates:
            yield f"{own}-gates", lambda runs=runs: gates_figure(runs)  # type: ignore[misc]
    for test in outcome.statics:
        yield _file_name(test.where), lambda test=test: static_figure(test)  # type: ignore[misc]
    if any(one.assessment is not None for one in outcome.findings):
        yield "budget", lambda: budget_figure(outcome)
    axes, lines = outcome.axes, outcome.line_errors
    if axes is not None:
        yield "ellipse", lambda: ellipse_figure(outcome.name, axes)
    if lines is not None:
        yield "line", lambda: line_figure(outcome, lines)


def _file_name(where: str) -> str:
    """Return a place in a file as part of a file's name."""
    kept = "".join(c if c.isalnum() else " " for c in where.removeprefix("suspensions"))
    return "-".join(kept.split())
