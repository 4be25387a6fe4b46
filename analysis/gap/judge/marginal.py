"""How probable each effect is, whatever else is there too, and what these runs tell from it."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from analysis.gap.forward.problem import Problem
from analysis.gap.inference.answers import by_effect, of_any
from analysis.gap.inference.gaussian import misfit, posterior
from analysis.gap.judge.diagnosis import Diagnosis
from analysis.gap.judge.verdict import ALIKE, beside_rest, equivalents
from analysis.gap.search.fit import Fit
from hardware.description.errors import PmmError

LEAST: Final = 0.01  # probability that is worth a class
_MOST: Final = 6  # effects


@dataclass(frozen=True)
class Marginal:
    """One effect in any answer.

    Attributes
    ----------
    probability
        Of all answers with the effect.
    size_sigma
        Of its signature in the best of them, beside the other effect of a pair, in sigma after the
        free numbers have taken what they may; infinite where it cannot be simulated apart.
    alike
        What these runs cannot tell from it there, with the sigma left.
    class_probability
        Of all answers with any of these; NaN where its size is below ``ALIKE``, so that its absence
        passes for it as well.
    """

    name: str
    stage: str
    probability: float
    size_sigma: float
    alike: Mapping[str, float]
    class_probability: float


def marginals(diagnosis: Diagnosis) -> tuple[Marginal, ...]:
    """Return the effects that are not out of the question, most probable first."""
    shares = diagnosis.answers.by_answer
    fits = diagnosis.weighed.ranked
    leading = [name for name, share in by_effect(shares).items() if share > LEAST][:_MOST]
    best = {name: next(fit for fit in fits if name in fit.names) for name in leading}
    return tuple(_marginal(diagnosis, name, fit) for name, fit in best.items())


def _marginal(diagnosis: Diagnosis, name: str, fit: Fit) -> Marginal:
    shares = diagnosis.answers.by_answer
    number = fit.names.index(name)
    stage = fit.candidates[number].stage
    size = _size(diagnosis.problem, fit, number)
    probability = of_any(shares, [name])
    if size < ALIKE:
        return Marginal(name, stage, probability, size, {}, math.nan)
    alike = dict(equivalents(diagnosis.problem, fit, diagnosis.weighed.singles)[name])
    return Marginal(name, stage, probability, size, alike, of_any(shares, [name, *alike]))


def _size(problem: Problem, fit: Fit, number: int) -> float:
    """Return what the rest of a fit and the free numbers leave of one effect's signature."""
    try:
        signature, beside = beside_rest(problem, fit, number)
    except PmmError:
        return math.inf
    remainder = signature - beside @ posterior(signature, beside, problem.nuisances).mean
    return math.sqrt(max(misfit(remainder, problem.nuisances), 0.0))
