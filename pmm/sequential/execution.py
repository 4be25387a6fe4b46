"""A campaign that chooses its runs, carried out on its rig from beginning to end."""

import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from contextlib import AbstractContextManager, ExitStack, contextmanager
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Final, TypeVar

from hardware.description.errors import ConfigurationError
from pmm.coefficients.settings import SETTINGS_FILE
from pmm.design.design_file import DesignFile
from pmm.plan.campaign_writer import write_campaign
from pmm.plan.plan import read_plan_and_rig
from pmm.plan.rig_file import is_simulated
from pmm.real_time import thread_beside
from pmm.recorder.campaign_owner import own_campaign
from pmm.run.campaign_folder import finished_runs, keep_sources
from pmm.run.operator import OperatorAnswers
from pmm.run.run_control import RunControl
from pmm.run.session import Ask, RunFailedError, RunJob, RunReport, carry_out, run_job
from pmm.run.view import View
from pmm.sequential.approval import approval_of
from pmm.sequential.course import CampaignCourse, CampaignGoal
from pmm.sequential.growing_plan import PLAN
from pmm.sequential.look import Decision, Look
from pmm.toml_text import toml_table
from pmm.whole_file import write_whole

_POLL_S: Final = 0.02
JobT = TypeVar("JobT")
Goal = Callable[[DesignFile, Path], CampaignGoal]
"""Makes the goal of a design's campaign in its folder."""


@dataclass(frozen=True)
class CampaignRequest:
    """How a campaign is to be carried out.

    Attributes
    ----------
    approve
        What ``--approve`` says.
    check_folder
        Refuses a folder that cannot be written to.
    """

    output: str | None
    approve: str | None
    resume: bool
    accept_changes: bool
    real_time: bool
    check_folder: Callable[[Path], None]


@dataclass(frozen=True)
class Screen:
    """What shows a campaign: the loop, lines beside it, what is known after a run, a new job."""

    view: Callable[[Ask], AbstractContextManager[View[RunControl]]]
    tell: Callable[[str], object]
    show: Callable[[Look], None]
    job: Callable[[RunJob], None]


@dataclass(frozen=True)
class MadeCampaign:
    """A campaign as a command left it.

    Attributes
    ----------
    ended
        What was decided last; ``None`` where a fault or the operator ended it before.
    """

    folder: Path
    ended: Decision | None
    report: RunReport


def campaign_folder(asked: CampaignRequest, file: DesignFile) -> Path:
    """Return where a campaign is recorded: as of ``pmm run``."""
    if asked.output is not None:
        return Path(asked.output)
    return file.rig_path.parent / file.rig.recorder.folder / file.name


def carry_out_campaign(
    file: DesignFile, goal: Goal, asked: CampaignRequest, screen: Screen, answers: OperatorAnswers
) -> MadeCampaign:
    """Make run after run until the goal is reached, or nothing more is to be made.

    Raises
    ------
    ConfigurationError, PlanRefusedError
        If a file is wrong, the folder holds a campaign already and nobody asked to resume it, or
        the rig refuses a run.
    RunFailedError
        If a question is asked that nobody can answer.
    """
    with ExitStack() as stack:
        executor = stack.enter_context(
            thread_beside("looking", keeps_time=file.rig.realtime or asked.real_time)
        )
        course = stack.enter_context(
            campaign_course(file, goal, asked, answers, screen.show, executor)
        )
        jobs = _tell_jobs(course.jobs(), screen.job)
        first = next_job(jobs, answers, screen.tell)
        report = RunReport()
        if first is not None:
            report = carry_out(first, screen.view, screen.tell, answers, jobs)
        return MadeCampaign(course.folder, course.ended, report)


@contextmanager
def campaign_course(
    file: DesignFile,
    goal: Goal,
    asked: CampaignRequest,
    answers: Callable[[str], str | None],
    show: Callable[[Look], None],
    executor: Executor | None,
) -> Iterator[CampaignCourse[RunJob]]:
    """Own a campaign's folder, and give the course of its runs until its goal is reached.

    Parameters
    ----------
    answers
        Returns what the operator answers to a question, ``None`` as long as nobody does.
    show
        Takes what is known after a run.
    executor
        Where looks are taken; ``None`` for at once.

    Raises
    ------
    ConfigurationError
        If the design asks for what cannot be, or the folder holds a campaign already and nobody
        asked to resume it.
    OwnedElsewhereError
        If another process is writing into the folder.
    """
    folder = campaign_folder(asked, file)
    asked.check_folder(folder)
    if (folder / PLAN).exists() and not asked.resume:
        raise ConfigurationError(
            f"{folder}: holds a campaign already; --resume goes on with it, --output records to "
            "another folder"
        )
    approval = approval_of(asked.approve, simulated=is_simulated(file.rig.hardware))
    aim = goal(file, folder)
    with ExitStack() as stack:
        stack.enter_context(own_campaign(folder))
        _write_made(folder)
        _keep_stated(file, folder)
        opened = partial(_opened, asked, folder, stack)
        yield CampaignCourse(aim, folder, approval, answers, show, opened, executor)


def _write_made(folder: Path) -> None:
    """Write the campaign file of what is there: a crash may have left it behind its runs."""
    if (folder / PLAN).exists():
        plan, rig = read_plan_and_rig(folder / PLAN)
        write_campaign(folder, plan, rig, finished_runs(folder, plan, rig))


def _keep_stated(file: DesignFile, folder: Path) -> None:
    """Hand what the design states on to ``pmm coefficients``, unless somebody has said it there."""
    stated = {key: value for key, value in asdict(file.stated).items() if value}
    path = folder / SETTINGS_FILE
    if stated and not path.exists():
        write_whole(path, f"# As {file.path.name} states\n{toml_table('uncertainty', stated)}")


def _opened(asked: CampaignRequest, folder: Path, stack: ExitStack, names: Sequence[str]) -> RunJob:
    """Return a job of some runs of the folder's plan, checked as ``pmm run`` checks it."""
    job = stack.enter_context(
        run_job(
            str(folder / PLAN),
            names,
            lambda _: None,
            output=str(folder),
            resume=True,
            accept_changes=asked.accept_changes,
            dry_run=False,
            real_time=asked.real_time,
        )
    )
    keep_sources(job.plan, job.rig_file, folder)
    return job


def _tell_jobs(
    jobs: Iterator[RunJob | None], tell: Callable[[RunJob], None]
) -> Iterator[RunJob | None]:
    """Yield what follows, each job told first, in the thread that shows it."""
    for job in jobs:
        if job is not None:
            tell(job)
        yield job


def next_job(
    jobs: Iterator[JobT | None], answers: OperatorAnswers, tell: Callable[[str], object]
) -> JobT | None:
    """Return the next job, while no rig is open; ``None`` where nothing is to be made.

    Raises
    ------
    RunFailedError
        If a question is asked that nobody can answer.
    """
    asked = ""
    for job in jobs:
        if job is not None:
            return job
        if answers.question != asked:
            asked = answers.question
            tell(f"? {asked}")
        if answers.absent and asked:
            raise RunFailedError(f"nobody answers: {asked}; the input has ended")
        time.sleep(_POLL_S)
    return None
