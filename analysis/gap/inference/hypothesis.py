"""Effects as one equation weighs them: linear about where they were fitted."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from analysis.gap.inference.gaussian import Posterior, any_size
from analysis.gap.inference.gram import Reduced
from hardware.description.arrays import BoolArray, FloatArray


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """Named effects, linear about where they were fitted.

    Attributes
    ----------
    names
        Of the effects.
    target
        Measured minus simulated with the effects' signature at their zero by the slopes, in sigma,
        shape ``(observations,)``.
    columns
        Their slopes per prior deviation, shape ``(observations, p)``.
    forms
        What the other forms of their families change, ``(observations, any)``.
    bounds
        Plausible ranges in prior units, shape ``(2, p)``.
    sizes, reaches
        For each effect which parameters are sizes, shape ``(p,)``, and how far they may reach.
    """

    names: tuple[str, ...]
    target: FloatArray
    columns: FloatArray
    forms: FloatArray
    bounds: FloatArray
    sizes: Sequence[BoolArray]
    reaches: Sequence[float]


@dataclass(frozen=True, eq=False)
class Evidence:
    """What a hypothesis is worth under one covariance, and where its parameters then are."""

    log_evidence: float
    units: FloatArray
    posterior: Posterior


def weighed(one: Hypothesis, found: Reduced) -> Evidence:
    """Return a hypothesis's log evidence by Laplace.

    Parameters
    ----------
    found
        Products of the target and the columns, in this order.
    """
    square, pull, told = found.gram[0, 0], found.gram[1:, 0], found.gram[1:, 1:]
    covariance = np.asarray(np.linalg.inv(np.eye(len(told)) + told), np.float64)
    about = Posterior(covariance @ pull, covariance)
    units = within(about, one.bounds)
    cost = square - 2.0 * units @ pull + units @ told @ units + units @ units
    volume = about.log_volume + any_size(about, one.sizes, one.reaches)
    return Evidence(-0.5 * float(cost + found.log_determinant) + volume, units, about)


def within(found: Posterior, bounds: FloatArray) -> FloatArray:
    """Return the most probable parameters within their ranges.

    One that would leave its range is held at its end, and the others are found anew.
    """
    low, high = bounds
    target = found.precision @ found.mean
    units, free = found.mean.copy(), np.ones(len(found.mean), dtype=bool)
    for _ in range(len(units)):
        outside = free & ((units < low) | (units > high))
        if not outside.any():
            break
        free &= ~outside
        units = np.where(free, units, np.clip(units, low, high))
        pull = target[free] - found.precision[np.ix_(free, ~free)] @ units[~free]
        units[free] = np.linalg.solve(found.precision[np.ix_(free, free)], pull)
    return np.asarray(np.clip(units, low, high), np.float64)
