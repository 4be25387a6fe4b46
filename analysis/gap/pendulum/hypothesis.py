"""One set of causes, fitted through the simulator, with its evidence."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from analysis.gap.gaussian import Posterior, misfit, posterior
from analysis.gap.pendulum.causes import Cause
from analysis.gap.pendulum.problem import Problem
from analysis.gap.pendulum.trial import Trial
from hardware.description.arrays import FloatArray
from hardware.description.errors import PmmError
from sim.pendulum.effects.base import PendulumEffect

_STEPS = 8
_SETTLED = 0.02  # change of the cost at which a fit ends
_STEP = 0.05  # of a prior deviation, for slopes


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """Causes with fitted parameters; none at all is the null.

    Attributes
    ----------
    units
        All parameters in units of their priors, shape ``(p,)``.
    signature
        What the causes change of the observations, in sigma, shape ``(observations,)``.
    columns
        Their slopes there, shape ``(observations, p)``.
    cost
        Chi-square that is left, nuisances fitted too, and that of the priors.
    log_evidence
        By Laplace, but for a constant that all hypotheses of a problem share.
    """

    causes: tuple[Cause, ...]
    units: FloatArray
    signature: FloatArray
    columns: FloatArray
    posterior: Posterior
    cost: float
    log_evidence: float

    @property
    def names(self) -> tuple[str, ...]:
        """The causes' names, in alphabetical order."""
        return tuple(sorted(one.name for one in self.causes))

    def effects(self, trial: Trial) -> tuple[PendulumEffect, ...]:
        """Return the fitted effects on a trial."""
        return effects_at(self.causes, self.units, trial)

    def without_signature(self, problem: Problem) -> FloatArray:
        """Return what the causes leave of the gap, in sigma, nuisances still in it."""
        return problem.residual - self.signature


def effects_at(
    causes: Sequence[Cause], units: FloatArray, trial: Trial
) -> tuple[PendulumEffect, ...]:
    """Return the effects at some parameters on a trial."""
    if not causes:
        return ()
    cuts = np.cumsum([len(one.axes) for one in causes])[:-1]
    pieces = np.split(units, cuts)
    return tuple(one.effect(piece, trial) for one, piece in zip(causes, pieces, strict=True))


def null(problem: Problem) -> Hypothesis:
    """Return the hypothesis that nothing is missing."""
    size = problem.residual.size
    return _weighed(problem, (), np.empty(0), np.zeros(size), np.empty((size, 0)))


def fit(problem: Problem, causes: Sequence[Cause], start: FloatArray | None = None) -> Hypothesis:
    """Fit some causes together by damped Gauss-Newton steps.

    Parameters
    ----------
    start
        Parameters in prior units; typical values where left out.
    """
    chosen = tuple(causes)
    if not chosen:
        return null(problem)
    units = np.concatenate([one.start for one in chosen]) if start is None else start
    best = held(problem, chosen, _inside(chosen, units))
    for _ in range(_STEPS):
        better = _step(problem, best)
        if better is None:
            break
        gain, best = best.cost - better.cost, better
        if gain < _SETTLED:
            break
    return best


def linearised(problem: Problem, base: Hypothesis, more: Cause) -> Hypothesis:
    """Return what one cause more would give, to first order about a fit: one simulation each."""
    causes = (*base.causes, more)
    start = np.concatenate([base.units, more.start])
    signature = _signature(problem, causes, start)
    added = _slopes(problem, causes, start, signature, first=base.units.size)
    columns = np.hstack([base.columns, added])
    rough = _weighed(problem, causes, start, signature, columns)
    units = _inside(causes, rough.posterior.mean)
    return _weighed(problem, causes, units, signature + columns @ (units - start), columns)


def _signature(problem: Problem, causes: Sequence[Cause], units: FloatArray) -> FloatArray:
    changed = problem.predict(lambda trial: effects_at(causes, units, trial))
    found: FloatArray = (changed - problem.nominal) / problem.uncertainty
    return found


def _inside(causes: Sequence[Cause], units: FloatArray) -> FloatArray:
    if not causes:
        return units
    low, high = np.concatenate([one.bounds for one in causes], axis=1)
    return np.asarray(np.clip(units, low, high), np.float64)


def held(problem: Problem, causes: tuple[Cause, ...], units: FloatArray) -> Hypothesis:
    """Return the hypothesis at given parameters, which need not be its best."""
    signature = _signature(problem, causes, units)
    columns = _slopes(problem, causes, units, signature)
    return _weighed(problem, causes, units, signature, columns)


def _slopes(
    problem: Problem,
    causes: Sequence[Cause],
    units: FloatArray,
    signature: FloatArray,
    first: int = 0,
) -> FloatArray:
    columns = []
    for axis in range(first, units.size):
        column = np.zeros_like(signature)
        for step in (_STEP, -_STEP):
            moved = units.copy()
            moved[axis] += step
            kept = _inside(causes, moved)
            change = kept[axis] - units[axis]
            if abs(change) > 0.5 * _STEP:
                column = (_signature(problem, causes, kept) - signature) / change
                break
        columns.append(column)
    return np.column_stack(columns) if columns else np.empty((signature.size, 0))


def _weighed(
    problem: Problem,
    causes: tuple[Cause, ...],
    units: FloatArray,
    signature: FloatArray,
    columns: FloatArray,
) -> Hypothesis:
    nuisances = problem.nuisances
    left = problem.residual - signature
    found = posterior(left + columns @ units, columns, nuisances)
    cost = misfit(left, nuisances) + float(units @ units)
    evidence = -0.5 * (cost + nuisances.log_determinant) + found.log_volume
    return Hypothesis(causes, units, signature, columns, found, cost, evidence)


def _step(problem: Problem, base: Hypothesis) -> Hypothesis | None:
    towards = _most_probable(base) - base.units
    for share in (1.0, 0.4, 0.1):
        try:
            moved = held(problem, base.causes, base.units + share * towards)
        except PmmError:  # a body that does not swing back
            continue
        if moved.cost < base.cost:
            return moved
    return None


def _most_probable(base: Hypothesis) -> FloatArray:
    """Return the best parameters within their ranges; those at an end are held there."""
    low, high = np.concatenate([one.bounds for one in base.causes], axis=1)
    precision = base.posterior.precision
    target = precision @ base.posterior.mean
    units, free = base.posterior.mean.copy(), np.ones(base.units.size, dtype=bool)
    for _ in range(units.size):
        outside = free & ((units < low) | (units > high))
        if not outside.any():
            break
        free &= ~outside
        units = np.where(free, units, np.clip(units, low, high))
        if free.any():
            right = target[free] - precision[np.ix_(free, ~free)] @ units[~free]
            units[free] = np.linalg.solve(precision[np.ix_(free, free)], right)
    return np.asarray(np.clip(units, low, high), np.float64)
