"""What the coefficients of a fit are uncertain by: each run's scatter, and what is stated."""

from collections import Counter

import numpy as np

from analysis.coefficients.cycle_model import CycleProblem
from analysis.coefficients.stated_uncertainties import STATED, StatedUncertainties
from analysis.uncertainty.values import Contribution, added
from hardware.description.arrays import FloatArray

POOLED_FREEDOM = 20.0
"""Degrees of freedom at which a run's own variance counts as much as the mean of all runs'."""


def trusted(variance: FloatArray, degrees_of_freedom: FloatArray, mean: FloatArray) -> FloatArray:
    """Return variances shrunk towards their mean, the more so the fewer periods they come from."""
    trust = 1.0 / (1.0 + POOLED_FREEDOM / np.maximum(degrees_of_freedom, 1e-9))
    return np.asarray(trust * variance + (1.0 - trust) * mean)


def _luck(problem: CycleProblem, degrees_of_freedom: float) -> float:
    """Return by how much a cycle's scatter is larger than it seems, where others tell the same.

    A cycle whose periods happened to scatter little has a large weight for it, so that the sum of
    weighted variances comes out too small. If its estimated variance is off by the part e, its
    weights are off by -t e, with t the trust in it and its part of the mean (:func:`trusted`), and
    what it adds to the coefficients by -t e (1 - F), F its share of what tells them. The mean of
    e^2 is 2 over the degrees of freedom, halved where both parts of a harmonic make one weight.
    """
    freedom, count = max(degrees_of_freedom, 1.0), len(problem.numbers.cycles)
    trust = (1.0 + POOLED_FREEDOM / count / freedom) / (freedom + POOLED_FREEDOM)
    return float(2.0 * trust * len(problem.orders) / problem.real.sum())


def _by_own_speed(problem: CycleProblem, values: FloatArray) -> FloatArray:
    """Return how terms that are those of a speed follow it, ``(terms, len(STATED))``.

    It is the mean of the runs', and a term is divided by it.
    """
    of_speed = np.mean([cycle.speed_slope for cycle in problem.numbers.cycles], axis=0)
    terms = problem.terms
    powers = [term.divided / term.of_speed_m_s if term.of_speed_m_s else 0.0 for term in terms]
    return np.asarray((np.array(powers) * values)[:, None] * of_speed)


def fit_sources(
    problem: CycleProblem, values: FloatArray, stated: StatedUncertainties
) -> tuple[Contribution, ...]:
    """Return scatter by source, of all cycles that share it, then each stated uncertainty.

    Parameters
    ----------
    values
        What :meth:`CycleProblem.solve` found for the cycles as they are.
    """
    slopes = problem.sensitivities(values)
    all_rows, contributions = np.arange(len(problem.terms)), []
    by_stated = np.zeros((len(all_rows), len(STATED)))
    labels = [
        source.label
        for cycle in problem.numbers.cycles
        for source in cycle.hull.phasors.real.contributions
    ]
    serves = Counter(labels)
    for slope, share, cycle in zip(slopes, problem.shares, problem.numbers.cycles, strict=True):
        for source in cycle.hull.phasors.real.contributions:
            parts = slope @ problem.numbers.scatter(cycle, source)
            if serves[source.label] == 1:
                parts += _luck(problem, source.degrees_of_freedom) * (parts - share @ parts)
            contributions.append(
                Contribution(source.label, source.degrees_of_freedom, all_rows, parts)
            )
        by_stated += slope @ problem.numbers.sensitivity(cycle)
    by_stated += _by_own_speed(problem, values)
    for k, (name, spread) in enumerate(zip(STATED, stated.vector, strict=True)):
        if spread > 0.0:
            column = by_stated[:, k, None] * spread
            contributions.append(Contribution(name, stated.freedom(name), all_rows, column))
    return added(contributions)
