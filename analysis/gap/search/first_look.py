"""A first look at an effect: linearised in the simulator, from where it may be as large as the gap.

An effect that is a thousand times too large is no straight line down to the one that is there; so a
look begins where the effect is about as large as what there is to explain.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np

from analysis.gap.forward.candidate import STEP, Candidate, candidates, turned_starts
from analysis.gap.forward.powers import are_powers, scaled_change
from analysis.gap.forward.problem import ComparedProblem, Problem
from analysis.gap.inference.gaussian import left_over, misfit, null_evidence
from analysis.gap.inference.shapes import SignatureOfEffect
from analysis.gap.search.fit import (
    Fit,
    expected_evidence,
    linearised_at,
    most_probable,
    moved_fit,
    weighed_at,
)
from analysis.gap.search.refinement import follow
from analysis.gap.search.slopes import bounds, into_range
from hardware.description.arrays import FloatArray
from hardware.description.errors import PmmError
from sim.effects.effect import Effect

_MUCH: Final = 4.0  # times what there is to explain, from which a look begins nearer
_SEEN: Final = 10.0  # chi-square that there is to explain, at least
_HOPELESS: Final = 20.0  # log evidence under "no gap": a straight line has gone astray
_APPROACHES: Final = 3
_ALIKE: Final = 2.0  # times what there is to explain, within which an effect is about as large
_HALVINGS: Final = 6
_LEAST_POWER: Final = 0.2
HIDDEN: Final = 2.0  # sigma of a typical signature below which records cannot show an effect
_SIZES: Final = tuple(float(share) for share in np.geomspace(0.01, 10.0, 25))  # of the typical one


@dataclass(frozen=True, eq=False)
class FirstLook:
    """What a first look at one effect gave: linearised fits, or why there is none.

    Attributes
    ----------
    fits
        From each of its starts, the one that explains most first: what an effect does beside
        another one need not be what it would do alone.
    expected
        Log evidence that the first step promises.
    visible
        Size of the signature in sigma, after the nuisances have taken their part: as it typically
        is, or as these recordings ask for, whichever is larger.
    """

    name: str
    fits: tuple[Fit, ...]
    expected: float = -math.inf
    visible: float = 0.0
    reason: str = ""

    @property
    def is_hidden(self) -> bool:
        """Whether there is one that these records cannot show."""
        return self.fit is not None and self.visible < HIDDEN

    @property
    def fit(self) -> Fit | None:
        """The one that explains most by itself."""
        return self.fits[0] if self.fits else None


def signatures(looked: Iterable[FirstLook]) -> list[SignatureOfEffect]:
    """Return what the first looks show, of the effects that could be looked at."""
    return [
        SignatureOfEffect(look.name, look.fit.stages[0], look.fit.signature, look.fit.columns)
        for look in looked
        if look.fit is not None
    ]


def look(problem: Problem, kind: type[Effect]) -> FirstLook:
    """Linearise an effect at its typical values, from each of its starts, and keep the best."""
    frequencies = [run.set_point.frequency_hz for run in problem.simulator.stack.turning]
    starts = list(candidates(kind, sorted(set(frequencies))))
    if kind.repeats:
        begins = [(each, units) for each in starts for units in turned_starts(each)]
        return best_look(problem, kind.name, begins)
    return _best_of(
        problem, kind.name, [partial(_in_time, problem, candidate) for candidate in starts]
    )


def best_look(
    problem: ComparedProblem, name: str, starts: Sequence[tuple[Candidate, FloatArray]]
) -> FirstLook:
    """Linearise an effect at each of some starts, and keep the best."""

    def fit_from(candidate: Candidate, start: FloatArray) -> Fit:
        # elsewhere than where an effect is small it need not be proportional to its size
        roughly = bool(np.array_equal(start, candidate.start))
        return _look_nearer(problem, linearised_at(problem, (candidate,), start, roughly=roughly))

    return _best_of(
        problem, name, [partial(fit_from, candidate, start) for candidate, start in starts]
    )


def _best_of(problem: ComparedProblem, name: str, ways: Sequence[Callable[[], Fit]]) -> FirstLook:
    """Return the look that explains most, of several ways to see an effect."""
    fits, reason = list[Fit](), ""
    for way in ways:
        try:
            fits.append(way())
        except PmmError as error:
            reason = str(error)
    if not fits:
        return FirstLook(name, (), reason=reason)
    if len(fits) > 1:
        fits.sort(key=partial(_after_step, problem), reverse=True)
    best = fits[0]
    steps = (best.signature, best.columns @ most_probable(best))
    visible = max(left_over(step, problem.nuisances) for step in steps)
    return FirstLook(name, tuple(fits), expected_evidence(problem, best), visible)


def _after_step(problem: ComparedProblem, fit: Fit) -> float:
    """Return the log evidence that one step from a look leads to.

    Of sizes alone a straight line tells it. Of another parameter that line goes on through zero to
    the other sign, so that a rod on the wrong side would promise as much as one on the right side:
    the step is simulated.
    """
    if all(axis.is_size for axis in fit.axes):
        return expected_evidence(problem, fit)
    try:
        stepped_fit = moved_fit(problem, fit, most_probable(fit))
    except PmmError:
        return fit.log_evidence
    return max(fit.log_evidence, stepped_fit.log_evidence)


def _in_time(problem: Problem, candidate: Candidate) -> Fit:
    """Return a look at an effect that has to be simulated in time, once for each of its sizes.

    What has a sign is linear; tiny steps of it would drown in the digitiser's. Powers go with the
    square of a size, and their logarithms are compared: from one record follows what any size
    changes, where a straight line would soon go astray, and the one that leaves least is taken.
    What has a sign is taken to where it leads without any powers, and they follow there.
    """
    if candidate.axes and all(axis.is_size and axis.parameter.low < 0.0 for axis in candidate.axes):
        alone = [problem.signature((candidate,), units) for units in np.diag(candidate.start)]
        columns = np.column_stack(alone) / candidate.start
        columns[are_powers(problem.simulator.stack.components)] = 0.0
        parts, start = (candidate,), candidate.start
        small = weighed_at(problem, parts, start, columns, columns @ start)
        led = moved_fit(problem, small, most_probable(small))
        return max(small, led, key=lambda fit: fit.log_evidence)
    if len(candidate.axes) != 1:
        return linearised_at(problem, (candidate,), candidate.start)
    simulator = problem.simulator
    change = simulator.predict((candidate.effect(candidate.start),)) - simulator.nominal

    def signature(units: FloatArray) -> FloatArray:
        share = float(units[0] / candidate.start[0])
        return problem.whitened(scaled_change(simulator.stack.components, change, share))

    fits = []
    for units in (into_range((candidate,), share * candidate.start) for share in _SIZES):
        base_signature = signature(units)
        slope = (signature((1.0 + STEP) * units) - base_signature) / (STEP * units[0])
        fits.append(weighed_at(problem, (candidate,), units, slope[:, None], base_signature))
    return min(fits, key=lambda fit: fit.cost)


def _look_nearer(problem: ComparedProblem, fit: Fit) -> Fit:
    """Return a first look from where the effect is about as large as what there is to explain.

    A backlash that is a thousand times too large is no straight line down to the one that is there.
    """
    if not len(fit.units):
        return fit
    none = null_evidence(problem.residual, problem.nuisances)
    chi_square = misfit(problem.residual, problem.nuisances)
    wanted = math.sqrt(max(chi_square - len(problem.residual), _SEEN))
    if not any(axis.is_size for axis in fit.axes):
        # No straight line leads from there to no effect: some steps tell where it goes.
        return follow(problem, _along_any(problem, fit, wanted), _APPROACHES)
    # Seen from far too large, a phase is known far too well.
    straight = all(axis.is_size for axis in fit.axes)
    near = fit
    for _ in range(_APPROACHES):
        ratio = left_over(near.signature, problem.nuisances) / wanted
        if ratio < _MUCH:
            break
        if straight and expected_evidence(problem, near) > none - _HOPELESS:
            return fit
        near = moved_fit(problem, near, smaller_units(problem, near, 1.0 / ratio))
    return fit if near is fit or ratio > _MUCH**2 else _relinearised(problem, near)


def _along_any(problem: ComparedProblem, fit: Fit, wanted: float) -> Fit:
    """Return the most promising first look, of those from where one parameter alone was moved.

    None of them is a size: a droop and an inertia both make a drive yield less, and one of the two
    may do so in a form that has nothing of what there is to explain.
    """
    if left_over(fit.signature, problem.nuisances) < _MUCH * wanted:
        return fit
    ways = [_look_along(problem, fit, wanted, axis) for axis in range(len(fit.units))]
    return max(
        (way for way in ways if way is not None),
        key=lambda way: expected_evidence(problem, way),
        default=fit,
    )


def _look_along(problem: ComparedProblem, fit: Fit, wanted: float, axis: int) -> Fit | None:
    """Return a look from where one parameter makes the effect as large as wanted, if it can."""
    weighted = problem.nuisances.whiten(fit.signature)
    rises = float(weighted @ fit.columns[:, axis]) / max(float(weighted @ weighted), 1e-12)
    if not rises:
        return None
    low, high = bounds(fit.candidates)[:, axis]
    share = wanted / left_over(fit.signature, problem.nuisances)
    large, small = float(fit.units[axis]), float(low if rises > 0.0 else high)
    units, ratio, near = fit.units.copy(), math.inf, fit
    units[axis] = min(max(large + math.log(share) / rises, low), high)
    for _ in range(_HALVINGS):
        near = moved_fit(problem, fit, units.copy())
        ratio = left_over(near.signature, problem.nuisances) / wanted
        large, small = (units[axis], small) if ratio > 1.0 else (large, units[axis])
        if 1.0 / _ALIKE < ratio < _ALIKE or large == small:
            break
        units[axis] = 0.5 * (large + small)
    return _relinearised(problem, near) if ratio < _MUCH**2 else None


def _relinearised(problem: ComparedProblem, fit: Fit) -> Fit:
    """Return a moved fit with the slopes that it has where it came to."""
    return linearised_at(problem, fit.candidates, fit.units, signature=fit.signature)


def smaller_units(problem: ComparedProblem, fit: Fit, share: float) -> FloatArray:
    """Return parameters at which a signature is about a share of what it is.

    By the power with which it goes with its sizes, all together; or, where a parameter can't be
    zero, with the one that changes it most.
    """
    weighted = problem.nuisances.whiten(fit.signature)
    slopes = weighted @ fit.columns / max(float(weighted @ fit.signature), 1e-12)
    sizes = np.array([axis.is_size for axis in fit.axes], dtype=bool)
    units = fit.units.copy()
    power = float(slopes[sizes] @ units[sizes])
    if power > _LEAST_POWER:
        units[sizes] *= share ** (1.0 / power)
        return into_range(fit.candidates, units)
    at_most = int(np.argmax(np.where(sizes, 0.0, np.abs(slopes))))
    units[at_most] += math.log(share) / (slopes[at_most] or math.inf)
    return into_range(fit.candidates, units)
