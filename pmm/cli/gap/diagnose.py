"""``pmm gap CAMPAIGN``: where rig and simulation differ, why, and how far the gap shrinks."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from pmm.cli.gap.options import LOOKS, Looks, engine
from pmm.cli.options import JSON, SCHEDULER, jobs_option

if TYPE_CHECKING:
    from collections.abc import Iterator

    from pmm.campaign.runs import AtRest, Run
    from pmm.gap.examination import Examined


@click.command()
@click.argument("campaign", metavar="CAMPAIGN")
@LOOKS
@click.option("--page", metavar="FILE.html", help="Write a page with figures.")
@click.option("--plan", metavar="FILE.toml", help="Write the proposed runs as a plan for pmm run.")
@jobs_option("one for each core")
@SCHEDULER
@click.option(
    "--tolerances",
    is_flag=True,
    help="Print what may be off without a gap, and by how much it is, in place of a diagnosis.",
)
@JSON
def diagnose(
    campaign: str,
    page: str | None,
    plan: str | None,
    jobs: int | None,
    scheduler: str | None,
    tolerances: bool,
    as_json: bool,
    **options: Any,
) -> None:
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
    from pmm.cli import files
    from pmm.cli.screen import doing, pasted, say, show
    from pmm.gap.case import CASE_FILE
    from pmm.gap.document import document
    from pmm.gap.examination import examine
    from pmm.gap.preparation import campaign_file
    from pmm.gap.report import gap_report
    from pmm.gap.tolerance_document import tolerance_document
    from pmm.remote import local_path

    looks, path = Looks(**options), local_path(campaign)
    file = campaign_file(path)
    inputs = [("CAMPAIGN", file), ("CAMPAIGN", file.parent / CASE_FILE), *looks.read]
    files.check_files({"--page": page, "--plan": plan}, inputs)
    files.tell_writers([path])
    if tolerances:
        show(tolerance_document(path, looks.options), as_json=as_json)
        return
    with doing("reading") as progress, engine(looks, jobs, scheduler) as executor:
        examination = examine(path, looks.options, executor, progress)
    report = gap_report(examination)
    content = document(report)
    files.write_asked_page(content, page, ("gap", campaign, *looks.words()))
    if plan is not None:
        _write_plan(examination, Path(plan))
    show(content, as_json=as_json)
    if report.conclusion.adds and not as_json:
        say(pasted("gap", "add", campaign, *looks.words()))
    files.tell_unchecked(_read_files(examination, file.parent))
    if files.tell_damaged(examination.ready.damaged.items()):
        click.get_current_context().exit(1)


def _read_files(examination: "Examined", folder: Path) -> "Iterator[Path]":
    runs: tuple[Run | AtRest, ...] = (*examination.campaign.runs, *examination.campaign.at_rest)
    for run in runs:
        path = run.recording_path(folder)
        if run.name not in examination.left_out and path.exists():
            yield path


def _write_plan(examination: "Examined", path: Path) -> None:
    from pmm.cli.screen import messages
    from pmm.gap.next_plan import RIG_FILE, plan_text
    from pmm.gap.report import PROPOSED
    from pmm.whole_file import write_whole

    proposed = examination.diagnosis.proposals[:PROPOSED]
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, plan_text(f"{examination.campaign.name}-next", proposed))
    messages().print(f"plan: {path}; put the rig's {RIG_FILE} beside it, then: pmm plan check")
