"""The plan that is carried out and those that wait, as the loop has them."""

from collections.abc import Collection
from dataclasses import dataclass, field, replace
from pathlib import Path

from pmm.console.limits import MOST_WAITING
from pmm.console.queued_plan import QueuedPlan
from pmm.run.planned_runs import UNCHANGED
from pmm.run.states import RunStateError


@dataclass
class PlansInHand:
    """The plan that is carried out, and those that wait for their turn."""

    present: QueuedPlan | None = None
    waiting: list[QueuedPlan] = field(default_factory=list)
    _completed: dict[tuple[Path, str], int] = field(default_factory=dict)

    @property
    def number(self) -> int:
        """Number of the plan that is carried out; 0 for none."""
        return 0 if self.present is None else self.present.number

    @property
    def ready(self) -> bool:
        """Whether a plan that waits has runs that are not held."""
        return any(plan.ready for plan in self.waiting)

    def take_next(self, ended: Collection[str]) -> QueuedPlan:
        """Make the first plan that is ready the present one, and return it.

        The one before waits again, before all others, where it has runs that are held.

        Parameters
        ----------
        ended
            Names of the present plan's runs that have ended.
        """
        before = self.present
        now = self.present = next(plan for plan in self.waiting if plan.ready)
        self.waiting.remove(now)
        if before is not None and not before.chooses:
            held = tuple(run for run in before.runs if run.name not in ended)
            self.waiting[:0] = [replace(before, runs=held)] if held else []
        return now

    def waits(self, number: int) -> QueuedPlan:
        """Return a plan that waits.

        Raises
        ------
        RunStateError
            If none of that number does.
        """
        plans = [plan for plan in self.waiting if plan.number == number]
        if not plans:
            raise RunStateError(f"no plan {number} waits")
        return plans[0]

    def accepted(self, plan: QueuedPlan, frame: int) -> QueuedPlan:
        """Return a plan that may wait, without the runs completed since its folder was looked at.

        Parameters
        ----------
        frame
            Number of the last frame before the look.

        Raises
        ------
        RunStateError
            If none of its runs is left, or as many plans wait as may.
        """
        plan = replace(
            plan,
            runs=tuple(
                run for run in plan.runs if self._completed.get((plan.folder, run.name), 0) <= frame
            ),
        )
        if not plan.runs and not plan.chooses:
            raise RunStateError(f"{plan.plan.name}: all its runs are complete in {plan.folder}")
        if len(self.waiting) >= MOST_WAITING:
            raise RunStateError(
                f"{MOST_WAITING} plans wait already, which is the limit; take one out, or queue "
                f"{plan.plan.name} when the next of them has begun"
            )
        return plan

    def complete(self, run: str, frame: int) -> list[QueuedPlan]:
        """Leave a run that the present plan has completed out of those that wait for its folder.

        Parameters
        ----------
        frame
            Number of the first frame after it.

        Returns
        -------
            The plans of which no run is left; they wait no more.
        """
        if self.present is None:
            return []
        folder, before = self.present.folder, self.waiting
        self._completed[folder, run] = frame
        now = [
            replace(plan, runs=tuple(one for one in plan.runs if one.name != run))
            if plan.folder == folder
            else plan
            for plan in before
        ]
        self.waiting[:] = [plan for plan in now if plan.chooses or plan.runs]
        return [plan for plan in now if not (plan.chooses or plan.runs)]

    def drop(self, number: int) -> QueuedPlan:
        """Take a plan that waits out, and return it."""
        plan = self.waits(number)
        self.waiting.remove(plan)
        return plan

    def move(self, number: int, by: int) -> QueuedPlan:
        """Let a plan that waits have its turn later by so many places, earlier where negative."""
        plan = self.waits(number)
        place = self.waiting.index(plan)
        self.drop(number)
        self.waiting.insert(max(0, place + by), plan)
        return plan

    def change(self, plan: QueuedPlan) -> QueuedPlan:
        """Take a plan as it is from now on, and return it without the runs that were left out.

        Those had ended when the plan had its turn before.

        Raises
        ------
        RunStateError
            If nothing of it changes, or there is no such plan.
        """
        present = self.present
        is_present = present is not None and present.number == plan.number
        before = present if is_present and present is not None else self.waits(plan.number)
        names = {run.name for run in before.runs}
        now = replace(plan, runs=tuple(run for run in plan.runs if run.name in names))
        if (now.runs, now.held_runs) == (before.runs, before.held_runs):
            raise RunStateError(UNCHANGED)
        if is_present:
            self.present = now
        else:
            self.waiting[self.waiting.index(before)] = now
        return now
