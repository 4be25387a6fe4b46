"""What ``pmm inertia`` does: run a job, then print, plot and write the model's section."""

from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

import click

from pmm.cli.screen import busy, messages, output
from pmm.document.data import as_json
from pmm.document.style import write_figures
from pmm.document.terminal import print_document
from pmm.inertia.fits import form_fits
from pmm.inertia.model_file import check_output, model_section
from pmm.report.inertia_document import document
from pmm.whole_file import write_whole

if TYPE_CHECKING:
    from collections.abc import Callable

    from pmm.inertia.outcome import Outcome

# Job -> module and function.
_RUNS = {
    "swing": ("swing", "run"),
    "bifilar": ("bifilar", "run"),
    "pendulum": ("pendulum", "run"),
    "incline": ("incline", "run"),
    "combine": ("parts", "run_combine"),
    "ballast": ("parts", "run_ballast"),
    "plan": ("plan", "run"),
}


@dataclass(frozen=True)
class InertiaOptions:
    """A job and the options of its command, by their names there."""

    job: str
    file: str
    as_json: bool
    output: str | None
    overwrite: bool
    plot: str | None
    fits: bool = False


def run(request: InertiaOptions) -> None:
    """Do a job; what it found is printed even where it then may not be written.

    Raises
    ------
    ConfigurationError, DataError
        If the file is wrong, the data do not carry what is asked, or the section cannot be
        written.
    """
    target = None if request.output is None else Path(request.output)
    if target is not None:
        check_output(target, overwrite=request.overwrite)
    module, function = _RUNS[request.job]
    job: Callable[[str], Outcome] = getattr(import_module(f"pmm.inertia.{module}"), function)
    with busy(f"{request.job}: {request.file}"):
        outcome = job(request.file)
        fits = form_fits(outcome) if request.fits else None
    told = document(outcome, fits)
    if request.as_json:
        click.echo(as_json(told))
    else:
        print_document(output(), told)
    if request.plot is not None:
        written = write_figures(told.figures, Path(request.plot), Path(request.file).stem)
        messages().print(f"written: {len(written)} figures in {request.plot}")
    if target is not None:
        write_whole(target, model_section(outcome))
        messages().print(f"written: {target}")
    if outcome.said_no:
        click.get_current_context().exit(1)
