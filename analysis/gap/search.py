"""Find what could explain a gap: a first look at each effect, then fits of those that promise most.

The first look is linear. Only what could still win is fitted in full: it costs some ten times as
much as a look, and a campaign without a gap has nothing that promises to beat "no gap".
"""

import math
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Final, TypeVar

import numpy as np
from numpy.typing import NDArray

from analysis.gap.candidate import candidates, turned
from analysis.gap.fit import (
    Fit,
    Problem,
    at,
    expected_evidence,
    inside,
    joined,
    most_probable,
    moved,
    refine,
    stepped,
)
from analysis.gap.gaussian import left_over, misfit, null_evidence
from hardware.description.errors import PmmError
from sim.effects.effect import Effect

FloatArray = NDArray[np.float64]
T = TypeVar("T")
R = TypeVar("R")

LEADERS: Final = 8  # effects that are fitted in full, at most
PARTNERS: Final = 6  # pairs that are, at most
_LEAST: Final = 2  # effects that are fitted in any case: an answer and its rival
_PROMISING: Final = 0.5  # log evidence above "no gap" from which an effect is fitted
_TWICE: Final = 3.0  # and from which a pair is: its prior odds are a hundred times longer
_WORSE: Final = 3.0  # log evidence under the best single effect down to which a pair is
_STARTS: Final = 3  # effects to which partners are sought
_STEPS_IN_TIME: Final = 3
_DEAR: Final = frozenset({"gear-backlash"})  # repeats, but is run in time until it does
_MUCH: Final = 4.0  # times what there is to explain, from which a look begins nearer
_SEEN: Final = 10.0  # chi-square that there is to explain, at least
_HOPELESS: Final = 20.0  # log evidence under "no gap": a straight line has gone astray
_APPROACHES: Final = 3
_ALIKE: Final = 2.0  # times what there is to explain, within which an effect is about as large
_HALVINGS: Final = 6
_LEAST_POWER: Final = 0.2
_MATCHES: Final = 2
_SHOWN: Final = 1.3  # times what the runs show of an effect, down to which its size is alike


@dataclass(frozen=True, eq=False)
class Looked:
    """What a first look at one effect gave: a linearised fit, or why there is none.

    Attributes
    ----------
    expected
        Log evidence that the first step promises.
    visible
        Size of the signature in sigma, after the nuisances have taken their part: as it typically
        is, or as these recordings ask for, whichever is larger.
    """

    name: str
    fit: Fit | None
    expected: float = -math.inf
    visible: float = 0.0
    reason: str = ""


def looked_at(
    problem: Problem, kinds: Sequence[type[Effect]], executor: Executor | None
) -> list[Looked]:
    """Look at each effect."""
    return list(_each(executor, look, problem, kinds))


def fitted(
    problem: Problem, seen: Sequence[Looked], none: float, executor: Executor | None
) -> list[Fit]:
    """Fit the leading effects in full; the most probable comes first.

    Parameters
    ----------
    none
        Log evidence of "no gap".
    """
    ranked = sorted(seen, key=lambda one: -one.expected)[:LEADERS]
    leaders = [
        one.fit
        for number, one in enumerate(ranked)
        if one.fit is not None
        and (number < _LEAST or one.expected > none + _least(one, ranked[0].expected - none))
    ]
    found = _each(executor, _refined, problem, leaders)
    return sorted(found, key=lambda one: -one.log_evidence)


def paired(
    problem: Problem,
    singles: Sequence[Fit],
    seen: Sequence[Looked],
    none: float,
    executor: Executor | None,
) -> list[Fit]:
    """Add to the leading effects whatever promises most beside them; greedy, by linear steps.

    Fitted in full are those that promise to do better than one effect alone. An effect is tried
    from where it was first seen and from where it was fitted: alone, it may have gone astray after
    what its partner does.
    """
    chances: dict[frozenset[str], tuple[float, Fit]] = {}
    partners = [*(one.fit for one in seen if one.fit is not None), *singles]
    for first in singles[:_STARTS]:
        for second in partners:
            if second.names != first.names:
                key = frozenset((*first.names, *second.names))
                both = joined(problem, first, second)
                score = expected_evidence(problem, both)
                if key not in chances or score > chances[key][0]:
                    chances[key] = (score, both)
    best = sorted(chances.values(), key=lambda one: -one[0])[:PARTNERS]
    least = max([none + _TWICE, *(one.log_evidence - _WORSE for one in singles)])
    worth = [both for score, both in best if score > least + _dearer(both)]
    found = _each(executor, _refined_pair, problem, worth)
    return sorted(found, key=lambda one: -one.log_evidence)


def _least(one: Looked, most: float) -> float:
    """Return the log evidence above "no gap" from which an effect is fitted, for what it costs."""
    return max(_PROMISING, 0.5 * most) if one.name in _DEAR else _PROMISING


def _dearer(pair: Fit) -> float:
    """Return what a pair has to promise more than others, for what it costs to refine it."""
    return _WORSE + _TWICE if _DEAR & set(pair.names) else 0.0


def _each(
    executor: Executor | None,
    work: Callable[[Problem, T], R],
    problem: Problem,
    items: Sequence[T],
) -> Iterable[R]:
    if executor is None:
        return [work(problem, one) for one in items]
    return executor.map(work, [problem] * len(items), items)


def look(problem: Problem, kind: type[Effect]) -> Looked:
    """Linearise an effect at its typical values, from each of its starts, and keep the best."""
    frequencies = [run.set_point.frequency_hz for run in problem.simulator.stack.turning]
    best, most, reason = None, -math.inf, ""
    for one in candidates(kind, sorted(set(frequencies))):
        try:
            fit = _near(problem, at(problem, (one,), one.start, roughly=True))
        except PmmError as error:
            reason = str(error)
            continue
        expected = expected_evidence(problem, fit)
        if best is None or expected > most:
            best, most = fit, expected
    if best is None:
        return Looked(kind.name, None, reason=reason)
    if not kind.repeats:
        best = _matched(problem, best)
        most = expected_evidence(problem, best)
    steps = (best.signature, best.columns @ most_probable(best))
    visible = max(left_over(one, problem.nuisances) for one in steps)
    return Looked(kind.name, best, most, visible)


def _near(problem: Problem, fit: Fit) -> Fit:
    """Return a first look from where the effect is about as large as what there is to explain.

    A backlash that is a thousand times too large is no straight line down to the one that is there.
    """
    if not len(fit.units):
        return fit
    none = null_evidence(problem.residual, problem.nuisances)
    chi_square = misfit(problem.residual, problem.nuisances)
    wanted = math.sqrt(max(chi_square - len(problem.residual), _SEEN))
    if not any(axis.is_size for one in fit.candidates for axis in one.axes):
        return _along_any(problem, fit, wanted)
    near = fit
    for _ in range(_APPROACHES):
        ratio = left_over(near.signature, problem.nuisances) / wanted
        if ratio < _MUCH:
            break
        if expected_evidence(problem, near) > none - _HOPELESS:
            return fit
        near = moved(problem, near, smaller(problem, near, 1.0 / ratio))
    return fit if near is fit or ratio > _MUCH**2 else at(problem, fit.candidates, near.units)


def _matched(problem: Problem, fit: Fit) -> Fit:
    """Return a look at what does not repeat from where it is as large as what the runs show of it.

    It shows in logarithms, which no straight line follows far; and in what no other effect changes,
    so that what it is to explain is known whatever else is there.
    """
    for _ in range(_MATCHES):
        weighted = problem.nuisances.whiten(fit.signature)
        seen, own = float(weighted @ problem.residual), float(weighted @ fit.signature)
        if not max(seen, 0.0) ** 2 > _SEEN * own or seen * _SHOWN > own:
            break
        fit = at(problem, fit.candidates, smaller(problem, fit, seen / own))
    return fit


def _along_any(problem: Problem, fit: Fit, wanted: float) -> Fit:
    """Return the most promising first look, of those from where one parameter alone was moved.

    None of them is a size: a droop and an inertia both make a drive yield less, and one of the two
    may do so in a form that has nothing of what there is to explain.
    """
    if left_over(fit.signature, problem.nuisances) < _MUCH * wanted:
        return fit
    ways = [_along(problem, fit, wanted, axis) for axis in range(len(fit.units))]
    return max(
        (one for one in ways if one is not None),
        key=lambda one: expected_evidence(problem, one),
        default=fit,
    )


def _along(problem: Problem, fit: Fit, wanted: float, axis: int) -> Fit | None:
    """Return a look from where one parameter makes the effect as large as wanted, if it can."""
    weighted = problem.nuisances.whiten(fit.signature)
    rises = float(weighted @ fit.columns[:, axis]) / max(float(weighted @ weighted), 1e-12)
    if not rises:
        return None
    low, high = np.concatenate([one.bounds for one in fit.candidates], axis=1)[:, axis]
    share = wanted / left_over(fit.signature, problem.nuisances)
    large, small = float(fit.units[axis]), float(low if rises > 0.0 else high)
    units, ratio = fit.units.copy(), math.inf
    units[axis] = min(max(large + math.log(share) / rises, low), high)
    for _ in range(_HALVINGS):
        ratio = left_over(moved(problem, fit, units).signature, problem.nuisances) / wanted
        large, small = (units[axis], small) if ratio > 1.0 else (large, units[axis])
        if 1.0 / _ALIKE < ratio < _ALIKE or large == small:
            break
        units[axis] = 0.5 * (large + small)
    return at(problem, fit.candidates, units) if ratio < _MUCH**2 else None


def smaller(problem: Problem, fit: Fit, share: float) -> FloatArray:
    """Return parameters at which a signature is about a share of what it is.

    By the power with which it goes with its sizes, all together; or, where a parameter can't be
    zero, with the one that changes it most.
    """
    weighted = problem.nuisances.whiten(fit.signature)
    slopes = weighted @ fit.columns / max(float(weighted @ fit.signature), 1e-12)
    axes = [axis for one in fit.candidates for axis in one.axes]
    sizes = np.array([one.is_size for one in axes], dtype=bool)
    units = fit.units.copy()
    power = float(slopes[sizes] @ units[sizes])
    if power > _LEAST_POWER:
        units[sizes] *= share ** (1.0 / power)
        return inside(fit.candidates, units)
    at_most = int(np.argmax(np.where(sizes, 0.0, np.abs(slopes))))
    units[at_most] += math.log(share) / (slopes[at_most] or math.inf)
    return inside(fit.candidates, units)


def _refined(problem: Problem, fit: Fit) -> Fit:
    """Refine a single effect, from a third of a turn to either side too if it has a phase."""
    found = [refine(problem, fit)]
    for start in turned(fit.candidates[0]):
        try:
            found.append(refine(problem, at(problem, fit.candidates, start)))
        except PmmError:
            continue
    return max(found, key=lambda one: one.log_evidence)


def _refined_pair(problem: Problem, fit: Fit) -> Fit:
    """Refine a pair; with what has to be simulated in time by few steps, its slopes kept."""
    if _DEAR & set(fit.names) or not all(one.kind.repeats for one in fit.candidates):
        return stepped(problem, fit, _STEPS_IN_TIME)
    for units in (most_probable(fit), fit.units):
        try:
            return refine(problem, at(problem, fit.candidates, units))
        except PmmError:
            continue
    return fit
