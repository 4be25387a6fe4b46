"""A plan on its way to the loop, in pieces.

Unpickling holds the interpreter from beginning to end: 10000 runs at once take half a second, and
the loop's heartbeat is missed. So they come in pieces of a few milliseconds.
"""

import pickle
import time
from dataclasses import replace
from typing import Final

from pmm.console.messages import PackedPlan, QueuedPlan

_PIECE: Final = 50  # runs: 2 ms
_PAUSE_S: Final = 5e-4  # between pieces: the loop's thread goes first


def pack(plan: QueuedPlan) -> PackedPlan:
    """Return a plan in pieces."""
    wanted = {one.name for one in plan.runs}
    runs = [(one, one.name in wanted) for one in plan.plan.runs]
    pieces = tuple(pickle.dumps(runs[k : k + _PIECE]) for k in range(0, len(runs), _PIECE))
    return PackedPlan(plan.number, replace(plan.plan, runs=()), plan.folder, pieces)


def unpack(packed: PackedPlan) -> QueuedPlan:
    """Return the plan again; it lets other threads run between the pieces."""
    runs = []
    for piece in packed.pieces:
        runs += pickle.loads(piece)  # noqa: S301 - from the console's own process
        time.sleep(_PAUSE_S)
    plan = replace(packed.plan, runs=tuple(one for one, _ in runs))
    chosen = tuple(one for one, wanted in runs if wanted)
    return QueuedPlan(packed.number, plan, packed.folder, chosen)
