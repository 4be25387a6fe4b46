"""From evidence to probabilities: of each hypothesis, of each stage, of the classes."""

import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.gap.fit import Fit, Problem
from analysis.gap.gaussian import misfit, posterior
from analysis.gap.hypotheses import Named, Weighed
from sim.effects.effect import Effect

NONE: Final = "none"
UNKNOWN: Final = "unknown"
COEFFICIENTS: Final = "coefficients"
TOLERATED: Final = 0.45  # remainder over signature at which a name is worth half
_STEEP = 6.0
_EARNEST: Final = 0.8  # of pairs: the best of some thousand imitates what no catalogue has
SLIGHT: Final = 0.02  # of its partner's signature: as likely the partner's own form
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

    A named hypothesis that leaves much beside what it explains counts for its name only in part:
    the rest of its weight goes to ``"unknown"``, something with that effect's signature. Effects
    that these runs cannot show, or do not, are as good as none.
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
            shares[answer_of(one.fit)] = deserved(one)
    top = max(logs.values())
    weights = {name: math.exp(value - top) for name, value in logs.items()}
    _to_the_larger(weighed.pairs, weights)
    total = sum(weights.values())
    found = {name: shares[name] * value / total for name, value in weights.items()}
    found[UNKNOWN] += sum((1.0 - shares[name]) * value / total for name, value in weights.items())
    return Probabilities(found)


def _to_the_larger(pairs: Sequence[Named], weights: dict[str, float]) -> None:
    """Let a pair with a slight partner count for the other effect alone, in a form of its own."""
    for pair in pairs:
        alone = [name for name in pair.fit.names if name in weights]
        if alone and pair.balance < 1.0:
            name = max(alone, key=lambda one: weights[one])
            whole = weights[answer_of(pair.fit)]
            kept = whole * pair.balance**3 / (pair.balance**3 + SLIGHT**3)
            weights[answer_of(pair.fit)] = kept
            weights[name] += whole - kept


def deserved(one: Named) -> float:
    """Return how much of a named hypothesis's weight its name deserves, by what it leaves."""
    clean = 1.0 / (1.0 + math.pow(one.remainder / TOLERATED, _STEEP))
    return clean if len(one.fit.names) < 2 else _EARNEST * clean


def answer_of(fit: Fit) -> str:
    """Return the name of a hypothesis: its effects in alphabetical order."""
    return "+".join(sorted(fit.names))


def equivalents(problem: Problem, fit: Fit, others: Sequence[Fit]) -> tuple[tuple[str, float], ...]:
    """Return which effects pass for a fitted one in these runs, with what they leave of it.

    Returns
    -------
    tuple
        Names and sigma left of the fitted signature when the other takes what it can; those below
        ``ALIKE``, best first.
    """
    found = []
    for other in others:
        if other.names != fit.names:
            left = _left(problem, fit, other)
            if left < ALIKE:
                found.append((other.names[0], left))
    return tuple(sorted(found, key=lambda one: one[1]))


def _left(problem: Problem, fit: Fit, other: Fit) -> float:
    target = fit.signature - other.signature + other.columns @ other.units
    best = posterior(target, other.columns, problem.nuisances).mean
    return math.sqrt(max(misfit(target - other.columns @ best, problem.nuisances), 0.0))


def stage_probabilities(
    found: Probabilities, catalogue: Mapping[str, type[Effect]], unknown: str
) -> dict[str, float]:
    """Return how probable it is that the gap comes from each stage; empty where there is none.

    Parameters
    ----------
    unknown
        Stage to which what is unknown points.
    """
    shares: dict[str, float] = defaultdict(float)
    for answer, share in found.by_answer.items():
        if answer == UNKNOWN:
            shares[unknown] += share
        elif answer not in (NONE, COEFFICIENTS):
            names = answer.split("+")
            for name in names:
                shares[catalogue[name].stage.value] += share / len(names)
    total = sum(shares.values())
    return {name: value / total for name, value in shares.items()} if total > 0.0 else {}


def coefficient_shift(problem: Problem, residual: np.ndarray) -> dict[str, float]:
    """Return by how many prior deviations each free number moves to fit a whitened difference."""
    fitted = problem.nuisances.fitted(residual)
    return {name: float(value) for name, value in zip(problem.free, fitted, strict=False)}
