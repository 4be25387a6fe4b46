"""``pmm report``: a campaign's coefficients as one page that needs nothing besides itself."""

import shlex
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import click

from pmm.cli.coefficients import SHARED, analysed, finish

REPORT_FILE = "report.html"


@click.command()
@SHARED
@click.option(
    "--output", metavar="FILE", help="The page.  [default: report.html in the first campaign]"
)
@click.option("--title", metavar="TEXT", help="Its heading.  [default: the campaign's name]")
@click.option("--overwrite", is_flag=True, help="Replace the page if it is there.")
def report(**options: Any) -> None:
    """Write a campaign's report: one HTML page, offline, ready to print.

    Tables with intervals, figures over frequency and amplitude, the budget of each coefficient,
    checks between runs, what was flagged, and where all of it comes from: versions, hashes and
    configuration; propeller and rudder where the folder has steering.toml, manoeuvres where it has
    ship.toml. Options and settings are those of `pmm coefficients`.

    \b
    pmm report campaign/ --system prime --output campaign.html

    Exit status: as `pmm coefficients`.
    """  # noqa: D301
    from pmm.cli.files import check_file
    from pmm.cli.screen import busy, program, say
    from pmm.coefficients.request import campaign_folder
    from pmm.document.page import write_page
    from pmm.report.archive_document import notes_story
    from pmm.report.coefficients_document import report_document
    from pmm.report.manoeuvre_document import manoeuvre_story
    from pmm.report.sequential_document import story
    from pmm.report.steering_document import steering_story

    path = _path(options)
    check_file(path, "--output", overwrite=options["overwrite"])
    outcome, files = analysed(options, hashed=True)
    title = options["title"] or f"Coefficients of {', '.join(outcome.names)}"
    command = shlex.join([Path(program()).name, *sys.argv[1:]])
    folders = [campaign_folder(text) for text in options["campaigns"]]
    stories = [part for pair in zip(folders, outcome.names, strict=True) for part in story(*pair)]
    level = outcome.result.level
    with busy("drawing the page"):
        for folder in folders:
            stories += [*steering_story(folder, level), *manoeuvre_story(folder, level)]
            stories += notes_story(folder)
        write_page(
            report_document(outcome, stories), path, title=title, command=command, read=files
        )
    say(path)
    finish(outcome)


def _path(options: Mapping[str, Any]) -> Path:
    from pmm.campaign.file_names import CAMPAIGN_FILE

    if options["output"] is not None:
        return Path(options["output"])
    first = Path(options["campaigns"][0])
    return (first.parent if first.name == CAMPAIGN_FILE else first) / REPORT_FILE
