"""One run alone that is off: without it the others show no gap, or none that an effect leaves.

A gain or a zero that was off while one run was recorded looks like no effect: neither the free
numbers nor any law takes it up, and what comes of it is "unknown" or a false name.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from analysis.gap.components import GapRun, Stack
from analysis.gap.fit import Fit, Problem, at, expected_evidence, most_probable, weighed_at
from analysis.gap.where import CHAIN, gap_of, left_by_step, step_of
from hardware.description.arrays import BoolArray, FloatArray
from hardware.description.errors import PmmError

Rows = BoolArray

_LEAST: Final = 10.0  # u: a weaker effect may hide in the others, where it is smaller still
_ROUNDS: Final = 3  # of fitting the effect that the others may have


@dataclass(frozen=True)
class OddRun:
    """A run that nothing but itself speaks for.

    Attributes
    ----------
    rms
        Root mean square of what it leaves where all is fitted to the other runs, in u.
    beside
        The effect that the others have; empty where they show no gap.
    """

    name: str
    rms: float
    beside: tuple[str, ...] = ()


def odd_run(problem: Problem, fits: Sequence[Fit] = ()) -> OddRun | None:
    """Return the only run without which the others show no gap, or leave none to an effect.

    ``None`` where there is no gap, or more runs are like that, or it shows by less than 10 u, or no
    other was made in the same medium at the same carriage speed, at rest or not as it is: an effect
    that shows in one kind of run is no bad run.

    Parameters
    ----------
    fits
        Effects that the others may have, as they are fitted to all runs.
    """
    if not _shows(problem, problem.residual):
        return None
    return _alone(problem) or _beside(problem, fits)


def _alone(problem: Problem) -> OddRun | None:
    stack = problem.simulator.stack
    found = [
        number
        for number in range(len(stack.runs))
        if not _shows(_among(problem, stack.run != number), problem.residual[stack.run != number])
    ]
    return _odd(problem, found[0], problem.residual, ()) if len(found) == 1 else None


def _beside(problem: Problem, fits: Sequence[Fit]) -> OddRun | None:
    """Return the run without which one effect explains all others, if it is the only one."""
    stack, found = problem.simulator.stack, []
    for number in range(len(stack.runs)):
        fit = _explaining(problem, stack.run != number, fits)
        if fit is not None:
            found.append((number, fit))
    if len(found) != 1:
        return None
    number, fit = found[0]
    change = problem.simulator.predict(fit.effects) - problem.simulator.nominal
    return _odd(problem, number, problem.residual - problem.whitened(change), fit.names)


def _explaining(problem: Problem, rows: Rows, fits: Sequence[Fit]) -> Fit | None:
    """Return the likeliest effect among some runs; ``None`` where it leaves a gap there."""
    among = _among(problem, rows)
    ones = [
        weighed_at(among, one.candidates, one.units, one.columns[rows], one.signature[rows])
        for one in fits
    ]
    if not ones:
        return None
    best = max(ones, key=lambda one: expected_evidence(among, one))
    return _refined(among, best)


def _refined(problem: Problem, fit: Fit) -> Fit | None:
    """Return a fit of an effect; ``None`` where it leaves a gap."""
    try:
        for _ in range(_ROUNDS):
            fit = at(problem, fit.candidates, most_probable(fit))
    except PmmError:
        return None
    return None if _shows(problem, problem.residual - fit.signature) else fit


def _among(problem: Problem, rows: Rows) -> Problem:
    """Return the problem of some runs."""
    return replace(
        problem,
        simulator=problem.simulator.among(np.unique(problem.simulator.stack.run[rows])),
        nuisances=problem.nuisances.among(rows),
    )


def _shows(problem: Problem, residual: FloatArray) -> bool:
    """Tell whether a difference is a gap at any step of the chain."""
    stack = problem.simulator.stack
    left = left_by_step(problem, residual)
    steps = np.array([step_of(one) for one in stack.components])
    return any(gap_of(stack, left, what, steps == what).beyond for what in CHAIN)


def _odd(
    problem: Problem, number: int, residual: FloatArray, beside: tuple[str, ...]
) -> OddRun | None:
    stack = problem.simulator.stack
    run = stack.runs[number]
    rms = _left_alone(problem, stack.run == number, residual)
    return OddRun(run.name, rms, beside) if rms > _LEAST and _has_like(run, stack) else None


def _has_like(run: GapRun, stack: Stack) -> bool:
    """Tell whether another run was made in the same medium at the same carriage speed."""
    return any(
        one is not run
        and one.turns is run.turns
        and one.set_point.medium is run.set_point.medium
        and one.set_point.carriage_speed_m_s == run.set_point.carriage_speed_m_s
        for one in stack.runs
    )


def _left_alone(problem: Problem, own: Rows, residual: FloatArray) -> float:
    """Return what a run leaves where the free numbers are fitted to the others."""
    columns = problem.nuisances.columns
    fitted = problem.nuisances.among(~own).fitted(residual[~own])
    return float(np.sqrt(np.mean((residual[own] - columns[own] @ fitted) ** 2)))
