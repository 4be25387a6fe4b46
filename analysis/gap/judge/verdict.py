"""What an answer means: its stages, what passes for it, how far the coefficients move."""

import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from analysis.gap.forward.free_numbers import Free
from analysis.gap.forward.problem import Problem
from analysis.gap.inference.answers import UNKNOWN, Answers, effects_in
from analysis.gap.inference.gaussian import misfit, posterior
from analysis.gap.search.fit import Fit
from hardware.description.errors import PmmError
from sim.effects.effect import Effect

ALIKE: Final = 2.5  # sigma: what an effect leaves of another's signature when it passes for it
_UNBOUND: Final = 1e4  # prior deviations: as good as no prior


def equivalents(
    problem: Problem, fit: Fit, rivals: Sequence[Fit]
) -> dict[str, tuple[tuple[str, float], ...]]:
    """Return which effects pass in these runs for a fitted one, or for each effect of a pair.

    Beside the other effect of a pair, which may change with it.

    Returns
    -------
    dict
        For each effect, names and sigma left of its fitted signature when the other takes what it
        can; those below ``ALIKE``, best first. Empty for what cannot be simulated by itself.
    """
    classes: dict[str, tuple[tuple[str, float], ...]] = {}
    for number, name in enumerate(fit.names):
        try:
            signature, beside = beside_rest(problem, fit, number)
        except PmmError:
            classes[name] = ()
            continue
        remainders = [
            (rival.names[0], _unexplained_size(problem, signature, beside, rival))
            for rival in rivals
            if rival.names[0] not in fit.names
        ]
        alike = [pair for pair in remainders if pair[1] < ALIKE]
        classes[name] = tuple(sorted(alike, key=lambda pair: pair[1]))
    return classes


def coefficient_twins(
    problem: Problem, fit: Fit, free: Sequence[Free]
) -> dict[str, tuple[float, float]]:
    """Return which coefficients would do in these runs what a fit does, were they off by enough.

    Returns
    -------
    dict
        By name, by how much it would be off, in its own unit and in prior deviations.
    """
    twins = {}
    for number, free_number in enumerate(free):
        column = _UNBOUND * problem.nuisances.columns[:, number : number + 1]
        units = posterior(fit.signature, column, problem.nuisances).mean
        remainder = misfit(fit.signature - column @ units, problem.nuisances)
        if free_number.is_coefficient and remainder < ALIKE**2:
            residual_units = posterior(problem.residual, column, problem.nuisances).mean
            off = _UNBOUND * float(residual_units[0])
            twins[free_number.name] = (off * free_number.deviation, off)
    return twins


def beside_rest(problem: Problem, fit: Fit, number: int) -> tuple[np.ndarray, np.ndarray]:
    """Return what one effect of a fit adds to the rest of it, and the columns of the rest.

    Raises
    ------
    PmmError
        If the rest cannot be simulated by itself.
    """
    rest = tuple(effect for at, effect in enumerate(fit.effects) if at != number)
    columns = fit.columns[:, fit.effect_index != number]
    if not rest:
        return fit.signature, columns
    change = problem.simulator.predict(rest) - problem.simulator.nominal
    return fit.signature - problem.whitened(change), columns


def _unexplained_size(
    problem: Problem, signature: np.ndarray, beside: np.ndarray, rival: Fit
) -> float:
    """Return what is left of a signature, in sigma, when another effect takes what it can."""
    target = signature - rival.signature + rival.columns @ rival.units
    columns = np.hstack((rival.columns, beside))
    best = posterior(target, columns, problem.nuisances).mean
    return math.sqrt(max(misfit(target - columns @ best, problem.nuisances), 0.0))


def stage_probabilities(
    answers: Answers, catalogue: Mapping[str, type[Effect]]
) -> dict[str, float]:
    """Return how probable it is that the gap comes from each stage; empty where there is none."""
    shares: dict[str, float] = defaultdict(float)
    for answer, share in answers.by_answer.items():
        if answer == UNKNOWN:
            for stage, part in answers.unknown_stages.items():
                shares[stage] += share * part
        names = effects_in(answer)
        for name in names:
            shares[catalogue[name].stage.value] += share / len(names)
    total = sum(shares.values())
    return {name: value / total for name, value in shares.items()} if total > 0.0 else {}


def coefficient_shift(problem: Problem) -> dict[str, float]:
    """Return by how many tolerances each free number moves from what is stated, without effects."""
    fitted = problem.nuisances.fitted(problem.stated)
    return {name: float(value) for name, value in zip(problem.free, fitted, strict=False)}
