"""A checked plan that waits, and how it goes from server to loop: in pieces, between cycles."""

import pickle
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from pmm.plan.plan import Plan
from pmm.plan.run_plan import RunPlan

_PIECE: Final = 50  # runs: 2 ms
_PAUSE_S: Final = 5e-4  # between pieces: the loop's thread goes first


@dataclass(frozen=True)
class QueuedPlan:
    """A checked plan that waits for its turn.

    Attributes
    ----------
    number
        Of the queue's entries, never used twice; 0 until it is one.
    folder
        Where it is recorded.
    runs
        Those that are to be made: what the folder holds complete is left out.
    chooses
        Whether it is a design, whose runs are chosen one after the other.
    held_runs
        Names of runs that are passed over until they are released.
    """

    number: int
    plan: Plan
    folder: Path
    runs: tuple[RunPlan, ...]
    chooses: bool = False
    held_runs: frozenset[str] = frozenset()

    @property
    def ready(self) -> bool:
        """Whether any of its runs may be made: not all are held."""
        return self.chooses or any(run.name not in self.held_runs for run in self.runs)


@dataclass(frozen=True)
class PackedPlan:
    """A queued plan on its way: ``bare`` has none of its runs, which are in the pieces."""

    bare: QueuedPlan
    pieces: tuple[bytes, ...]

    def numbered(self, number: int) -> "PackedPlan":
        """Return it with a number of the queue's."""
        return replace(self, bare=replace(self.bare, number=number))


def pack(plan: QueuedPlan) -> PackedPlan:
    """Return a plan with its runs pickled apart, so many that the loop never waits long."""
    wanted = {run.name for run in plan.runs}
    runs = [(run, run.name in wanted) for run in plan.plan.runs]
    pieces = tuple(pickle.dumps(runs[k : k + _PIECE]) for k in range(0, len(runs), _PIECE))
    return PackedPlan(replace(plan, plan=replace(plan.plan, runs=()), runs=()), pieces)


def unpack(packed: PackedPlan) -> QueuedPlan:
    """Return the plan again; it lets other threads run between the pieces."""
    runs = []
    for piece in packed.pieces:
        runs += pickle.loads(piece)  # noqa: S301 - from the console's own process
        time.sleep(_PAUSE_S)
    plan = replace(packed.bare.plan, runs=tuple(run for run, _ in runs))
    return replace(packed.bare, plan=plan, runs=tuple(run for run, wanted in runs if wanted))
