"""Degrees of freedom of sums, and the intervals that follow from them."""

import numpy as np
from numpy.typing import ArrayLike

from hardware.description.arrays import FloatArray


def effective_freedom(variances: FloatArray, degrees_of_freedom: FloatArray) -> FloatArray:
    """Return the degrees of freedom of sums of independent inputs (Welch and Satterthwaite).

    The result has the shape ``(n,)``; infinite where no input that is known by repeats has a part.

    Parameters
    ----------
    variances
        Each input's part of each sum's variance, shape ``(inputs, n)``.
    degrees_of_freedom
        Of the inputs, shape ``(inputs,)`` or ``(inputs, n)``; an input without any counts as known
        for certain.
    """
    freedoms = np.where(degrees_of_freedom > 0.0, degrees_of_freedom, np.inf)
    loss = (variances**2 / (freedoms if freedoms.ndim > 1 else freedoms[:, None])).sum(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        freedom = variances.sum(axis=0) ** 2 / loss
    return np.asarray(np.where(loss > 0.0, freedom, np.where(np.isnan(loss), np.nan, np.inf)))


def student_factor(degrees_of_freedom: ArrayLike, level: float = 0.95) -> FloatArray:
    """Return how many standard deviations make the half-width of a two-sided interval.

    Parameters
    ----------
    degrees_of_freedom
        Any shape; normal where they are infinite, NaN where there are none.
    level
        Probability within the interval.
    """
    from scipy.special import ndtri, stdtrit

    place, freedom = 0.5 + level / 2.0, np.asarray(degrees_of_freedom, dtype=np.float64)
    endless = np.isinf(freedom)
    factor = stdtrit(np.where(endless, 1.0, freedom), place)
    return np.asarray(np.where(endless, ndtri(place), factor))
