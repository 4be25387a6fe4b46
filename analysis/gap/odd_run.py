"""One run alone that is off: without it the others show no gap.

A gain or a zero that was off while one run was recorded looks like no effect: neither the free
numbers nor any law takes it up, and what comes of it is "unknown" or a false name.
"""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.gap.components import GapRun, Stack
from analysis.gap.fit import Problem
from analysis.gap.where import CHAIN, gap_of, left_by_step, step_of

Rows = NDArray[np.bool_]

_LEAST: Final = 10.0  # u: a weaker effect may hide in the others, where it is smaller still


@dataclass(frozen=True)
class OddRun:
    """A run that nothing but itself speaks for.

    Attributes
    ----------
    rms
        Root mean square of what it leaves, the free numbers fitted to the other runs, in u.
    """

    name: str
    rms: float


def odd_run(problem: Problem) -> OddRun | None:
    """Return the only run without which the others show no gap.

    ``None`` where there is no gap, or more runs are like that, or it shows by less than 10 u, or no
    other was made in the same medium at the same carriage speed: an effect that shows in one kind
    of run is no bad run.
    """
    stack = problem.simulator.stack
    if not _gap(problem, np.ones(len(stack.run), dtype=bool)):
        return None
    found = [
        number
        for number, run in enumerate(stack.runs)
        if run.turns and not _gap(problem, stack.run != number)
    ]
    if len(found) != 1 or not _has_like(stack.runs[found[0]], stack):
        return None
    rms = _left_alone(problem, stack.run == found[0])
    return OddRun(stack.runs[found[0]].name, rms) if rms > _LEAST else None


def _gap(problem: Problem, rows: Rows) -> bool:
    """Tell whether some runs by themselves show a gap at any step of the chain."""
    simulator = problem.simulator
    stack = Stack.of([simulator.stack.runs[at] for at in np.unique(simulator.stack.run[rows])])
    among = replace(
        problem,
        simulator=replace(simulator, stack=stack),
        nuisances=problem.nuisances.among(rows),
    )
    left = left_by_step(among, problem.residual[rows])
    steps = np.array([step_of(one) for one in stack.components])
    return any(gap_of(stack, left, what, steps == what).beyond for what in CHAIN)


def _has_like(run: GapRun, stack: Stack) -> bool:
    """Tell whether another run was made in the same medium at the same carriage speed."""
    return any(
        one is not run
        and one.set_point.medium is run.set_point.medium
        and one.set_point.carriage_speed_m_s == run.set_point.carriage_speed_m_s
        for one in stack.turning
    )


def _left_alone(problem: Problem, own: Rows) -> float:
    """Return what a run leaves where the free numbers are fitted to the others."""
    columns, residual = problem.nuisances.columns, problem.residual
    fitted = problem.nuisances.among(~own).fitted(residual[~own])
    return float(np.sqrt(np.mean((residual[own] - columns[own] @ fitted) ** 2)))
