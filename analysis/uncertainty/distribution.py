"""Shapes that uncertain inputs are drawn from."""

import math
from enum import StrEnum

import numpy as np
from numpy.random import Generator

from hardware.description.arrays import FloatArray


class Distribution(StrEnum):
    """What is known about where an input lies."""

    NORMAL = "normal"  # Student's t where the degrees of freedom are finite
    UNIFORM = "uniform"


def shaped(
    normal: FloatArray, distribution: Distribution, degrees_of_freedom: float, generator: Generator
) -> FloatArray:
    """Return deviates of one input, of standard deviation 1.

    Parameters
    ----------
    normal
        Independent normal deviates, shape ``(k, trials)``; what is not normal draws its own.
    degrees_of_freedom
        Where finite, Student's t: one scale in each trial, common to the k deviates.
    """
    if distribution is Distribution.UNIFORM:
        return np.asarray(math.sqrt(3.0) * generator.uniform(-1.0, 1.0, normal.shape))
    if not 0.0 < degrees_of_freedom < np.inf:
        return normal
    chi_square = generator.chisquare(degrees_of_freedom, normal.shape[1])
    return np.asarray(normal * np.sqrt(degrees_of_freedom / chi_square))
