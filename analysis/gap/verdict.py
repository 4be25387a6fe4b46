"""From evidence to probabilities: of each hypothesis, of each stage, of the classes."""

import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.gap.fit import Fit, Problem
from analysis.gap.free import Free
from analysis.gap.gaussian import misfit, posterior
from analysis.gap.hypotheses import Named, Weighed
from hardware.description.errors import PmmError
from sim.effects.effect import Effect

NONE: Final = "none"
UNKNOWN: Final = "unknown"
COEFFICIENTS: Final = "coefficients"
TOLERATED: Final = 0.45  # remainder over signature at which a name is worth half
DEMANDED: Final = 60.0  # log evidence over all that lacks it at which a name is worth half
_STEEP = 6.0
_EARNEST: Final = 0.8  # of pairs: the best of some thousand imitates what no catalogue has
SLIGHT: Final = 0.15  # of its partner's signature: as likely the partner's own form,
_BESIDE: Final = 40.0  # unless the log evidence over the partner alone is above this
# By how much log evidence between names is worth less than it says, as no form is exact: with half
# of it, names on two spent boards were right as often as their probability said.
TEMPER: Final = 2.0
_LEAST: Final = 1e-6  # remainder that counts as none
_UNBOUND: Final = 1e4  # prior deviations: as good as no prior
ALIKE: Final = 2.5  # sigma: what an effect leaves of another's signature when it passes for it


@dataclass(frozen=True)
class Probabilities:
    """What is how probable; sums to 1.

    Attributes
    ----------
    by_answer
        Over ``"none"``, ``"coefficients"``, ``"unknown"``, effects, and pairs ``"a+b"``.
    """

    by_answer: Mapping[str, float]

    @property
    def best(self) -> str:
        """The most probable answer."""
        return max(self.by_answer, key=lambda name: self.by_answer[name])


def probabilities(weighed: Weighed) -> Probabilities:
    """Turn evidence and prior odds into probabilities.

    A named hypothesis that leaves much beside what it explains counts for its name only in part,
    unless nothing else comes near it: the rest of its weight goes to ``"unknown"``, something with
    that effect's signature. Effects that these runs cannot show, or do not, are as good as none.
    Which of the names it is, is less sure than that it is one of them.
    """
    odds, count = weighed.odds, max(len(weighed.looked) + len(weighed.skipped), 1)
    concealed = (len(weighed.hidden) + len(weighed.skipped)) / count
    invisible = odds.single * concealed + odds.pair * concealed**2
    logs = {NONE: weighed.none + math.log(odds.none + invisible)}
    logs[UNKNOWN] = weighed.unknown.log_evidence + math.log(odds.unknown)
    single = math.log(odds.single / count)
    pair = math.log(odds.pair / max(count * (count - 1) / 2, 1))
    shares = {NONE: 1.0, UNKNOWN: 1.0}
    for prior, ones in ((single, weighed.singles), (pair, weighed.pairs)):
        for one in ones:
            logs[answer_of(one.fit)] = one.log_evidence + prior
            shares[answer_of(one.fit)] = deserved(one, demanded(one, weighed))
    top = max(logs.values())
    weights = {name: math.exp(value - top) for name, value in logs.items()}
    _to_the_larger(weighed, weights)
    total = sum(weights.values())
    found = {name: shares[name] * value / total for name, value in weights.items()}
    found[UNKNOWN] += sum((1.0 - shares[name]) * value / total for name, value in weights.items())
    return Probabilities(tempered(found))


def passed_on(found: Probabilities, names: Sequence[str]) -> Probabilities:
    """Return the probabilities with what some names have given to "unknown"."""
    share = sum(found.by_answer[name] for name in names)
    answers = {**found.by_answer, **dict.fromkeys(names, 0.0)}
    return Probabilities({**answers, UNKNOWN: answers[UNKNOWN] + share})


def tempered(found: Mapping[str, float]) -> dict[str, float]:
    """Return the same probability of all names together, less sure which one it is."""
    names = [name for name, share in found.items() if name not in (NONE, UNKNOWN) and share > 0.0]
    whole = sum(found[name] for name in names)
    parts = {name: (found[name] / whole) ** (1.0 / TEMPER) for name in names}
    return {**found, **{name: whole * one / sum(parts.values()) for name, one in parts.items()}}


def _to_the_larger(weighed: Weighed, weights: dict[str, float]) -> None:
    """Let a pair with a slight partner count for the other effect alone, in a form of its own."""
    alone = {answer_of(one.fit): one.log_evidence for one in weighed.singles}
    for pair in weighed.pairs:
        partners = [name for name in pair.fit.names if name in alone]
        if partners and pair.balance < 1.0:
            name = max(partners, key=lambda one: alone[one])
            margin = max(pair.log_evidence - alone[name], 0.0)
            odds = (pair.balance / SLIGHT) ** 3 + math.pow(margin / _BESIDE, _STEEP)
            whole = weights[answer_of(pair.fit)]
            weights[answer_of(pair.fit)] = whole * odds / (1.0 + odds)
            weights[name] += whole / (1.0 + odds)


def deserved(one: Named, margin: float) -> float:
    """Return how much of a named hypothesis's weight its name deserves.

    By what it leaves, or, if that is much, by how far everything without it falls behind; but what
    leaves more than it explains is not the name of a gap.

    Parameters
    ----------
    margin
        Log evidence over the best hypothesis without its effects.
    """
    odds = math.pow(TOLERATED / max(one.remainder, _LEAST), _STEEP)
    if one.remainder < 1.0:
        odds += math.pow(max(margin, 0.0) / DEMANDED, _STEEP)
    clean = odds / (1.0 + odds)
    return clean if len(one.fit.names) < 2 else _EARNEST * clean


def demanded(one: Named, weighed: Weighed) -> float:
    """Return a hypothesis's log evidence over the best one that shares no effect with it."""
    rest = [
        other.log_evidence
        for other in (*weighed.singles, *weighed.pairs)
        if not {*other.fit.names} & {*one.fit.names}
    ]
    return one.log_evidence - max([weighed.unknown.log_evidence, *rest])


def effects_in(answer: str) -> tuple[str, ...]:
    """Return the effects that an answer names; none for one that names no effect."""
    return () if answer in (NONE, UNKNOWN, COEFFICIENTS) else tuple(answer.split("+"))


def ranked(weighed: Weighed, found: Probabilities) -> list[Named]:
    """Return the named hypotheses, most probable first.

    Where a pair counts for one of its effects alone, that is what is named.
    """
    every = (*weighed.singles, *weighed.pairs)
    return sorted(every, key=lambda one: -found.by_answer[answer_of(one.fit)])


def answer_of(fit: Fit) -> str:
    """Return the name of a hypothesis: its effects in alphabetical order."""
    return "+".join(sorted(fit.names))


def equivalents(
    problem: Problem, fit: Fit, others: Sequence[Fit]
) -> dict[str, tuple[tuple[str, float], ...]]:
    """Return which effects pass in these runs for a fitted one, or for each effect of a pair.

    Beside the other effect of a pair, which may change with it.

    Returns
    -------
    dict
        For each effect, names and sigma left of its fitted signature when the other takes what it
        can; those below ``ALIKE``, best first. Empty for what cannot be simulated by itself.
    """
    found: dict[str, tuple[tuple[str, float], ...]] = {}
    for number, name in enumerate(fit.names):
        try:
            own, beside = beside_rest(problem, fit, number)
        except PmmError:
            found[name] = ()
            continue
        left = [
            (other.names[0], _left(problem, own, beside, other))
            for other in others
            if other.names[0] not in fit.names
        ]
        alike = [pair for pair in left if pair[1] < ALIKE]
        found[name] = tuple(sorted(alike, key=lambda pair: pair[1]))
    return found


def coefficient_twins(
    problem: Problem, fit: Fit, free: Sequence[Free]
) -> dict[str, tuple[float, float]]:
    """Return which coefficients would do in these runs what a fit does, were they off by enough.

    Returns
    -------
    dict
        By name, by how much it would be off, in its own unit and in prior deviations.
    """
    found = {}
    for number, one in enumerate(free):
        column = _UNBOUND * problem.nuisances.columns[:, number : number + 1]
        units = posterior(fit.signature, column, problem.nuisances).mean
        left = misfit(fit.signature - column @ units, problem.nuisances)
        if one.is_coefficient and left < ALIKE**2:
            whole = posterior(problem.residual, column, problem.nuisances).mean
            off = _UNBOUND * float(whole[0])
            found[one.name] = (off * one.deviation, off)
    return found


def beside_rest(problem: Problem, fit: Fit, number: int) -> tuple[np.ndarray, np.ndarray]:
    """Return what one effect of a fit adds to the rest of it, and the columns of the rest.

    Raises
    ------
    PmmError
        If the rest cannot be simulated by itself.
    """
    rest = tuple(one for at, one in enumerate(fit.effects) if at != number)
    columns = fit.columns[:, fit.whose != number]
    if not rest:
        return fit.signature, columns
    change = problem.simulator.predict(rest) - problem.simulator.nominal
    return fit.signature - problem.whitened(change), columns


def _left(problem: Problem, own: np.ndarray, beside: np.ndarray, other: Fit) -> float:
    """Return what is left of a signature, in sigma, when another effect takes what it can."""
    target = own - other.signature + other.columns @ other.units
    columns = np.hstack((other.columns, beside))
    best = posterior(target, columns, problem.nuisances).mean
    return math.sqrt(max(misfit(target - columns @ best, problem.nuisances), 0.0))


def stage_probabilities(
    found: Probabilities, catalogue: Mapping[str, type[Effect]], unknown: Mapping[str, float]
) -> dict[str, float]:
    """Return how probable it is that the gap comes from each stage; empty where there is none.

    Parameters
    ----------
    unknown
        The same of what is unknown, summing to 1.
    """
    shares: dict[str, float] = defaultdict(float)
    for answer, share in found.by_answer.items():
        if answer == UNKNOWN:
            for stage, part in unknown.items():
                shares[stage] += share * part
        names = effects_in(answer)
        for name in names:
            shares[catalogue[name].stage.value] += share / len(names)
    total = sum(shares.values())
    return {name: value / total for name, value in shares.items()} if total > 0.0 else {}


def coefficient_shift(problem: Problem, residual: np.ndarray) -> dict[str, float]:
    """Return by how many prior deviations each free number moves to fit a whitened difference."""
    fitted = problem.nuisances.fitted(residual)
    return {name: float(value) for name, value in zip(problem.free, fitted, strict=False)}
