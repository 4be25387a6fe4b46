"""What ``pmm gap CAMPAIGN`` does: examine the campaign, then print, write the page, keep it."""

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import click

from pmm.cli.folders import check_files
from pmm.cli.gap_options import Looks
from pmm.cli.hints import pasted
from pmm.cli.screen import messages, output
from pmm.gap.case import CASE_FILE
from pmm.gap.examine import Examined, examine
from pmm.gap.prepare import campaign_file
from pmm.gap.report import PROPOSED, gap_report
from pmm.parallel import open_executor


@dataclass(frozen=True)
class Request(Looks):
    """The options of the command, by their names there."""

    campaign: str
    page: str | None
    plan: str | None
    jobs: int | None
    scheduler: str | None
    as_json: bool


def run(request: Request) -> None:
    """Diagnose a campaign.

    Raises
    ------
    ConfigurationError
        If the campaign or an option is wrong.
    DataError
        If too few runs can be used.
    """
    _check_files(request)
    found = examined(request)
    report = gap_report(found)
    if request.as_json:
        click.echo(json.dumps(report.as_dict(), indent=1, allow_nan=False))
    else:
        from pmm.cli.gap_diagnose_print import print_report

        print_report(output(), report)
        if report.verdict == "effect":
            added = pasted("gap", "add", request.campaign, *request.words())
            output().print(added, soft_wrap=True)
    if request.page is not None:
        from pmm.report.gap_page import write_gap_page

        command = pasted("gap", request.campaign, *request.words(), "--page", request.page)
        write_gap_page(report, Path(request.page), command=command)
        messages().print(f"page: {request.page}")
    if request.plan is not None:
        _write_plan(found, Path(request.plan))


def _check_files(request: Request) -> None:
    file = campaign_file(Path(request.campaign))
    read = [("CAMPAIGN", file), ("CAMPAIGN", file.parent / CASE_FILE), *request.read]
    check_files({"--page": request.page, "--plan": request.plan}, read)


def _write_plan(found: Examined, path: Path) -> None:
    from pmm.gap.next_plan import RIG_FILE, plan_text

    proposed = found.diagnosis.proposals[:PROPOSED]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(plan_text(f"{found.campaign.name}-next", proposed), encoding="utf-8")
    messages().print(f"plan: {path}; put the rig's {RIG_FILE} beside it, then: pmm plan check")


def examined(request: Request) -> Examined:
    """Examine the campaign that is asked for, with progress on a terminal."""
    request.check_alone(request.jobs, request.scheduler)
    jobs = request.jobs if request.scheduler is not None else request.jobs or 1
    with progress() as told, open_executor(jobs, request.scheduler) as executor:
        alone = jobs == 1 and request.scheduler is None
        return examine(Path(request.campaign), request.options, None if alone else executor, told)


@contextmanager
def progress() -> Iterator[Callable[[str], None]]:
    """Say what is being done, on a terminal, for as long as the context lasts."""
    console = messages()
    if not console.is_terminal:
        yield lambda _: None
        return
    with console.status("reading") as status:
        yield lambda said: status.update(said)
