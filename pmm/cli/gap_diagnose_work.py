"""What ``pmm gap CAMPAIGN`` does: examine the campaign, then print, write the page, keep it."""

from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from analysis.threads import cores
from pmm.cli.file_notices import tell_damaged, tell_unchecked, tell_writers
from pmm.cli.folders import check_files
from pmm.cli.gap_options import Looks
from pmm.cli.hints import pasted
from pmm.cli.screen import messages, output
from pmm.document.data import as_json
from pmm.document.terminal import print_document
from pmm.gap.case import CASE_FILE
from pmm.gap.document import document
from pmm.gap.examine import Examined, examine
from pmm.gap.prepare import campaign_file
from pmm.gap.report import PROPOSED, gap_report
from pmm.parallel import open_executor
from pmm.whole_file import write_whole

if TYPE_CHECKING:
    from pmm.campaign.runs import AtRest, Run


@dataclass(frozen=True)
class GapDiagnoseOptions(Looks):
    """The options of the command, by their names there."""

    campaign: str
    page: str | None
    plan: str | None
    jobs: int | None
    scheduler: str | None
    tolerances: bool
    as_json: bool


def run(request: GapDiagnoseOptions) -> None:
    """Diagnose a campaign.

    Raises
    ------
    ConfigurationError
        If the campaign or an option is wrong.
    DataError
        If too few runs can be used.
    """
    _check_files(request)
    if request.tolerances:
        _print_tolerances(request)
        return
    found = examined(request)
    report = gap_report(found)
    told = document(report)
    if request.page is not None:
        from pmm.document.page import write_page

        command = pasted("gap", request.campaign, *request.words(), "--page", request.page)
        write_page(told, Path(request.page), command=command)
        messages().print(f"page: {request.page}")
    if request.plan is not None:
        _write_plan(found, Path(request.plan))
    if request.as_json:
        click.echo(as_json(told))
    else:
        print_document(output(), told)
        if report.conclusion.adds:
            added = pasted("gap", "add", request.campaign, *request.words())
            output().print(added, soft_wrap=True)
    tell_unchecked(_read_files(found, campaign_file(Path(request.campaign)).parent))
    if tell_damaged(found.ready.damaged.items()):
        click.get_current_context().exit(1)


def _print_tolerances(request: GapDiagnoseOptions) -> None:
    from pmm.gap.tolerance_document import tolerance_document

    told = tolerance_document(Path(request.campaign), request.options)
    if request.as_json:
        click.echo(as_json(told))
    else:
        print_document(output(), told)


def _read_files(found: Examined, folder: Path) -> Iterator[Path]:
    every: tuple[Run | AtRest, ...] = (*found.campaign.runs, *found.campaign.at_rest)
    for one in every:
        path = one.recording_path(folder)
        if one.name not in found.left_out and path.exists():
            yield path


def _check_files(request: GapDiagnoseOptions) -> None:
    file = campaign_file(Path(request.campaign))
    read = [("CAMPAIGN", file), ("CAMPAIGN", file.parent / CASE_FILE), *request.read]
    check_files({"--page": request.page, "--plan": request.plan}, read)


def _write_plan(found: Examined, path: Path) -> None:
    from pmm.gap.next_plan import RIG_FILE, plan_text

    proposed = found.diagnosis.proposals[:PROPOSED]
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, plan_text(f"{found.campaign.name}-next", proposed))
    messages().print(f"plan: {path}; put the rig's {RIG_FILE} beside it, then: pmm plan check")


def examined(request: GapDiagnoseOptions) -> Examined:
    """Examine the campaign that is asked for, with progress on a terminal."""
    tell_writers([Path(request.campaign)])
    with progress() as told, engine(request, request.jobs, request.scheduler) as executor:
        return examine(Path(request.campaign), request.options, executor, told)


@contextmanager
def engine(
    looks: Looks, jobs: int | None, scheduler: str | None = None
) -> Iterator[Executor | None]:
    """Open what effects are looked at by: as asked for, or a process for each core.

    ``None``, for this process, with effects of the user's own: no other one knows them.
    """
    looks.check_alone(jobs, scheduler)
    if scheduler is None and (jobs == 1 or looks.files or cores() == 1):
        yield None
        return
    with open_executor(jobs, scheduler) as executor:
        yield executor


@contextmanager
def progress() -> Iterator[Callable[[str], None]]:
    """Say what is being done, on a terminal, for as long as the context lasts."""
    console = messages()
    if not console.is_terminal:
        yield lambda _: None
        return
    with console.status("reading") as status:
        yield lambda said: status.update(said)
