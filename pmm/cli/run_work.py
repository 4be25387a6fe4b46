"""What ``pmm run`` does: check the plan, open the rig, carry the runs out, write the campaign."""

import json
import sys
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Final

import click

from hardware.description.errors import DataError
from hardware.pacing import FreeRunning, Pacer, RealTime
from hardware.rig import Rig
from pmm.cli.findings import finding_lines
from pmm.cli.folders import check_folder
from pmm.cli.hints import pasted
from pmm.cli.run_console import Answers, Interrupts, standard_input
from pmm.cli.run_view import LiveView, PlainView, outcome_line
from pmm.cli.screen import messages, output
from pmm.plan.campaign_writer import write_campaign
from pmm.plan.checks import require_possible
from pmm.plan.findings import Finding
from pmm.plan.plan import Plan, read_plan_and_rig
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan
from pmm.recorder.run_recorder import Outcome
from pmm.run.campaign_folder import chosen_runs, finished_runs, folder_of, keep_sources
from pmm.run.journal import Taps
from pmm.run.recording import Recording
from pmm.run.run_control import RunControl
from pmm.run.states import Command, RunStateError
from pmm.run.status import RunOutcome

JSON_SCHEMA: Final = "pmm-run-control-1"
_INTERRUPTED: Final = 130


@dataclass(frozen=True)
class Request:
    """The options of ``pmm run``, by their names there."""

    plan: str
    only: tuple[str, ...]
    resume: bool
    output: str | None
    dry_run: bool
    real_time: bool
    as_json: bool


@dataclass(frozen=True)
class Job:
    """What is to be done."""

    plan: Plan
    rig_file: RigFile
    folder: Path
    runs: tuple[RunPlan, ...]
    findings: tuple[Finding, ...]
    real_time: bool


class RunFailedError(DataError):
    """A run ended in a fault; the message names its cause."""


def work(request: Request) -> None:
    """Carry out the runs that were asked for.

    Raises
    ------
    ConfigurationError, PlanRefusedError
        If plan or rig are wrong or beyond a limit, or the folder holds runs already.
    RunFailedError
        If the rig stopped in a fault.
    """
    job = _job(request)
    for line in finding_lines(job.findings):
        messages().print(line, soft_wrap=True)
    outcomes: list[RunOutcome] = []
    interrupted = False
    fault = ""
    if not request.dry_run and job.runs:
        outcomes, interrupted, fault = _carry_out(job, quiet=request.as_json)
    _report(request, job, outcomes, fault)
    if fault:
        where = ("--output", request.output) if request.output else ()
        resume = pasted("run", request.plan, "--resume", *where)
        raise RunFailedError(
            f"{fault}\nall axes are told to stop and the fault is latched; when its cause is "
            f"gone: {resume}"
        )
    if interrupted:
        sys.exit(_INTERRUPTED)


def _job(request: Request) -> Job:
    plan, rig_file = read_plan_and_rig(request.plan)
    findings = require_possible(plan, rig_file, datetime.now(UTC).date())
    folder = folder_of(plan, rig_file.recorder.folder, request.output)
    check_folder(folder, "--output")
    runs = chosen_runs(plan, folder, request.only, resume=request.resume)
    real_time = rig_file.realtime or request.real_time
    chosen = {"", *(one.name for one in runs)}
    findings = tuple(one for one in findings if one.run in chosen)
    return Job(plan, rig_file, folder, runs, findings, real_time)


def _carry_out(job: Job, *, quiet: bool) -> tuple[list[RunOutcome], bool, str]:
    """Run the loop; return the outcomes, whether Ctrl-C ended it, and the fault."""
    job.folder.mkdir(parents=True, exist_ok=True)
    keep_sources(job.plan, job.folder)
    answers, interrupts = standard_input(), Interrupts()
    with ExitStack() as stack:
        stack.enter_context(interrupts.counted())
        taps = Taps()
        rig = stack.enter_context(_rig(job, answers, taps))
        view = _view(stack, answers, quiet=quiet)
        executor = stack.enter_context(_executor(job.real_time))
        recording = stack.enter_context(
            Recording(rig, job.rig_file, job.plan, job.folder, _utc, taps, _provenance(job))
        )
        control = RunControl(
            rig, job.rig_file, job.runs, recording.begin, time.monotonic, view, executor
        )
        control.free_bytes = recording.free_bytes
        rig.prepare()
        control.request(Command.START)
        _loop(control, rig, answers, interrupts, job)
        fault = "" if control.fault is None else str(control.fault)
        return control.outcomes, interrupts.count > 0, fault


def _loop(
    control: RunControl, rig: Rig, answers: Answers, interrupts: Interrupts, job: Job
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
            _write(job)
    _write(job)


def _interrupt(control: RunControl, command: Command) -> None:
    with suppress(RunStateError):  # it is stopping already, or has stopped
        control.request(command)


def _write(job: Job) -> None:
    write_campaign(job.folder, job.plan, job.rig_file, finished_runs(job.folder, job.plan.runs))


@contextmanager
def _rig(job: Job, answers: Answers, taps: Taps) -> Iterator[Rig]:
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
    with ThreadPoolExecutor(1, thread_name_prefix="closing") as executor:
        yield executor


def _view(stack: ExitStack, answers: Answers, *, quiet: bool) -> LiveView | PlainView:
    console = messages()

    def question() -> str:
        return answers.question

    if quiet or not console.is_terminal:
        return PlainView(lambda line: console.print(line), question)
    live = LiveView(time.monotonic, question)
    stack.enter_context(live.shown())
    return live


def _utc() -> str:
    return datetime.now(UTC).isoformat(timespec="seconds")


def _provenance(job: Job) -> dict[str, str]:
    from importlib.metadata import version

    operator = {"operator": job.plan.operator} if job.plan.operator else {}
    return {"program": f"pmm {version('pmm')}", "plan": job.plan.name, **operator}


def _report(request: Request, job: Job, outcomes: Sequence[RunOutcome], fault: str) -> None:
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
        if one.outcome != Outcome.COMPLETE and not told:
            console.print(outcome_line(one), soft_wrap=True)
    complete = sum(one.outcome == Outcome.COMPLETE for one in outcomes)
    console.print(f"{complete} of {len(job.runs)} runs complete in {job.folder}")
    if complete:
        console.print(pasted("analyse", job.folder), soft_wrap=True)


def _document(
    request: Request, job: Job, outcomes: Sequence[RunOutcome], fault: str
) -> dict[str, Any]:
    return {
        "schema": JSON_SCHEMA,
        "plan": str(job.plan.path),
        "folder": str(job.folder),
        "dry_run": request.dry_run,
        "planned": [one.name for one in job.runs],
        "findings": [asdict(one) for one in job.findings],
        "fault": fault or None,
        "runs": [asdict(one) for one in outcomes],
    }
