"""``pmm report``: a campaign's coefficients as one page that needs nothing besides itself."""

from typing import Any

import click

from pmm.cli.coefficients import shared_options


@click.command()
@shared_options
@click.option(
    "--output", metavar="FILE", help="The page.  [default: report.html in the first campaign]"
)
@click.option("--title", metavar="TEXT", help="Its heading.  [default: the campaign's name]")
@click.option("--overwrite", is_flag=True, help="Replace the page if it is there.")
def report(**options: Any) -> None:
    """Write a campaign's report: one HTML page, offline, ready to print.

    Tables with intervals, figures over frequency and amplitude, the budget of each coefficient,
    checks between runs, what was flagged, and where all of it comes from: versions, hashes and
    configuration. Options and settings are those of `pmm coefficients`.

    \b
    pmm report campaign/ --system prime --output campaign.html

    Exit status: as `pmm coefficients`.
    """  # noqa: D301
    from pmm.cli.reporting import run

    run(options)
