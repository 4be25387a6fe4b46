"""``pmm inertia``: from the record of any pendulum to a model's mass properties."""

from collections.abc import Callable
from pathlib import Path
from typing import Final

import click

from pmm.cli.group import CommandGroup
from pmm.cli.options import JSON, PLOT, with_options


@click.group(cls=CommandGroup, kind="job")
def inertia() -> None:
    """Find mass, centre of gravity, inertia and gyradii, with a budget.

    Each job reads a small TOML file that names the records and the geometry with their
    uncertainties (docs/inertia-files.md). Exit status: 0 done, 1 the data say no (a target missed,
    a known weight not met, a record that carries no period), 2 the file is wrong.

    \b
    pmm inertia bifilar examples/inertia/hull.toml --output model.toml --plot plots
    """  # noqa: D301


_EVERY: Final = with_options(
    click.argument("file", metavar="FILE"),
    JSON,
    click.option("--output", metavar="TOML", help="Write the section [model] there."),
    click.option("--overwrite", is_flag=True, help="Replace that file if it is there."),
    PLOT,
    click.option("--page", metavar="FILE.html", help="Write a page with figures."),
)
_FITS: Final = click.option(
    "--fits",
    "with_fits",
    is_flag=True,
    help="Fit each record by the forms F1 to F4 too, and show their periods.",
)
_PROPERTIES: Final = click.option(
    "--properties",
    metavar="FILE",
    help="Write mass, centre and whole tensor there for other programs: FILE.urdf or FILE.csv.",
)
# Job -> options of its own, and what it is for.
_JOBS: Final = {
    "swing": ((_FITS,), "Swing: alone, with the model, and its checks."),
    "bifilar": ((_FITS,), "Bifilar suspension: yaw, pitch or roll, depth, principal axes."),
    "pendulum": ((_FITS,), "Compound pendulum: about one axis, or two (Lamboley)."),
    "incline": ((), "Inclining test: depth of the centre of gravity."),
    "combine": ((_PROPERTIES,), "Put parts together and take others off."),
    "ballast": ((_PROPERTIES,), "Find where given weights go."),
    "plan": ((), "Forecast a test: uncertainty, best line length, resonance."),
}


def _command(job: str) -> Callable[..., None]:
    """Return what does a job; what it found is printed even where it then may not be written."""

    def command(
        file: str,
        as_json: bool,
        output: str | None,
        overwrite: bool,
        plot: str | None,
        page: str | None,
        with_fits: bool = False,
        properties: str | None = None,
    ) -> None:
        from pmm.cli.files import check_files, write_asked_figures, write_asked_page
        from pmm.cli.screen import busy, messages, show
        from pmm.inertia.fits import form_fits
        from pmm.inertia.jobs import do_job
        from pmm.inertia.model_file import (
            check_ending,
            mass_properties,
            model_section,
        )
        from pmm.report.inertia_document import document
        from pmm.whole_file import write_whole

        files = {"--output": output, "--properties": properties}
        check_files({"--page": page, **files}, [("FILE", Path(file))])
        check_files(files, overwrite=overwrite)
        if properties is not None:
            check_ending(Path(properties))
        with busy(f"{job}: {file}"):
            outcome = do_job(job, file)
            fits = form_fits(outcome) if with_fits else None
        content = document(outcome, fits)
        show(content, as_json=as_json)
        options = ("--fits",) if with_fits else ()
        write_asked_figures(content.figures, plot, Path(file).stem)
        write_asked_page(content, page, ("inertia", job, file, *options), [Path(file)])
        if output is not None:
            write_whole(Path(output), model_section(outcome))
            messages().print(f"written: {output}")
        if properties is not None:
            write_whole(Path(properties), mass_properties(outcome, Path(properties)))
            messages().print(f"written: {properties}")
        if outcome.said_no:
            click.get_current_context().exit(1)

    return command


for _job, (_own, _help) in _JOBS.items():
    inertia.command(_job, help=_help)(with_options(_EVERY, *_own)(_command(_job)))
