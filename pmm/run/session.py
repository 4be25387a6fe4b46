"""A plan's runs carried out on its rig: the job, the loop, and the campaign that is written."""

import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, Future
from contextlib import AbstractContextManager, ExitStack, contextmanager, nullcontext, suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Final

from hardware.description.errors import DataError
from hardware.description.version import program
from hardware.driver import Prompt
from hardware.pacing import FreeRunning, Pacer, RealTime
from hardware.rig import Rig
from hardware.wall_clock import utc_now
from pmm.plan.campaign_writer import write_campaign
from pmm.plan.checks import require_possible
from pmm.plan.findings import PlanFinding
from pmm.plan.plan import Plan, read_plan_and_rig
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan
from pmm.real_time import LoopScheduling, before_others, thread_beside
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
from pmm.run.operator import Interrupts, OperatorAnswers
from pmm.run.recorder_factory import RecorderFactory, plan_provenance
from pmm.run.rehearsal import rehearse
from pmm.run.run_control import RunControl
from pmm.run.run_origin import change_lines
from pmm.run.states import Command, RunStateError, State
from pmm.run.status import RunOutcome
from pmm.run.view import View

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


Course = Iterator[RunJob | None]
"""What follows when the runs of a job are made; ``None`` as long as that is not known."""
_NOTHING_FOLLOWS: Final[Course] = iter(())


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


def keep_time(stack: ExitStack) -> LoopScheduling:
    """Put the loop, and what it starts from here on, before all that could make its cycles late."""
    rehearse()
    return stack.enter_context(before_others())


def carry_out(
    job: RunJob,
    view: Callable[[Ask], AbstractContextManager[View[RunControl]]],
    tell: Callable[[str], object],
    answers: OperatorAnswers,
    course: Course = _NOTHING_FOLLOWS,
) -> RunReport:
    """Run the loop until all runs are made, Ctrl-C ends it, or a fault does.

    Parameters
    ----------
    view
        Makes what shows the runs.
    tell
        Says what is to be known besides.
    answers
        The operator's; nobody else reads them meanwhile.
    course
        What follows each time that all runs are made and the rig is at rest.

    Raises
    ------
    RunFailedError
        If a question is asked that nobody can answer.
    """
    keep_sources(job.plan, job.rig_file, job.folder)
    interrupts, jobs = Interrupts(), [job]
    with ExitStack() as stack:
        stack.enter_context(interrupts.counted())
        # At the end, when the rig is left; a failure is heard here.
        stack.callback(lambda: write_made(jobs[-1]))
        shown = stack.enter_context(view(lambda: answers.question))
        taps = Taps()
        rig = stack.enter_context(tapped_rig(job.rig_file, _pacer(job), answers, taps))
        executor = stack.enter_context(thread_beside("closing", keeps_time=job.real_time))
        provenance = {"program": program(), **plan_provenance(job.plan)}
        recording = stack.enter_context(
            RecorderFactory(rig, job.rig_file, job.plan, job.folder, utc_now, taps, provenance)
        )
        control = RunControl(
            rig, job.rig_file, job.runs, recording.begin, time.monotonic, shown, executor
        )
        control.free_bytes = recording.free_bytes
        rig.prepare()
        for note in rig.notes:
            tell(f"note: {note}")
        loop = _Loop(control, rig, answers, interrupts, executor)
        control.request(Command.START)
        loop.make(job)
        while (following := loop.following(course)) is not None:
            jobs.append(following)
            recording.plan = following.plan
            control.replan((*control.runs, *following.runs))
            loop.make(following)
        fault = "" if control.fault is None else str(control.fault)
        return RunReport(control.outcomes, interrupts.count > 0, fault)


@dataclass
class _Loop:
    """Steps a rig through its jobs, and at rest until it is known what follows.

    Attributes
    ----------
    executor
        Where the campaign's file is written; ``None`` for at once.
    """

    control: RunControl
    rig: Rig
    answers: OperatorAnswers
    interrupts: Interrupts
    executor: Executor | None
    _written: int = 0
    _writing: Future[None] | None = None

    def make(self, job: RunJob) -> None:
        """Step until nothing more happens, and write the campaign's file after each run."""
        while not self.control.finished:
            self.answers.question = ""
            self._step()
            if len(self.control.outcomes) > self._written:
                self._written = len(self.control.outcomes)
                self._write(job)

    def following(self, course: Course) -> RunJob | None:
        """Step at rest until the course says what follows; ``None`` where nothing does."""
        while self._writing is not None and not self._writing.done():
            self._step()
        if not self._goes_on():
            return None
        for job in course:
            if job is not None:
                return job
            self._require_answers()  # to what the course asks: no simulated operator does
            self._step()
            if not self._goes_on():
                return None
            self.answers.question = ""
        return None

    def _goes_on(self) -> bool:
        """Whether nobody has stopped, and there is no fault."""
        return self.control.state is State.DONE

    def _step(self) -> None:
        """Step a cycle; hand Ctrl-C on, once and twice; stop where nobody can answer."""
        attended = self.rig.master is not None and self.rig.master.operator is not None
        self.control.step()
        self.interrupts.hand_on(self.control.request)
        if not attended:
            self._require_answers()

    def _require_answers(self) -> None:
        """Stop where a question is open that nobody can answer."""
        if self.answers.absent and self.answers.question:
            with suppress(RunStateError):
                self.control.request(Command.STOP)
            raise RunFailedError(f"nobody answers: {self.answers.question}; the input has ended")

    def _write(self, job: RunJob) -> None:
        if self.executor is None:
            write_made(job)
        else:
            self._writing = self.executor.submit(write_made, job)


def write_made(job: RunJob) -> None:
    """Write the campaign file of the runs that were made so far."""
    runs = finished_runs(job.folder, job.plan, job.rig_file)
    write_campaign(job.folder, job.plan, job.rig_file, runs)


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
