"""What ``pmm run`` does: check the plan, open the rig, carry the runs out, write the campaign."""

import json
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import ExitStack, contextmanager, nullcontext, suppress
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import Any, Final

import click

from hardware.description.errors import DataError
from hardware.description.room import is_full, said
from hardware.pacing import FreeRunning, Pacer, RealTime
from hardware.rig import Rig
from pmm.cli.findings import finding_lines
from pmm.cli.folders import check_folder
from pmm.cli.hints import pasted
from pmm.cli.run_view import LiveView, PlainView, outcome_line
from pmm.cli.screen import messages, output
from pmm.cli.terminal import Terminal
from pmm.plan.campaign_writer import write_campaign
from pmm.plan.checks import require_possible
from pmm.plan.findings import PlanFinding
from pmm.plan.plan import Plan, read_plan_and_rig
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan
from pmm.real_time import before_others, step_back
from pmm.recorder.campaign_owner import own_campaign
from pmm.recorder.run_recorder import RunEnd
from pmm.run.campaign_folder import (
    check_names,
    chosen_runs,
    finished_runs,
    folder_of,
    keep_sources,
    kept_runs,
)
from pmm.run.journal import Taps
from pmm.run.operator import Answers, Interrupts, standard_input
from pmm.run.recorder_factory import RecorderFactory
from pmm.run.rehearsal import rehearse
from pmm.run.run_control import RunControl
from pmm.run.run_origin import change_lines
from pmm.run.states import Command, RunStateError
from pmm.run.status import RunOutcome

JSON_SCHEMA: Final = "pmm-run-control-1"
_INTERRUPTED: Final = 130


@dataclass(frozen=True)
class RunOptions:
    """The options of ``pmm run``, by their names there."""

    plan: str
    only: tuple[str, ...] = ()
    resume: bool = False
    accept_changes: bool = False
    output: str | None = None
    dry_run: bool = False
    real_time: bool = False
    as_json: bool = False


@dataclass(frozen=True)
class RunJob:
    """What is to be done."""

    plan: Plan
    rig_file: RigFile
    folder: Path
    runs: tuple[RunPlan, ...]
    findings: tuple[PlanFinding, ...]
    real_time: bool
    changes: tuple[str, ...]


class RunFailedError(DataError):
    """A run ended in a fault; the message names its cause."""


def work(request: RunOptions) -> None:
    """Carry out the runs that were asked for.

    Raises
    ------
    ConfigurationError, PlanRefusedError
        If plan or rig are wrong or beyond a limit, or the folder holds runs already.
    OwnedElsewhereError
        If another process is writing into the folder.
    RunFailedError
        If the rig stopped in a fault.
    """
    where = ("--output", request.output) if request.output else ()
    resume = pasted("run", request.plan, "--resume", *where)
    try:
        _work(request, resume)
    except OSError as error:
        if not is_full(error):
            raise
        raise RunFailedError(
            f"{said(error)}; what is recorded is kept\nwhen there is room: {resume}"
        ) from error


def _work(request: RunOptions, resume: str) -> None:
    """Do it, and say how to go on after a fault."""
    outcomes: list[RunOutcome] = []
    interrupted = False
    fault = ""
    # The terminal is waited for last: the rig is left by then, and the folder free.
    with ExitStack() as shown, _job(request) as job:
        for line in finding_lines(job.findings):
            messages().print(line, soft_wrap=True)
        for told in job.changes:
            messages().print(f"keeps what it was recorded with: {told}", soft_wrap=True)
        if not request.dry_run and job.runs:
            if job.real_time:
                _keep_time(shown)
            terminal = shown.enter_context(Terminal())
            outcomes, interrupted, fault = _carry_out(job, terminal, quiet=request.as_json)
    _report(request, job, outcomes, fault)
    if fault:
        raise RunFailedError(
            f"{fault}\nall axes are told to stop and the fault is latched; when its cause is "
            f"gone: {resume}"
        )
    if interrupted:
        sys.exit(_INTERRUPTED)


@contextmanager
def _job(request: RunOptions) -> Iterator[RunJob]:
    """Say what is to be done; the folder is owned from before it is read, but for a dry run."""
    plan, rig_file = read_plan_and_rig(request.plan)
    findings = require_possible(plan, rig_file, datetime.now(UTC).date())
    folder = folder_of(plan, rig_file.recorder.folder, request.output)
    check_names(plan, request.only)
    check_folder(folder, "--output")
    with nullcontext() if request.dry_run else own_campaign(folder) as owned:
        if owned is not None:
            owned.count()  # now, and not in the loop
        runs = chosen_runs(
            plan,
            rig_file,
            folder,
            request.only,
            resume=request.resume,
            accept_changes=request.accept_changes,
        )
        real_time = rig_file.realtime or request.real_time
        chosen = {"", *(one.name for one in runs)}
        findings = tuple(one for one in findings if one.run in chosen)
        changes = tuple(change_lines(kept_runs(plan, rig_file, folder, runs)))
        yield RunJob(plan, rig_file, folder, runs, findings, real_time, changes)


def _keep_time(stack: ExitStack) -> None:
    """Put the loop, and what it starts from here on, before all that could make its cycles late."""
    rehearse()
    standing = stack.enter_context(before_others())
    if standing.advice:
        messages().print(standing.advice)


def _carry_out(
    job: RunJob, terminal: Terminal, *, quiet: bool
) -> tuple[list[RunOutcome], bool, str]:
    """Run the loop; return the outcomes, whether Ctrl-C ended it, and the fault."""
    keep_sources(job.plan, job.rig_file, job.folder)
    answers, interrupts = standard_input(), Interrupts()
    with ExitStack() as stack:
        stack.enter_context(interrupts.counted())
        stack.callback(_write, job)  # at the end, when the rig is left; a failure is heard here
        view = _view(stack, terminal, answers, quiet=quiet)
        taps = Taps()
        rig = stack.enter_context(_rig(job, answers, taps))
        executor = stack.enter_context(_executor(job.real_time))
        recording = stack.enter_context(
            RecorderFactory(rig, job.rig_file, job.plan, job.folder, _utc, taps, _provenance(job))
        )
        control = RunControl(
            rig, job.rig_file, job.runs, recording.begin, time.monotonic, view, executor
        )
        control.free_bytes = recording.free_bytes
        rig.prepare()
        for note in rig.notes:
            messages().print(f"note: {note}")
        control.request(Command.START)
        write = partial(_write, job) if executor is None else partial(executor.submit, _write, job)
        _loop(control, rig, answers, interrupts, write)
        fault = "" if control.fault is None else str(control.fault)
        return control.outcomes, interrupts.count > 0, fault


def _loop(
    control: RunControl,
    rig: Rig,
    answers: Answers,
    interrupts: Interrupts,
    write: Callable[[], object],
) -> None:
    """Step until nothing more happens; hand Ctrl-C on, once and twice."""
    heard = written = 0
    attended = rig.master is not None and rig.master.operator is not None
    while not control.finished:
        answers.question = ""
        control.step()
        if interrupts.count > heard:
            heard += 1
            _interrupt(control, Command.STOP if heard == 1 else Command.QUICK_STOP)
        if answers.absent and answers.question and not attended:
            _interrupt(control, Command.STOP)
            raise RunFailedError(f"nobody answers: {answers.question}; the input has ended")
        if len(control.outcomes) > written:
            written = len(control.outcomes)
            write()


def _interrupt(control: RunControl, command: Command) -> None:
    with suppress(RunStateError):  # it is stopping already, or has stopped
        control.request(command)


def _write(job: RunJob) -> None:
    done = finished_runs(job.folder, job.plan, job.rig_file)
    write_campaign(job.folder, job.plan, job.rig_file, done)


@contextmanager
def _rig(job: RunJob, answers: Answers, taps: Taps) -> Iterator[Rig]:
    configuration = job.rig_file.hardware
    period_s = 1.0 / configuration.sample_rate_hz
    pacer: Pacer = FreeRunning()
    if job.real_time:
        pacer = RealTime(period_s, time.monotonic, time.sleep)
    with Rig(
        configuration,
        time.monotonic,
        pacer,
        answers,
        observers=(taps.frame,),
        line_observers=(taps.line,),
    ) as rig:
        yield rig


@contextmanager
def _executor(real_time: bool) -> Iterator[Executor | None]:
    """Give a thread to complete recordings in; in simulated time the loop may as well wait."""
    if not real_time:
        yield None
        return
    with ThreadPoolExecutor(1, thread_name_prefix="closing", initializer=step_back) as executor:
        yield executor


def _view(
    stack: ExitStack, terminal: Terminal, answers: Answers, *, quiet: bool
) -> LiveView | PlainView:
    def question() -> str:
        return answers.question

    if quiet or not terminal.console.is_terminal:
        return PlainView(terminal.say, question)
    return stack.enter_context(LiveView(terminal, time.monotonic, question).shown())


def _utc() -> str:
    return datetime.now(UTC).isoformat(timespec="seconds")


def _provenance(job: RunJob) -> dict[str, str]:
    from importlib.metadata import version

    operator = {"operator": job.plan.operator} if job.plan.operator else {}
    return {"program": f"pmm {version('pmm')}", "plan": job.plan.name, **operator}


def _report(request: RunOptions, job: RunJob, outcomes: Sequence[RunOutcome], fault: str) -> None:
    if request.as_json:
        click.echo(json.dumps(_document(request, job, outcomes, fault), indent=1))
        return
    console = output()
    if request.dry_run:
        console.print(f"{job.plan.path}: {len(job.runs)} runs would be recorded to {job.folder}")
        return
    if not job.runs:
        console.print(f"{job.folder}: all runs are complete")
        return
    for one in outcomes:
        told = bool(fault) and one.reason == fault  # as the error
        if one.outcome != RunEnd.COMPLETE and not told:
            console.print(outcome_line(one), soft_wrap=True)
    complete = sum(one.outcome == RunEnd.COMPLETE for one in outcomes)
    console.print(f"{complete} of {len(job.runs)} runs complete in {job.folder}")
    if complete:
        console.print(pasted("analyse", job.folder), soft_wrap=True)


def _document(
    request: RunOptions, job: RunJob, outcomes: Sequence[RunOutcome], fault: str
) -> dict[str, Any]:
    return {
        "schema": JSON_SCHEMA,
        "plan": str(job.plan.path),
        "folder": str(job.folder),
        "dry_run": request.dry_run,
        "planned": [one.name for one in job.runs],
        "findings": [asdict(one) for one in job.findings],
        "changes": list(job.changes),
        "fault": fault or None,
        "runs": [asdict(one) for one in outcomes],
    }
