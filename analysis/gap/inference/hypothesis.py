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


def laplace_evidence(hypothesis: Hypothesis, products: Reduced) -> Evidence:
    """Return a hypothesis's log evidence by Laplace.

    Parameters
    ----------
    products
        Products of the target and the columns, in this order.
    """
    square, pull, data_precision = products.gram[0, 0], products.gram[1:, 0], products.gram[1:, 1:]
    about = Posterior.of(data_precision, pull)
    units = bounded_mode(about, hypothesis.bounds)
    cost = square - 2.0 * units @ pull + units @ data_precision @ units + units @ units
    volume = about.log_volume + any_size(about, hypothesis.sizes, hypothesis.reaches)
    return Evidence(-0.5 * float(cost + products.log_determinant) + volume, units, about)


def bounded_mode(posterior: Posterior, bounds: FloatArray) -> FloatArray:
    """Return the most probable parameters within their ranges, some of them at an end of these.

    Raises
    ------
    numpy.linalg.LinAlgError
        If the posterior's precision is not positive definite.
    """
    low, high = bounds
    if np.all((low <= posterior.mean) & (posterior.mean <= high)):
        return posterior.mean
    from scipy.optimize import lsq_linear  # half a second that few commands need

    # (u - m)^T P (u - m) as a sum of squares, least within the ranges
    root = np.linalg.cholesky(posterior.precision).T
    least = lsq_linear(root, root @ posterior.mean, (low, high), method="bvls")
    held = np.where(least.active_mask > 0, high, low)  # to the last digit
    return np.where(least.active_mask == 0, np.clip(least.x, low, high), held)
