"""``pmm archive``: any number of campaign folders in one file, found and compared."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from pmm.cli.group import CommandGroup
from pmm.cli.options import JSON, PLOT, SCHEDULER, jobs_option, probability

if TYPE_CHECKING:
    from pmm.archive.indexing import AddedFolder

_LIMITS = 0.99  # probability of a control chart's limits
FILE = click.option(
    "--archive", "file", metavar="FILE", default="archive.sqlite", show_default=True,
    help="The archive's file.",
)  # fmt: skip
CAMPAIGN = click.option(
    "--campaign", metavar="NAME", help="Of which campaign, by name or folder, if several have it."
)


@click.group(cls=CommandGroup, kind="job")
def archive() -> None:
    """Keep many campaigns in one file: list, find, show, note, trend, export.

    The file is made of the folders alone and can be made again from them. Exit status: 0 done,
    1 something could not be found or analysed, 2 the request was wrong.

    \b
    pmm archive add campaigns/* --analyse
    pmm archive find "hull = 'KVLCC2' and frequency_hz > 0.5"
    pmm archive trend Z_w --plot plots
    """  # noqa: D301


@archive.command()
@click.argument("folders", nargs=-1, required=True, metavar="FOLDER...")
@click.option("--analyse", "analysed", is_flag=True, help="Find harmonics and coefficients.")
@click.option("--gap", is_flag=True, help="Diagnose the gap to the simulation; takes long.")
@jobs_option("1")
@SCHEDULER
@FILE
@JSON
def add(folders: tuple[str, ...], analysed: bool, gap: bool, jobs: int | None,
        scheduler: str | None, file: str, as_json: bool) -> None:  # fmt: skip
    """Take campaign folders in, or URLs of such (s3://...), or again those that changed.

    Nothing is computed twice of the same recordings, campaign file and settings: who was
    interrupted gives the same command again. Without --analyse a campaign is listed as not
    analysed.

    \b
    pmm archive add 2025-03-kvlcc2 2025-09-kvlcc2 --analyse
    """  # noqa: D301
    from hardware.description.errors import PmmError
    from hardware.wall_clock import utc_now
    from pmm.archive.database import open_archive
    from pmm.archive.indexing import add_folders
    from pmm.archive.results import Analyses
    from pmm.cli.archive_analyses import analysed_folder, diagnosed_folder
    from pmm.cli.files import check_file
    from pmm.cli.screen import error_line, show, show_progress
    from pmm.parallel import open_executor
    from pmm.report.archive_document import added_document

    check_file(Path(file), "--archive")
    Path(file).parent.mkdir(parents=True, exist_ok=True)
    analyses = Analyses(analysed_folder if analysed else None, diagnosed_folder if gap else None)
    added_folders: list[AddedFolder] = []
    statuses = []
    with (
        open_archive(Path(file), create=True) as connection,
        open_executor(1 if scheduler is None and jobs is None else jobs, scheduler) as executor,
    ):
        outcomes = add_folders(connection, map(Path, folders), analyses, utc_now(), executor)
        for outcome in show_progress(outcomes, "folders", len(folders)):
            if isinstance(outcome, PmmError):
                error_line(str(outcome))
                statuses.append(outcome.exit_status)
            else:
                added_folders.append(outcome)
    show(added_document(tuple(added_folders), file), as_json=as_json)
    statuses += [1 for folder in added_folders if folder.refused]
    if statuses:
        click.get_current_context().exit(min(statuses))


@archive.command("list")
@FILE
@JSON
def list_campaigns(file: str, as_json: bool) -> None:
    """List campaigns; say which changed or vanished since they were added."""
    from pmm.archive.database import open_archive
    from pmm.archive.queries import campaigns
    from pmm.cli.screen import show
    from pmm.report.archive_document import list_document

    with open_archive(Path(file)) as connection:
        show(list_document(campaigns(connection), file), as_json=as_json)


@archive.command()
@click.argument("expression", metavar="EXPR")
@click.option("--channel", metavar="NAME", help="Show a harmonic of this channel with each run.")
@click.option("--order", type=click.IntRange(min=0), show_default="1",
              help="Of that harmonic; 0 is the mean.")  # fmt: skip
@click.option("--coefficients", is_flag=True, help="Find coefficients instead of runs.")
@FILE
@JSON
def find(expression: str, channel: str | None, order: int | None, coefficients: bool, file: str,
         as_json: bool) -> None:  # fmt: skip
    """Find the runs, or the coefficients, that fulfil a condition.

    Columns, = != < <= > >=, and, or, not, brackets, numbers, quoted texts. With --channel in_phase,
    quadrature, amplitude, gate and unit are columns too; with --coefficients coefficient, value,
    standard_uncertainty and half_width.

    \b
    pmm archive find "hull = 'KVLCC2' and frequency_hz > 0.5"
    pmm archive find "kind = 'oscillation' and amplitude > 10" --channel force_aft
    pmm archive find "coefficient = 'Z_w' and speed_m_s > 1" --coefficients
    pmm archive find "answer = 'coulomb-friction' and probability > 0.9"
    """  # noqa: D301
    from hardware.description.errors import ConfigurationError
    from pmm.archive.database import open_archive
    from pmm.archive.queries import find_coefficients, find_runs
    from pmm.cli.screen import show
    from pmm.report.archive_document import coefficients_found_document, find_document

    if coefficients and channel is not None:
        raise ConfigurationError(
            "--channel and --coefficients: runs have channels, campaigns have coefficients; "
            "ask for one of both"
        )
    if order is not None and channel is None:
        raise ConfigurationError("--order: of which channel? Say it with --channel NAME")
    order = 1 if order is None else order
    with open_archive(Path(file)) as connection:
        if coefficients:
            coefficient_rows = find_coefficients(connection, expression)
            show(coefficients_found_document(coefficient_rows, expression, file), as_json=as_json)
            return
        rows = find_runs(connection, expression, channel, order)
    show(find_document(rows, expression, channel, order, file), as_json=as_json)


@archive.command("show")
@click.argument("run", metavar="RUN")
@CAMPAIGN
@FILE
@JSON
def show_one(run: str, campaign: str | None, file: str, as_json: bool) -> None:
    """Show a run: set-point, recording with its hash, harmonics, notes."""
    from pmm.archive.database import open_archive
    from pmm.archive.queries import show_run
    from pmm.cli.screen import show
    from pmm.report.archive_document import show_document

    with open_archive(Path(file)) as connection:
        show(show_document(show_run(connection, run, campaign)), as_json=as_json)


@archive.command()
@click.argument("run", metavar="RUN")
@click.argument("text", metavar="TEXT")
@CAMPAIGN
@click.option("--author", metavar="NAME", help="Who writes.  [default: the user's name]")
@FILE
def note(run: str, text: str, campaign: str | None, author: str | None, file: str) -> None:
    """Write a line about a run, with time and name, to notes.jsonl in its campaign's folder.

    \b
    pmm archive note heave-0.50 "gauge fore replaced before this run"
    """  # noqa: D301
    from getpass import getuser

    from hardware.wall_clock import utc_now
    from pmm.archive.database import open_archive
    from pmm.archive.indexing import note_run
    from pmm.archive.notebook import NoteLine
    from pmm.archive.queries import the_run
    from pmm.cli.screen import messages

    with open_archive(Path(file)) as connection:
        filed_run = the_run(connection, run, campaign)
        line = NoteLine(utc_now(), run, author or getuser(), text)
        path = note_run(connection, filed_run, line)
    messages().print(f"written: {path}")


@archive.command()
@click.argument("name", metavar="NAME")
@click.option("--run", metavar="RUN", help="Compare a run with its repeats; NAME is a channel.")
@click.option("--order", type=click.IntRange(min=0), default=1, show_default=True,
              help="Harmonic of that channel; 0 is the mean.")  # fmt: skip
@CAMPAIGN
@PLOT
@click.option("--level", type=float, default=_LIMITS, show_default=True, callback=probability,
              metavar="P", help="Probability of the limits.")  # fmt: skip
@FILE
@JSON
def trend(
    name: str,
    run: str | None,
    order: int,
    campaign: str | None,
    plot: str | None,
    level: float,
    file: str,
    as_json: bool,
) -> None:
    """Show a coefficient, or a run's repeats, over time, and what is not as the others.

    With --run the harmonics of a channel are compared over all runs, of any campaign, that have
    the hull, medium and set-point of that run.

    \b
    pmm archive trend Z_w --plot plots
    pmm archive trend force_aft --run heave-0.50
    """  # noqa: D301
    from pmm.archive.database import open_archive
    from pmm.archive.trends import coefficient_trends, repeat_trends
    from pmm.cli.files import check_folder, write_asked_figures
    from pmm.cli.screen import show
    from pmm.report.archive_trend_document import trend_document, trend_figures

    check_folder(plot, "--plot")
    with open_archive(Path(file)) as connection:
        if run is None:
            trends = coefficient_trends(connection, name, level)
        else:
            trends = repeat_trends(connection, run, campaign, name, order, level)
    show(trend_document(trends, level), as_json=as_json)
    write_asked_figures(trend_figures(trends), plot, "archive")


@archive.command()
@click.option("--parquet", metavar="FILE", required=True, help="The file to write.")
@click.option("--coefficients", is_flag=True, help="Write coefficients instead of harmonics.")
@click.option("--overwrite", is_flag=True, help="Replace a file that is there.")
@FILE
def export(parquet: str, coefficients: bool, overwrite: bool, file: str) -> None:
    """Write all harmonics, each with its run's set-point, or all coefficients as a Parquet file.

    \b
    pmm archive export --parquet harmonics.parquet
    pmm archive export --parquet coefficients.parquet --coefficients
    """  # noqa: D301
    from pmm.archive.database import open_archive
    from pmm.archive.queries import (
        COEFFICIENT_COLUMNS,
        FILED_HARMONICS,
        all_harmonics,
        find_coefficients,
        write_parquet,
    )
    from pmm.cli.files import check_files
    from pmm.cli.screen import messages

    check_files({"--parquet": parquet}, [("--archive", Path(file))], overwrite=overwrite)
    with open_archive(Path(file)) as connection:
        if coefficients:
            kind, columns = "coefficients", COEFFICIENT_COLUMNS
            rows = find_coefficients(connection, "coefficient != ''")
        else:
            kind, columns = "harmonics", FILED_HARMONICS
            rows = all_harmonics(connection)
    write_parquet(columns, rows, Path(parquet))
    messages().print(f"written: {parquet}, {len(rows)} {kind}")
