"""Improve a fit through the simulator, by damped Gauss-Newton steps."""

import math
from typing import Final

from analysis.gap.forward.problem import ComparedProblem
from analysis.gap.search.fit import (
    Fit,
    learned,
    linear_cost,
    linearised_at,
    most_probable,
    moved_fit,
    relinearised,
)
from hardware.description.errors import PmmError

_STEPS: Final = 24  # at most; a fit that is still on its way then is nowhere near
_STEPS_IN_TIME: Final = 5  # for what has to be simulated in time, a hundred times as costly
_FULFILLED: Final = 0.5  # share of a step's promise within which, and its inverse, slopes are kept
# Chi-square that a further step promises at which a fit has arrived: the parameters are then within
# 0.14 of their uncertainty of where they belong.
_SETTLED: Final = 0.02
_FURTHER: Final = 3.0  # times as far as a first look at a change, it leads at most


def refine(problem: ComparedProblem, fit: Fit) -> Fit:
    """Improve a fit by damped Gauss-Newton steps through the simulator, to its optimum.

    Slopes learn from each step what it really brought about; where that is not about what they
    promised, they are found anew: where it is many times as much, they lead to where only they are
    level. A fit has arrived when those found where it is promise nothing more; of what does not
    repeat with the shaft, those it has.
    """
    if not fit.repeats:
        return stepped(problem, _simulated(problem, fit), _STEPS_IN_TIME)
    best, fresh = _follow_slopes(problem, fit)
    for _ in range(_STEPS):
        if fresh:
            break
        start = relinearised_or_same(problem, best)
        best, fresh = _follow_slopes(problem, start)
        fresh = fresh or best is start
    return best


def follow(problem: ComparedProblem, fit: Fit, steps: int = _STEPS) -> Fit:
    """Improve a fit until the slopes that it has and learns promise nothing more."""
    return _follow_slopes(problem, fit, steps)[0]


def _follow_slopes(problem: ComparedProblem, fit: Fit, steps: int = _STEPS) -> tuple[Fit, bool]:
    """Return the fit where its slopes lead, and whether these were found there."""
    best, fresh = fit, False
    for _ in range(steps):
        better, fulfilled = _step(problem, best)
        if better is None:
            break
        best, fresh = learned(problem, best, better), False
        if not _FULFILLED < fulfilled < 1.0 / _FULFILLED:
            best, fresh = relinearised_or_same(problem, best), True
    return best, fresh


def _simulated(problem: ComparedProblem, fit: Fit) -> Fit:
    """Return a fit as it is simulated where it is; as it is where that cannot be."""
    try:
        return linearised_at(problem, fit.candidates, fit.units)
    except PmmError:
        return fit


def relinearised_or_same(problem: ComparedProblem, fit: Fit) -> Fit:
    """Return a fit with slopes found where it is; as it is where nothing can be simulated aside."""
    try:
        return relinearised(problem, fit)
    except PmmError:
        return fit


def stepped(problem: ComparedProblem, fit: Fit, steps: int) -> Fit:
    """Return a fit after some steps with the slopes that it has; itself if none betters it."""
    best = fit
    for _ in range(steps):
        better, _ = _step(problem, best)
        if better is None:
            break
        best = better
    return best


def in_reach(fit: Fit, change: float, least: float) -> bool:
    """Tell whether a change of a fit, and twice as much again, could bring it down to a rival.

    Parameters
    ----------
    change
        Its size in sigma, of all observations together.
    least
        Cost of the rival.
    """
    return math.sqrt(fit.cost) - _FURTHER * change < math.sqrt(least)


def _step(problem: ComparedProblem, fit: Fit) -> tuple[Fit | None, float]:
    """Return a better fit along the Gauss-Newton step, and how much of its promise it keeps.

    None where the step promises nothing, or nothing along it is better.
    """
    towards = most_probable(fit) - fit.units
    promise = fit.cost - linear_cost(problem, fit, fit.units + towards)
    if promise < _SETTLED:
        return None, 0.0
    for share in (1.0, 0.4, 0.1, 0.02):
        try:
            better = moved_fit(problem, fit, fit.units + share * towards)
        except PmmError:
            continue
        if better.cost < fit.cost:
            return better, (fit.cost - better.cost) / promise
    return None, 0.0
