"""``pmm run``: a plan in, recordings out."""

import time
from contextlib import ExitStack, contextmanager, nullcontext
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from hardware.description.errors import ConfigurationError
from pmm.cli.options import JSON

if TYPE_CHECKING:
    from collections.abc import Iterator
    from contextlib import AbstractContextManager

    from pmm.cli.terminal import Terminal
    from pmm.run.run_control import RunControl
    from pmm.run.session import Ask, RunJob, RunReport
    from pmm.run.view import View

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
@click.option(
    "--until",
    type=click.Choice(["targets", "cause"]),
    help="PLAN.toml is a design: choose run after run until its targets are met, or until it is "
    "known why rig and simulation differ.",
)
@click.option(
    "--approve",
    metavar="all|ENVELOPE.toml",
    help="With --until: approve of all runs (simulated rig), or of those within an envelope.  "
    "[default: ask for each change]",
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
    until: str | None,
    approve: str | None,
    dry_run: bool,
    real_time: bool,
    as_json: bool,
) -> None:
    """Carry out a plan on its rig and record every run.

    Ctrl-C once stops gently: the axes run down along their profile, the power is taken off, the
    recording is closed. Twice stops at once. Nothing resumes by itself: --resume does.
    Axes that are set by hand are asked for; readings are typed in, or piped, one a line.
    With --until targets the file is a design (docs/plan-design.md): after each run the coefficients
    are found again and the rest is planned anew; you approve of each change. --until cause takes a
    design with [gap] and goes on until one class of causes has a probability over 0.95.

    \b
    pmm run examples/vertical/plan.toml --output my-campaign
    pmm run examples/vertical/design.toml --until targets --output my-campaign
    pmm analyse my-campaign

    Exit status: 0 all runs are complete; 1 the rig or the data say no; 2 the request was wrong;
    130 stopped by Ctrl-C.
    """  # noqa: D301
    from pmm.cli.screen import pasted

    output_options = ("--output", output) if output else ()
    command = pasted(
        "run", plan, *(("--until", until) if until else ()), "--resume", *output_options
    )
    with _room_said(command):
        if until is None:
            _refuse(approve is not None, "--approve")
            report = _carried_out(
                plan, only, output, resume, accept_changes, dry_run, real_time, as_json=as_json
            )
        else:
            _refuse(bool(only), "--only", until)
            _refuse(dry_run, "--dry-run", until)
            report = carried_out_until(
                plan, until, output, approve, resume, accept_changes, real_time, as_json=as_json
            )
    if report.fault:
        from pmm.run.session import RunFailedError

        raise RunFailedError(
            f"{report.fault}\nall axes are told to stop and the fault is latched; when its cause "
            f"is gone: {command}"
        )
    if report.interrupted:
        click.get_current_context().exit(_INTERRUPTED)


def _refuse(is_given: bool, option: str, until: str | None = None) -> None:
    """Refuse an option that does not go with --until, or goes with nothing else."""
    if is_given and until is None:
        raise click.UsageError(
            f"{option} goes with --until; without it each run of PLAN.toml is made"
        )
    if is_given:
        raise click.UsageError(
            f"{option} does not go with --until: `pmm plan design` shows what would be chosen"
        )


@contextmanager
def _room_said(command: str) -> "Iterator[None]":
    """Say what to do where the disk is full."""
    try:
        yield
    except OSError as error:
        from hardware.description.room import file_error_text, is_full
        from pmm.run.session import RunFailedError

        if not is_full(error):
            raise
        raise RunFailedError(
            f"{file_error_text(error)}; what is recorded is kept\nwhen there is room: {command}"
        ) from error


def _carried_out(
    plan: str,
    only: tuple[str, ...],
    output: str | None,
    resume: bool,
    accept_changes: bool,
    dry_run: bool,
    real_time: bool,
    *,
    as_json: bool,
) -> "RunReport":
    """Make the runs of a plan and say how they ended."""
    from pmm.cli.files import check_folder
    from pmm.cli.next_step import next_command
    from pmm.cli.screen import say, show
    from pmm.report.run_document import complete_runs, run_document
    from pmm.run.session import RunReport, run_job

    report = RunReport()
    # The terminal is waited for last: the rig is left by then, and the folder free.
    with (
        ExitStack() as stack,
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
        tell_job(job)
        if job.runs and not dry_run:
            report = _run_on_terminal(job, stack, quiet=as_json)
    show(run_document(job, report, dry_run=dry_run), as_json=as_json)
    if complete_runs(report) and not as_json:
        say(next_command(job.folder, Path(plan).parent))
    return report


def _run_on_terminal(job: "RunJob", stack: ExitStack, *, quiet: bool) -> "RunReport":
    """Carry the runs out, shown on the terminal."""
    from pmm.cli.screen import messages
    from pmm.run.operator import standard_input
    from pmm.run.session import carry_out

    terminal = before_others_with_terminal(stack, real_time=job.real_time)
    return carry_out(
        job,
        lambda ask: view_of(terminal, ask, quiet=quiet),
        lambda line: messages().print(line),
        standard_input(),
    )


def tell_job(job: "RunJob") -> None:
    """Say what was found of the plan, and what runs that are there were recorded with."""
    from pmm.cli.screen import messages
    from pmm.document.terminal import print_content
    from pmm.report.plan_document import finding_notes

    print_content(finding_notes(job.findings), messages())
    for change in job.changes:
        messages().print(f"keeps what it was recorded with: {change}")


def before_others_with_terminal(stack: ExitStack, *, real_time: bool) -> "Terminal":
    """Put the loop before other programs where it keeps time; open the terminal."""
    from pmm.cli.screen import messages
    from pmm.cli.terminal import Terminal
    from pmm.run.session import keep_time

    if real_time and (advice := keep_time(stack).advice):
        messages().print(advice)
    return stack.enter_context(Terminal())


def view_of(
    terminal: "Terminal", ask: "Ask", *, quiet: bool
) -> "AbstractContextManager[View[RunControl]]":
    """Return a live picture on a terminal, plain lines elsewhere."""
    from pmm.cli.run_view import LiveView, PlainView

    if quiet or not terminal.console.is_terminal:
        return nullcontext(PlainView(terminal.say, ask))
    return LiveView(terminal, time.monotonic, ask).drawn_live()


def carried_out_until(
    design: str,
    until: str,
    output: str | None,
    approve: str | None,
    resume: bool,
    accept_changes: bool,
    real_time: bool,
    *,
    as_json: bool,
) -> "RunReport":
    """Make run after run until the goal is reached, and say how the campaign ended.

    Raises
    ------
    ConfigurationError
        Besides what is wrong in the design, if it is made for the other goal.
    """
    from pmm.cli.files import check_folder
    from pmm.cli.screen import messages, pasted, say, show
    from pmm.design.design_file import read_design
    from pmm.gap.rig_pursuit import goal_of
    from pmm.report.sequential_document import look_lines, sequential_document
    from pmm.run.operator import standard_input
    from pmm.sequential.execution import CampaignRequest, Screen, carry_out_campaign
    from pmm.sequential.look import read_decisions

    file = read_design(Path(design))
    if (file.gap is None) is not (until == "targets"):
        raise ConfigurationError(
            f"{file.path}: --until cause takes a design with a table [gap], --until targets one "
            "without it"
        )
    keeps_time = file.rig.realtime or real_time
    request = CampaignRequest(
        output, approve, resume, accept_changes, real_time,
        lambda folder: check_folder(folder, "--output"),
    )  # fmt: skip
    with ExitStack() as stack:
        terminal = before_others_with_terminal(stack, real_time=keeps_time)
        screen = Screen(
            lambda ask: view_of(terminal, ask, quiet=as_json),
            lambda line: messages().print(line),
            lambda look: messages().print("\n".join(look_lines(look))),
            _tell_runs,
        )
        goal = partial(goal_of, apart=keeps_time)
        outcome = carry_out_campaign(file, goal, request, screen, standard_input())
    decisions = read_decisions(outcome.folder)
    if decisions:
        show(sequential_document(file.name, outcome.folder, decisions), as_json=as_json)
    if decisions and decisions[-1].runs and not as_json:
        say(pasted("report", outcome.folder))
    return outcome.report


def _tell_runs(job: "RunJob") -> None:
    """Say what was found of the runs that are made next, and not of the whole plan each time."""
    from dataclasses import replace

    tell_job(replace(job, findings=tuple(finding for finding in job.findings if finding.run)))
