"""Find what could explain a gap: a first look at each effect, then fits of those that promise most.

The first look is linear. Only what could still win is fitted in full: it costs some ten times as
much as a look, and a campaign without a gap has nothing that promises to beat "no gap".
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Final, TypeVar

from analysis.gap.forward.candidate import turned
from analysis.gap.forward.problem import Compared, Problem
from analysis.gap.search.first_look import Looked, look
from analysis.gap.search.fit import Fit, at, expected_evidence, joined, most_probable
from analysis.gap.search.refinement import refine, stepped
from hardware.description.errors import PmmError
from sim.effects.effect import Effect

P = TypeVar("P", bound=Compared)
T = TypeVar("T")
R = TypeVar("R")

LEADERS: Final = 8  # effects that are fitted in full, at most
PARTNERS: Final = 6  # pairs that are, at most
_LEAST: Final = 2  # effects that are fitted in any case: an answer and its rival
_PROMISING: Final = 0.5  # log evidence above "no gap" from which an effect is fitted
_TWICE: Final = 3.0  # and from which a pair is: its prior odds are a hundred times longer
_WORSE: Final = 3.0  # log evidence under the best single effect down to which a pair is
_STARTS: Final = 3  # effects to which partners are sought at first
_LED: Final = 2  # pairs to whose members they are sought next,
_EXCHANGES: Final = 4  # and how often, the first time counted
_STEPS_IN_TIME: Final = 3


@dataclass(frozen=True)
class Engine:
    """Who does the work, and who is told how far it is.

    Attributes
    ----------
    executor
        Where effects are looked at side by side; ``None`` does them one by one.
    progress
        Told what is being done, and how much of it is.
    """

    executor: Executor | None = None
    progress: Callable[[str], None] = lambda _: None

    def each(
        self, what: str, work: Callable[[P, T], R], problem: P, items: Sequence[T]
    ) -> Iterator[R]:
        """Yield what the work makes of each item, in their order."""
        self.progress(what)
        mapped = map if self.executor is None else self.executor.map
        for number, one in enumerate(mapped(work, [problem] * len(items), items), start=1):
            self.progress(f"{what}: {number} of {len(items)}")
            yield one


def looked_at(problem: Problem, kinds: Sequence[type[Effect]], engine: Engine) -> list[Looked]:
    """Look at each effect."""
    return list(engine.each("looking at effects", look, problem, kinds))


def fitted(problem: Compared, seen: Sequence[Looked], none: float, engine: Engine) -> list[Fit]:
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
        and (number < _LEAST or one.expected > none + _least(one.fit, ranked[0].expected - none))
    ]
    found = engine.each("fitting the best", _refined, problem, leaders)
    return sorted(found, key=lambda one: -one.log_evidence)


def paired(
    problem: Compared,
    singles: Sequence[Fit],
    seen: Sequence[Looked],
    none: float,
    engine: Engine,
) -> list[Fit]:
    """Put effects together in pairs by what they promise beside each other, by linear steps.

    The leading effects are given each partner; then each member of the pairs that promise most is,
    and so on: of two large effects neither need lead alone. Fitted in full are pairs that promise
    to do better than one effect. An effect is tried from where it was first seen and from where it
    was fitted: alone, it may have gone astray after what its partner does.
    """
    partners = [*(one.fit for one in seen if one.fit is not None), *singles]
    least = max([none + _TWICE, *(one.log_evidence - _WORSE for one in singles)])
    chances: dict[frozenset[str], _Chance] = {}
    firsts, tried = list(singles[:_STARTS]), set[str]()
    for _ in range(_EXCHANGES):
        _join(problem, firsts, partners, chances)
        tried |= {one.names[0] for one in firsts}
        members = {name for one in _promising(chances, least)[:_LED] for name in one.fit.names}
        firsts = [one for one in partners if one.names[0] in members - tried]
    return _fitted_together(problem, chances, least, engine, "fitting pairs")


def widened(
    problem: Compared, firsts: Sequence[Fit], partners: Sequence[Fit], engine: Engine
) -> list[Fit]:
    """Give leading sets of effects each partner, by linear steps, and fit what promises most."""
    if not firsts:
        return []
    chances: dict[frozenset[str], _Chance] = {}
    _join(problem, firsts[:_STARTS], partners, chances)
    least = max(one.log_evidence for one in firsts) - _WORSE
    return _fitted_together(problem, chances, least, engine, "fitting sets of three")


def _fitted_together(
    problem: Compared,
    chances: Mapping[frozenset[str], "_Chance"],
    least: float,
    engine: Engine,
    what: str,
) -> list[Fit]:
    worth = _affordable(_promising(chances, least))[:PARTNERS]
    found = engine.each(what, _refined_together, problem, worth)
    return sorted(found, key=lambda one: -one.log_evidence)


def alone_again(problem: Problem, singles: Sequence[Fit], pairs: Sequence[Fit]) -> list[Fit]:
    """Return single effects fitted once more from where the most probable pairs have them.

    Alone, an effect may have gone astray where a partner that turns out to be nothing led it right.
    """
    best = {one.names[0]: one for one in singles}
    for pair in pairs[:_LED]:
        for number, candidate in enumerate(pair.candidates):
            other = best.get(candidate.name)
            try:
                start = at(problem, (candidate,), pair.units[pair.whose == number])
                least = -math.inf if other is None else other.log_evidence - _WORSE
                if expected_evidence(problem, start) < least:
                    continue
                found = refine(problem, start)
            except PmmError:
                continue
            if other is None or found.log_evidence > other.log_evidence:
                best[candidate.name] = found
    return sorted(best.values(), key=lambda one: -one.log_evidence)


@dataclass(frozen=True, eq=False)
class _Chance:
    """Effects together as they are seen at first, and the log evidence that it promises."""

    promise: float
    fit: Fit


def _join(
    problem: Compared,
    firsts: Sequence[Fit],
    partners: Sequence[Fit],
    chances: dict[frozenset[str], _Chance],
) -> None:
    """Give each effect each partner; of two ways to see the same set the better one is kept."""
    for first in firsts:
        for second in partners:
            if not set(second.names) & set(first.names):
                key = frozenset((*first.names, *second.names))
                # in one order: two ways that differ by rounding alone are the same one
                both = joined(problem, *sorted((first, second), key=lambda one: one.names))
                promise = expected_evidence(problem, both)
                if key not in chances or promise > chances[key].promise:
                    chances[key] = _Chance(promise, both)


def _promising(chances: Mapping[frozenset[str], _Chance], least: float) -> list[_Chance]:
    """Return the sets that are worth their cost, most promising first."""
    worth = [one for one in chances.values() if one.promise > least + _dearer(one.fit)]
    return sorted(worth, key=lambda one: -one.promise)


def _affordable(chances: Sequence[_Chance]) -> list[_Chance]:
    """Return the sets without those that are costly, but for the most promising one of these."""
    first = next((one for one in chances if one.fit.is_costly), None)
    return [one for one in chances if one is first or not one.fit.is_costly]


def _least(fit: Fit, most: float) -> float:
    """Return the log evidence above "no gap" from which an effect is fitted, for what it costs."""
    return max(_PROMISING, 0.5 * most) if fit.is_costly else _PROMISING


def _dearer(pair: Fit) -> float:
    """Return what a pair has to promise more than others, for what it costs to refine it."""
    return _WORSE + _TWICE if pair.is_costly else 0.0


def _refined(problem: Compared, fit: Fit) -> Fit:
    """Refine a single effect, from a third of a turn to either side too if it has a phase."""
    found = [refine(problem, fit)]
    for start in turned(fit.candidates[0]):
        try:
            found.append(refine(problem, at(problem, fit.candidates, start)))
        except PmmError:
            continue
    return max(found, key=lambda one: one.log_evidence)


def _refined_together(problem: Compared, chance: _Chance) -> Fit:
    """Refine effects together; with what has to be simulated in time by few steps, its slopes kept.

    From where a linear step leads and, if that does not keep what was promised, from where the
    effects were seen.
    """
    fit = chance.fit
    if fit.is_costly:
        return stepped(problem, fit, 1)
    if not fit.repeats:
        return stepped(problem, fit, _STEPS_IN_TIME)
    best = fit
    for units in (most_probable(fit), fit.units):
        try:
            found = refine(problem, at(problem, fit.candidates, units))
        except PmmError:
            continue
        best = found if best is fit else max(best, found, key=lambda one: one.log_evidence)
        if best.log_evidence > chance.promise - _WORSE:
            break
    return best
