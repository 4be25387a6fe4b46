"""``pmm run``: a plan in, recordings out."""

import time
from contextlib import ExitStack, nullcontext
from typing import TYPE_CHECKING

import click

from pmm.cli.options import JSON

if TYPE_CHECKING:
    from contextlib import AbstractContextManager

    from pmm.cli.terminal import Terminal
    from pmm.run.run_control import View
    from pmm.run.session import Ask, RunJob, RunReport

_INTERRUPTED = 130  # what a shell reports of a command that Ctrl-C ended


@click.command()
@click.argument("plan", metavar="PLAN.TOML")
@click.option("--only", multiple=True, metavar="RUN", help="Make this run only; repeatable.")
@click.option("--resume", is_flag=True, help="Go on: make the runs that are not complete yet.")
@click.option(
    "--accept-changes",
    is_flag=True,
    help="Go on although plan, rig, model or calibration changed; each run keeps its own.",
)
@click.option(
    "--output",
    metavar="FOLDER",
    help="Record there.  [default: the plan's name, in the folder that the rig's file names]",
)
@click.option("--dry-run", is_flag=True, help="Check the plan and say what would be done.")
@click.option("--real-time", is_flag=True, help="Keep to the clock, also on a simulated rig.")
@JSON
def run(
    plan: str,
    only: tuple[str, ...],
    resume: bool,
    accept_changes: bool,
    output: str | None,
    dry_run: bool,
    real_time: bool,
    as_json: bool,
) -> None:
    """Carry out a plan on its rig and record every run.

    Ctrl-C once stops gently: the axes run down along their profile, the power is taken off, the
    recording is closed. Twice stops at once. Nothing resumes by itself: --resume does.
    Axes that are set by hand are asked for; readings are typed in, or piped, one a line.

    \b
    pmm run examples/vertical/plan.toml --output my-campaign
    pmm analyse my-campaign

    Exit status: 0 all runs are complete; 1 the rig or the data say no; 2 the request was wrong;
    130 stopped by Ctrl-C.
    """  # noqa: D301
    from hardware.description.room import is_full, said
    from pmm.cli.files import check_folder
    from pmm.cli.screen import pasted, say, show
    from pmm.report.run_document import complete_runs, run_document
    from pmm.run.session import RunFailedError, RunReport, run_job

    where = ("--output", output) if output else ()
    again = pasted("run", plan, "--resume", *where)
    found = RunReport()
    try:
        # The terminal is waited for last: the rig is left by then, and the folder free.
        with (
            ExitStack() as shown,
            run_job(
                plan,
                only,
                lambda folder: check_folder(folder, "--output"),
                output=output,
                resume=resume,
                accept_changes=accept_changes,
                dry_run=dry_run,
                real_time=real_time,
            ) as job,
        ):
            _tell(job)
            if job.runs and not dry_run:
                found = _carried_out(job, shown, quiet=as_json)
    except OSError as error:
        if not is_full(error):
            raise
        raise RunFailedError(
            f"{said(error)}; what is recorded is kept\nwhen there is room: {again}"
        ) from error
    show(run_document(job, found, dry_run=dry_run), as_json=as_json)
    if complete_runs(found) and not as_json:
        say(pasted("analyse", job.folder))
    if found.fault:
        raise RunFailedError(
            f"{found.fault}\nall axes are told to stop and the fault is latched; when its cause "
            f"is gone: {again}"
        )
    if found.interrupted:
        click.get_current_context().exit(_INTERRUPTED)


def _tell(job: "RunJob") -> None:
    """Say what was found of the plan, and what runs that are there were recorded with."""
    from pmm.cli.screen import messages
    from pmm.document.terminal import print_content
    from pmm.report.plan_document import finding_notes

    print_content(finding_notes(job.findings), messages())
    for told in job.changes:
        messages().print(f"keeps what it was recorded with: {told}")


def _carried_out(job: "RunJob", shown: ExitStack, *, quiet: bool) -> "RunReport":
    """Carry the runs out, shown on the terminal."""
    from pmm.cli.screen import messages
    from pmm.cli.terminal import Terminal
    from pmm.run.session import carry_out, keep_time

    if job.real_time and (advice := keep_time(shown).advice):
        messages().print(advice)
    terminal = shown.enter_context(Terminal())
    return carry_out(
        job, lambda ask: _view(terminal, ask, quiet=quiet), lambda line: messages().print(line)
    )


def _view(terminal: "Terminal", ask: "Ask", *, quiet: bool) -> "AbstractContextManager[View]":
    from pmm.cli.run_view import LiveView, PlainView

    if quiet or not terminal.console.is_terminal:
        return nullcontext(PlainView(terminal.say, ask))
    return LiveView(terminal, time.monotonic, ask).shown()
