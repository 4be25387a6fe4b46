"""Find what could explain a gap: a first look at each effect, then fits of those that promise most.

The first look is linear. Only what could still win is fitted in full: it costs some ten times as
much as a look, and a campaign without a gap has nothing that promises to beat "no gap".
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Final, TypeVar

from analysis.gap.forward.problem import ComparedProblem, Problem
from analysis.gap.search.first_look import FirstLook, look
from analysis.gap.search.fit import (
    Fit,
    expected_evidence,
    joined,
    most_probable,
    moved_fit,
    weighed_at,
)
from analysis.gap.search.refinement import refine, stepped
from hardware.description.errors import PmmError
from sim.effects.effect import Effect

P = TypeVar("P", bound=ComparedProblem)
T = TypeVar("T")
R = TypeVar("R")

LEADERS: Final = 8  # effects that are fitted in full, at most
PARTNERS: Final = 6  # pairs that are, at most
_LEAST: Final = 2  # effects that are fitted in any case: an answer and its rival
_PROMISING: Final = 0.5  # log evidence above "no gap" from which an effect is fitted
_TWICE: Final = 3.0  # and from which a pair is: its prior odds are some sixty times longer
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
        self, task: str, work: Callable[[P, T], R], problem: P, items: Sequence[T]
    ) -> Iterator[R]:
        """Yield what the work makes of each item, in their order."""
        self.progress(task)
        mapped = map if self.executor is None else self.executor.map
        for number, result in enumerate(mapped(work, [problem] * len(items), items), start=1):
            self.progress(f"{task}: {number} of {len(items)}")
            yield result


def looked_at(problem: Problem, kinds: Sequence[type[Effect]], engine: Engine) -> list[FirstLook]:
    """Look at each effect."""
    return list(engine.each("looking at effects", look, problem, kinds))


def fit_leading(
    problem: ComparedProblem, looks: Sequence[FirstLook], none: float, engine: Engine
) -> list[Fit]:
    """Fit the leading effects in full; the most probable comes first.

    Parameters
    ----------
    none
        Log evidence of "no gap".
    """
    ranked = sorted(looks, key=lambda look: -look.expected)[:LEADERS]
    leaders = [
        look.fit
        for number, look in enumerate(ranked)
        if look.fit is not None
        and (number < _LEAST or look.expected > none + _least(look.fit, ranked[0].expected - none))
    ]
    fits = engine.each("fitting the best", refine, problem, leaders)
    return sorted(fits, key=lambda fit: -fit.log_evidence)


def fit_pairs(
    problem: ComparedProblem,
    singles: Sequence[Fit],
    looks: Sequence[FirstLook],
    none: float,
    engine: Engine,
) -> list[Fit]:
    """Put effects together in pairs by what they promise beside each other, by linear steps.

    The leading effects are given each partner; then each member of the pairs that promise most is,
    and so on: of two large effects neither need lead alone. Fitted in full are pairs that promise
    to do better than one effect. An effect is tried from where it was first seen and from where it
    was fitted: alone, it may have gone astray after what its partner does.
    """
    partners = [*(fit for look in looks for fit in look.fits), *singles]
    least = max([none + _TWICE, *(fit.log_evidence - _WORSE for fit in singles)])
    chances: dict[frozenset[str], _Chance] = {}
    firsts, tried = list(singles[:_STARTS]), set[str]()
    for _ in range(_EXCHANGES):
        _join(problem, firsts, partners, chances)
        tried |= {fit.names[0] for fit in firsts}
        members = {
            name for chance in _worth_refining(chances, least)[:_LED] for name in chance.fit.names
        }
        firsts = [partner for partner in partners if partner.names[0] in members - tried]
    return _fitted_together(problem, chances, least, engine, "fitting pairs")


def widened(
    problem: ComparedProblem, firsts: Sequence[Fit], partners: Sequence[Fit], engine: Engine
) -> list[Fit]:
    """Give leading sets of effects each partner, by linear steps, and fit what promises most."""
    if not firsts:
        return []
    chances: dict[frozenset[str], _Chance] = {}
    _join(problem, firsts[:_STARTS], partners, chances)
    least = max(fit.log_evidence for fit in firsts) - _WORSE
    return _fitted_together(problem, chances, least, engine, "fitting sets of three")


def _fitted_together(
    problem: ComparedProblem,
    chances: Mapping[frozenset[str], "_Chance"],
    least: float,
    engine: Engine,
    task: str,
) -> list[Fit]:
    worth = _affordable(_worth_refining(chances, least))[:PARTNERS]
    fits = engine.each(task, _refined_together, problem, worth)
    return sorted(fits, key=lambda fit: -fit.log_evidence)


def alone_again(problem: Problem, singles: Sequence[Fit], pairs: Sequence[Fit]) -> list[Fit]:
    """Return single effects fitted once more from where the most probable pairs have them.

    Alone, an effect may have gone astray where a partner that turns out to be nothing led it right.
    """
    best = {fit.names[0]: fit for fit in singles}
    for pair in pairs[:_LED]:
        for number, candidate in enumerate(pair.candidates):
            earlier_fit = best.get(candidate.name)
            try:
                start = _member(problem, pair, number)
                least = -math.inf if earlier_fit is None else earlier_fit.log_evidence - _WORSE
                if expected_evidence(problem, start) < least:
                    continue
                refined = refine(problem, start)
            except PmmError:
                continue
            if earlier_fit is None or refined.log_evidence > earlier_fit.log_evidence:
                best[candidate.name] = refined
    return sorted(best.values(), key=lambda fit: -fit.log_evidence)


def _member(problem: ComparedProblem, fit: Fit, number: int) -> Fit:
    """Return one effect of several alone, where and with the slopes that they have together."""
    own = fit.effect_index == number
    parts, units = (fit.candidates[number],), fit.units[own]
    signature = problem.signature(parts, units)
    return weighed_at(problem, parts, units, fit.columns[:, own], signature)


@dataclass(frozen=True, eq=False)
class _Chance:
    """Effects together as they are seen at first, and the log evidence that it promises."""

    promise: float
    fit: Fit

    def is_better_than(self, other: "_Chance") -> bool:
        """Tell whether it promises more, or as much and has kept more of it already."""
        if abs(self.promise - other.promise) > _WORSE:
            return self.promise > other.promise
        return self.fit.log_evidence > other.fit.log_evidence


def _join(
    problem: ComparedProblem,
    firsts: Sequence[Fit],
    partners: Sequence[Fit],
    chances: dict[frozenset[str], _Chance],
) -> None:
    """Give each effect each partner; of two ways to see the same set the better one is kept.

    Of two that promise as much it is the one that is nearer to what it promises.
    """
    for first in firsts:
        for second in partners:
            if not set(second.names) & set(first.names):
                key = frozenset((*first.names, *second.names))
                # in one order: two ways that differ by rounding alone are the same one
                joint_fit = joined(problem, *sorted((first, second), key=lambda fit: fit.names))
                chance = _Chance(expected_evidence(problem, joint_fit), joint_fit)
                if key not in chances or chance.is_better_than(chances[key]):
                    chances[key] = chance


def _worth_refining(chances: Mapping[frozenset[str], _Chance], least: float) -> list[_Chance]:
    """Return the sets that are worth their cost, most promising first."""
    worth = [
        chance
        for chance in chances.values()
        if chance.promise > least + _refinement_cost(chance.fit)
    ]
    return sorted(worth, key=lambda chance: -chance.promise)


def _affordable(chances: Sequence[_Chance]) -> list[_Chance]:
    """Return the sets without those that are costly, but for the most promising one of these."""
    first = next((chance for chance in chances if chance.fit.is_costly), None)
    return [chance for chance in chances if chance is first or not chance.fit.is_costly]


def _least(fit: Fit, most: float) -> float:
    """Return the log evidence above "no gap" from which an effect is fitted, for what it costs."""
    return max(_PROMISING, 0.5 * most) if fit.is_costly else _PROMISING


def _refinement_cost(pair: Fit) -> float:
    """Return what a pair has to promise more than others, for what it costs to refine it."""
    return _WORSE + _TWICE if pair.is_costly else 0.0


def _refined_together(problem: ComparedProblem, chance: _Chance) -> Fit:
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
            refined = refine(problem, moved_fit(problem, fit, units))
        except PmmError:
            continue
        best = (
            refined if best is fit else max(best, refined, key=lambda option: option.log_evidence)
        )
        if best.log_evidence > chance.promise - _WORSE:
            break
    return best
