"""The course of a campaign that chooses its runs: look, show, ask, plan, make the next run.

The campaign's folder is all the state there is: recordings, plan, and what was decided. Whoever was
interrupted goes on from it.
"""

from collections.abc import Callable, Generator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, Protocol

from pmm.run.operator import Answers
from pmm.run.session import Course, RunJob
from pmm.sequential.approval import Approval
from pmm.sequential.look import Decision, Ending, Look, keep_decision

_FIRST: Final = "Approve of these runs? y: yes, n: no, and end"
_CHANGE: Final = "Approve of these runs? y: yes, k: keep the plan as it was, n: no, and end"
_BY_OPERATOR: Final = "the operator"


class CampaignGoal(Protocol):
    """What a campaign is made for."""

    def look(self) -> Look:
        """Return what is known and what is to be made, from what the folder holds."""

    def plan(self, look: Look) -> Sequence[str]:
        """Write the plan as it was decided; return the names of the runs to be made now."""


@dataclass
class CampaignCourse:
    """Tells what follows, run after run.

    Attributes
    ----------
    show
        Shows what is known and what is proposed.
    open_job
        Checks the folder's plan as any other and makes a job of some of its runs.
    executor
        Where a look is taken while the rig is watched; ``None`` for at once.
    ended
        What was decided last; ``None`` as long as the campaign goes on.
    """

    goal: CampaignGoal
    folder: Path
    approval: Approval
    answers: Answers
    show: Callable[[Look], None]
    open_job: Callable[[Sequence[str]], RunJob]
    executor: Executor | None = None
    ended: Decision | None = None

    def jobs(self) -> Course:
        """Yield what is to be made next, and nothing as long as that is not known.

        Raises
        ------
        ConfigurationError, PlanRefusedError
            If a file is wrong, or the rig refuses a run; nothing is made of it then.
        """
        question = self.approval.question
        if question and (yield from self._asked(question, "yn")) == "n":
            return
        self.approval.begin()
        while True:
            look = yield from self._looked()
            self.show(look)
            look, who = yield from self._decided(look)
            decision = look.decision(who)
            keep_decision(self.folder, decision)
            due = () if look.ending is Ending.REJECTED else self.goal.plan(look)
            if not due:
                self.ended = decision
                return
            yield self.open_job(due)

    def _looked(self) -> Generator[None, None, Look]:
        if self.executor is None:
            return self.goal.look()
        future = self.executor.submit(self.goal.look)
        while not future.done():
            yield None
        return future.result()

    def _decided(self, look: Look) -> Generator[None, None, tuple[Look, str]]:
        """Return what is decided on what is proposed, and by whom."""
        if not look.proposed:
            return look, ""
        if self.approval.covers(look.proposed):
            return look, self.approval.name
        question = _CHANGE if look.before else _FIRST
        answer = yield from self._asked(question, "ykn" if look.before else "yn")
        decided = {"y": look, "k": look.as_before, "n": replace(look, ending=Ending.REJECTED)}
        return decided[answer], _BY_OPERATOR

    def _asked(self, question: str, letters: str) -> Generator[None, None, str]:
        """Return what the operator answers: one of some letters, asked until it is one."""
        while True:
            answer = self.answers(question)
            if answer is None:
                yield None
            elif answer[:1].lower() in tuple(letters):
                return answer[0].lower()
