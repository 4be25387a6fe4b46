"""``pmm gap CAMPAIGN``: where rig and simulation differ, why, and how far the gap shrinks."""

from typing import Any

import click

from pmm.cli.engine_options import jobs_option, scheduler_option
from pmm.cli.gap_options import looks


@click.command()
@click.argument("campaign", metavar="CAMPAIGN")
@looks
@click.option("--page", metavar="FILE.html", help="Write a page with figures.")
@click.option("--plan", metavar="FILE.toml", help="Write the proposed runs as a plan for pmm run.")
@jobs_option("one for each core")
@scheduler_option
@click.option(
    "--tolerances",
    is_flag=True,
    help="Print what may be off without a gap, and by how much it is, in place of a diagnosis.",
)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document, not tables.")
def diagnose(**options: Any) -> None:
    """Say where rig and simulation differ, which effect causes it, and how far the gap shrinks.

    CAMPAIGN is a folder with a campaign.toml and a recording per run. Either the file or a
    case.toml beside it may say tolerances, the latter also what the rig can do next (docs/gap.md).
    "No gap" is an answer.

    \b
    pmm gap my-campaign --hold-out frequency=1.1 --page gap.html
    pmm gap my-campaign --plan next/plan.toml
    pmm gap add my-campaign

    Exit status: 0 diagnosed; 1 the data say no; 2 the request was wrong.
    """  # noqa: D301
    from pmm.parallel import one_thread

    one_thread()  # the matrices are small: threads would wait for each other
    from pmm.cli.gap_diagnose_work import GapDiagnoseOptions, run

    run(GapDiagnoseOptions(**options))
