"""The course of a campaign that chooses its runs: look, show, ask, plan, make the next run.

The campaign's folder is all the state there is: recordings, plan, and what was decided. Whoever was
interrupted goes on from it.
"""

import re
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Final, Generic, Protocol, TypeVar

from pmm.sequential.approval import Approval
from pmm.sequential.look import Decision, Ending, Look, keep_decision

_YES: Final = "Approve of these runs? y: yes (y 3 1: these alone, in this order)"
_FIRST: Final = f"{_YES}, n: no, and end"
_CHANGE: Final = f"{_YES}, k: keep the plan as it was, n: no, and end"
_BY_OPERATOR: Final = "the operator"
_APPROVED: Final = re.compile(r"y(?:es)?((?:[\s,]+\d{1,6})*)")
T = TypeVar("T")
JobT = TypeVar("JobT")


class CampaignGoal(Protocol):
    """What a campaign is made for."""

    def look(self) -> Look:
        """Return what is known and what is to be made, from what the folder holds."""

    def plan(self, look: Look) -> Sequence[str]:
        """Write the plan as it was decided; return the names of the runs to be made now."""


@dataclass
class CampaignCourse(Generic[JobT]):
    """Tells what follows, run after run.

    Attributes
    ----------
    show
        Shows what is known and what is proposed.
    open_job
        Makes a job of some runs of the folder's plan, by their names.
    executor
        Where a look is taken and a plan written while the rig is watched; ``None`` for at once.
    ended
        What was decided last; ``None`` as long as the campaign goes on.
    """

    goal: CampaignGoal
    folder: Path
    approval: Approval
    answers: Callable[[str], str | None]
    show: Callable[[Look], None]
    open_job: Callable[[Sequence[str]], JobT]
    executor: Executor | None = None
    ended: Decision | None = None

    def jobs(self) -> Iterator[JobT | None]:
        """Yield what is to be made next, and nothing as long as that is not known.

        Raises
        ------
        ConfigurationError, PlanRefusedError
            If a file is wrong, or the rig refuses a run; nothing is made of it then.
        """
        question = self.approval.question
        if question and (yield from self._ask(question, "yn"))[0] == "n":
            return
        self.approval.begin()
        while True:
            look = yield from self._do_aside(self.goal.look)
            self.show(look)
            # As long as nobody has answered: whoever is interrupted here has seen this look.
            keep_decision(self.folder, look.decision())
            look, who = yield from self._decided(look)
            decision = look.decision(who)
            keep_decision(self.folder, decision)
            job: JobT | None = None
            if look.ending is not Ending.REJECTED:
                job = yield from self._do_aside(partial(self._following, look))
            if job is None:
                self.ended = decision
                return
            yield job

    def _following(self, look: Look) -> JobT | None:
        due = self.goal.plan(look)
        return self.open_job(due) if due else None

    def _do_aside(self, work: Callable[[], T]) -> Generator[None, None, T]:
        """Do what takes long, and yield nothing meanwhile."""
        if self.executor is None:
            return work()
        future = self.executor.submit(work)
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
        letters = "ykn" if look.before else "yn"
        while True:
            answer = yield from self._ask(question, letters)
            decided = _decided(look, answer)
            if decided is not None:
                return decided, _BY_OPERATOR

    def _ask(self, question: str, letters: str) -> Generator[None, None, str]:
        """Return what the operator answers, asked until it begins with one of some letters."""
        while True:
            answer = self.answers(question)
            if answer is None:
                yield None
            elif answer[:1].lower() in tuple(letters):
                return answer.lower()


def _decided(look: Look, answer: str) -> Look | None:
    """Return what an answer makes of a proposal; ``None`` where it cannot be read."""
    if answer[0] == "n":
        return replace(look, ending=Ending.REJECTED)
    if answer[0] == "k":
        return look.as_before
    approved = _APPROVED.fullmatch(answer)
    if approved is None:
        return None
    numbers = [int(number) for number in approved[1].replace(",", " ").split()]
    return look.chosen(numbers) if numbers else look
