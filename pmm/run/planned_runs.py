"""The runs of a plan under run control: begun, to be made in their order, or held."""

from collections.abc import Callable, Collection, Sequence
from typing import Final

from pmm.plan.run_plan import RunPlan
from pmm.run.states import RunStateError

UNCHANGED: Final = "nothing changes; runs that have begun stay as they are"


class PlannedRuns:
    """Knows which run is the next.

    Parameters
    ----------
    ended
        Whether a run has ended, however.

    Attributes
    ----------
    runs
        All of them, in order.
    held_runs
        Names of the runs that are passed over until they are released.
    """

    def __init__(self, runs: Sequence[RunPlan], ended: Callable[[RunPlan], bool]) -> None:
        self._ended = ended
        self.held_runs: frozenset[str] = frozenset()
        self._set(tuple(runs))

    @property
    def runs_left(self) -> list[RunPlan]:
        """Runs that are under way or still to be made, and not held."""
        return [run for run in self.runs if run.name not in self.held_runs and not self._ended(run)]

    def number(self, run: RunPlan) -> int:
        """Return the place of a run, from 1."""
        return self._numbers[run.name]

    def replan(
        self, runs: Sequence[RunPlan], held: Collection[str], under_way: RunPlan | None
    ) -> None:
        """Take other runs than those that are still to be made; what has begun stays before them.

        Raises
        ------
        RunStateError
            If one that has begun would be another, or nothing changes.
        """
        begun = {run.name: run for run in self.runs if run == under_way or self._ended(run)}
        for run in runs:
            if begun.get(run.name, run) != run:
                raise RunStateError(f"{run.name} has begun; only runs still to be made are changed")
        planned = (*begun.values(), *(run for run in runs if run.name not in begun))
        passed = frozenset(held) - set(begun)
        if (planned, passed) == (self.runs, self.held_runs):
            raise RunStateError(UNCHANGED)
        self.held_runs = passed
        self._set(planned)

    def _set(self, runs: tuple[RunPlan, ...]) -> None:
        self.runs = runs
        self._numbers = {run.name: number for number, run in enumerate(runs, 1)}
