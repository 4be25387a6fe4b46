"""A plan's runs carried out on its rig: the job, the loop, and the campaign that is written."""

import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import AbstractContextManager, ExitStack, contextmanager, nullcontext, suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import partial
from pathlib import Path

from hardware.description.errors import DataError
from hardware.description.version import program
from hardware.driver import Prompt
from hardware.pacing import FreeRunning, Pacer, RealTime
from hardware.rig import Rig
from pmm.plan.campaign_writer import write_campaign
from pmm.plan.checks import require_possible
from pmm.plan.findings import PlanFinding
from pmm.plan.plan import Plan, read_plan_and_rig
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan
from pmm.real_time import Standing, before_others, step_back
from pmm.recorder.campaign_owner import own_campaign
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
from pmm.run.recorder_factory import RecorderFactory, utc_now
from pmm.run.rehearsal import rehearse
from pmm.run.run_control import RunControl, View
from pmm.run.run_origin import change_lines
from pmm.run.states import Command, RunStateError
from pmm.run.status import RunOutcome

Ask = Callable[[], str]  # what the operator is asked now; empty if nothing


@dataclass(frozen=True)
class RunJob:
    """What is to be done.

    Attributes
    ----------
    findings
        Of the check of the plan, for these runs.
    changes
        What runs that are there were recorded with, where that has changed.
    """

    plan: Plan
    rig_file: RigFile
    folder: Path
    runs: tuple[RunPlan, ...]
    findings: tuple[PlanFinding, ...]
    real_time: bool
    changes: tuple[str, ...]


@dataclass(frozen=True)
class RunReport:
    """How the runs ended: each, whether Ctrl-C ended them, and the fault in words."""

    outcomes: Sequence[RunOutcome] = ()
    interrupted: bool = False
    fault: str = ""


class RunFailedError(DataError):
    """A run ended in a fault; the message names its cause."""


@contextmanager
def run_job(
    path: str,
    only: Sequence[str],
    check_folder: Callable[[Path], None],
    *,
    output: str | None,
    resume: bool,
    accept_changes: bool,
    dry_run: bool,
    real_time: bool,
) -> Iterator[RunJob]:
    """Say what is to be done; the folder is owned from before it is read, but for a dry run.

    Parameters
    ----------
    only
        Names of the runs to make; all if none.
    check_folder
        Refuses a folder that cannot be written to.

    Raises
    ------
    ConfigurationError, PlanRefusedError
        If plan or rig are wrong or beyond a limit, or the folder holds runs already.
    OwnedElsewhereError
        If another process is writing into the folder.
    """
    plan, rig_file = read_plan_and_rig(path)
    findings = require_possible(plan, rig_file, datetime.now(UTC).date())
    folder = folder_of(plan, rig_file.recorder.folder, output)
    check_names(plan, only)
    check_folder(folder)
    with nullcontext() if dry_run else own_campaign(folder) as owned:
        if owned is not None:
            owned.count()  # now, and not in the loop
        runs = chosen_runs(
            plan, rig_file, folder, only, resume=resume, accept_changes=accept_changes
        )
        chosen = {"", *(run.name for run in runs)}
        findings = tuple(finding for finding in findings if finding.run in chosen)
        changes = tuple(change_lines(kept_runs(plan, rig_file, folder, runs)))
        real_time = rig_file.realtime or real_time
        yield RunJob(plan, rig_file, folder, runs, findings, real_time, changes)


def keep_time(stack: ExitStack) -> Standing:
    """Put the loop, and what it starts from here on, before all that could make its cycles late."""
    rehearse()
    return stack.enter_context(before_others())


def carry_out(
    job: RunJob,
    view: Callable[[Ask], AbstractContextManager[View]],
    tell: Callable[[str], object],
) -> RunReport:
    """Run the loop until all runs are made, Ctrl-C ends it, or a fault does.

    Parameters
    ----------
    view
        Makes what shows the runs.
    tell
        Says what is to be known besides.

    Raises
    ------
    RunFailedError
        If a question is asked that nobody can answer.
    """
    keep_sources(job.plan, job.rig_file, job.folder)
    answers, interrupts = standard_input(), Interrupts()
    with ExitStack() as stack:
        stack.enter_context(interrupts.counted())
        stack.callback(_write, job)  # at the end, when the rig is left; a failure is heard here
        shown = stack.enter_context(view(lambda: answers.question))
        taps = Taps()
        rig = stack.enter_context(tapped_rig(job.rig_file, _pacer(job), answers, taps))
        executor = stack.enter_context(_executor(job.real_time))
        recording = stack.enter_context(
            RecorderFactory(
                rig, job.rig_file, job.plan, job.folder, utc_now, taps, _provenance(job)
            )
        )
        control = RunControl(
            rig, job.rig_file, job.runs, recording.begin, time.monotonic, shown, executor
        )
        control.free_bytes = recording.free_bytes
        rig.prepare()
        for note in rig.notes:
            tell(f"note: {note}")
        control.request(Command.START)
        write = partial(_write, job) if executor is None else partial(executor.submit, _write, job)
        _loop(control, rig, answers, interrupts, write)
        fault = "" if control.fault is None else str(control.fault)
        return RunReport(control.outcomes, interrupts.count > 0, fault)


def _loop(
    control: RunControl,
    rig: Rig,
    answers: Answers,
    interrupts: Interrupts,
    write: Callable[[], object],
) -> None:
    """Step until nothing more happens; hand Ctrl-C on, once and twice."""
    written = 0
    attended = rig.master is not None and rig.master.operator is not None
    while not control.finished:
        answers.question = ""
        control.step()
        interrupts.hand_on(control.request)
        if answers.absent and answers.question and not attended:
            with suppress(RunStateError):
                control.request(Command.STOP)
            raise RunFailedError(f"nobody answers: {answers.question}; the input has ended")
        if len(control.outcomes) > written:
            written = len(control.outcomes)
            write()


def _write(job: RunJob) -> None:
    done = finished_runs(job.folder, job.plan, job.rig_file)
    write_campaign(job.folder, job.plan, job.rig_file, done)


def tapped_rig(rig_file: RigFile, pacer: Pacer, prompt: Prompt, taps: Taps) -> Rig:
    """Return a rig whose frames and lines are heard by the taps; it is open within ``with``."""
    return Rig(
        rig_file.hardware,
        time.monotonic,
        pacer,
        prompt,
        observers=(taps.frame,),
        line_observers=(taps.line,),
    )


def _pacer(job: RunJob) -> Pacer:
    if not job.real_time:
        return FreeRunning()
    return RealTime(1.0 / job.rig_file.sample_rate_hz, time.monotonic, time.sleep)


@contextmanager
def _executor(real_time: bool) -> Iterator[Executor | None]:
    """Give a thread to complete recordings in; in simulated time the loop may as well wait."""
    if not real_time:
        yield None
        return
    with ThreadPoolExecutor(1, thread_name_prefix="closing", initializer=step_back) as executor:
        yield executor


def _provenance(job: RunJob) -> dict[str, str]:
    operator = {"operator": job.plan.operator} if job.plan.operator else {}
    return {"program": program(), "plan": job.plan.name, **operator}
