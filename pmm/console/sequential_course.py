"""A campaign that chooses its runs, under the console: the course that ``pmm run --until`` takes.

What the terminal prints goes to the browsers, and the operator's answers come from there.
"""

from collections.abc import Callable, Generator
from concurrent.futures import Executor, Future
from contextlib import ExitStack
from dataclasses import replace
from typing import TYPE_CHECKING, Final, TypeVar

from pmm.console.answers import BrowserAnswers
from pmm.console.messages import CampaignLook
from pmm.console.queued_plan import QueuedPlan
from pmm.run.states import State
from pmm.sequential.look import Look

if TYPE_CHECKING:
    from pmm.run.session import RunJob
    from pmm.sequential.course import CampaignCourse

_AGAIN: Final = "The campaign was stopped. Go on with it? y: yes"
_BEGIN: Final = "Begin with the runs that are planned? y: yes"
_ENDED: Final = frozenset({State.STOPPED, State.IDLE})
T = TypeVar("T")


class ChoosingCampaign:
    """Says which runs follow, asked once a cycle while the rig is at rest.

    Parameters
    ----------
    plan
        The design as it was queued, with its number and folder.
    tell
        Takes what is known after a run.
    executor
        Where files are read and looks are taken: the loop waits for none of it.
    """

    def __init__(
        self,
        plan: QueuedPlan,
        answers: BrowserAnswers,
        tell: Callable[[CampaignLook], None],
        executor: Executor | None,
    ) -> None:
        self.plan = plan
        self._answers, self._tell, self._executor = answers, tell, executor
        self._stack, self._made = ExitStack(), False
        self._agreed = False  # somebody answered here: nothing moves by being queued alone
        self._next: QueuedPlan | None = None
        self._jobs = self._course()

    def following(self, state: State) -> QueuedPlan | None:
        """Return the runs that follow; ``None`` as long as that is not known.

        Raises
        ------
        StopIteration
            If nothing follows.
        PmmError
            If a file is wrong, or the rig refuses a run.
        """
        if self._made and state in _ENDED:
            if not self._confirms(_AGAIN):
                return None
            self._made = False
        if self._next is None:
            self._next = next(self._jobs)
        if self._next is None or not (self._agreed or self._confirms(_BEGIN)):
            return None
        self._agreed = True
        plan, self._next = self._next, None
        self._made = True
        return plan

    def _confirms(self, question: str) -> bool:
        return (self._answers(question) or "")[:1].lower() == "y"

    def _answered(self, question: str) -> str | None:
        answer = self._answers(question)
        self._agreed = self._agreed or answer is not None
        return answer

    def close(self) -> None:
        """Let go of the folder, once what is under way there is done."""
        self._jobs.close()
        if self._executor is None:
            self._stack.close()
        else:
            self._executor.submit(self._stack.close)

    def _course(self) -> Generator[QueuedPlan | None, None, None]:
        course = yield from self._do_aside(self._begin_course)
        for job in course.jobs():
            yield None if job is None else replace(self.plan, plan=job.plan, runs=job.runs)

    def _begin_course(self) -> "CampaignCourse[RunJob]":
        from pmm.design.design_file import read_design
        from pmm.gap.rig_pursuit import goal_of
        from pmm.sequential.execution import CampaignRequest, campaign_course

        file = read_design(self.plan.plan.path)
        asked = CampaignRequest(
            str(self.plan.folder), None, resume=True, accept_changes=False, real_time=True,
            check_folder=lambda _: None,
        )  # fmt: skip
        return self._stack.enter_context(
            campaign_course(file, goal_of, asked, self._answered, self._show, self._executor)
        )

    def _show(self, look: Look) -> None:
        self._tell(CampaignLook(self.plan.number, look))

    def _do_aside(self, work: Callable[[], T]) -> Generator[None, None, T]:
        if self._executor is None:
            return work()
        future: Future[T] = self._executor.submit(work)
        while not future.done():
            yield None
        return future.result()
