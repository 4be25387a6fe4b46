"""A set of causes fitted with releases and tolerances as they act where the causes do.

Everything that is free is linear in a diagnosis, about the simulation as it is stated. Where a
cause is large that is not good enough for its size: how a swing that starts a little further goes
on depends on the damping, too.
"""

from dataclasses import dataclass, replace

import numpy as np

from analysis.gap.pendulum.problem import PendulumProblem
from analysis.gap.pendulum.search import fit
from analysis.gap.search.fit import Fit
from hardware.description.errors import PmmError

_ROUNDS = 3


@dataclass(frozen=True, eq=False)
class Settled:
    """A set of causes, and the problem that is linear about it."""

    problem: PendulumProblem
    best: Fit


def settle(problem: PendulumProblem, best: Fit) -> Settled:
    """Fit a set again about itself; as it is where the body would not swing back there."""
    settled = Settled(problem, best)
    for _ in range(_ROUNDS if best.candidates else 0):
        try:
            about = _linearised_problem(settled)
            settled = Settled(about, fit(about, best.candidates, settled.best.units))
        except PmmError:
            break
    return settled


def _linearised_problem(settled: Settled) -> PendulumProblem:
    problem, best = settled.problem, settled.best
    free = problem.nuisances.fitted(problem.residual - best.signature)
    first = np.cumsum([0, *(trial.release_columns for trial in problem.trials)])
    trials = tuple(
        trial if trial.driven else trial.as_released(float(free[at]), float(free[at + 1]))
        for trial, at in zip(problem.trials, first, strict=False)
    )
    return replace(problem, trials=trials, present_effects=best.effects)
