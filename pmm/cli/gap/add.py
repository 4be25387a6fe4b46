"""``pmm gap add``: put the effect that was found into the campaign's simulation."""

from typing import Any

import click

from pmm.cli.engine_options import jobs_option
from pmm.cli.gap_options import looks


@click.command()
@click.argument("campaign", metavar="CAMPAIGN")
@click.option(
    "--effect",
    metavar="NAME",
    help="Fit and add this effect.  [default: the one that is found]",
)
@looks
@jobs_option("one for each core")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document, not a text.")
def add(**options: Any) -> None:
    """Write an effect with its fitted parameters into the campaign file.

    The next "pmm gap CAMPAIGN" and "pmm simulate" start from it. The file as it was is kept beside
    it as campaign.toml.1 (.2, ...). Where no effect is found nothing is written. The options that
    "pmm gap CAMPAIGN" was given are given here too, so that the same effect is found.

    Exit status: 0 added; 1 no effect is found; 2 the request was wrong.
    """
    from pmm.parallel import one_thread

    one_thread()  # the matrices are small: threads would wait for each other
    from pmm.cli.gap_add_work import GapAddOptions, run

    run(GapAddOptions(**options))
