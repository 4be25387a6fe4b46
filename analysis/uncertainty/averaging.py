"""A value by several models, averaged by how well each describes the data."""

import numpy as np

from hardware.description.arrays import FloatArray


def averaged(
    values: FloatArray, variances: FloatArray, scores: FloatArray
) -> tuple[float, float, FloatArray]:
    """Return the mean over models, its variance, and the models' weights.

    The weights are Akaike's, ``exp(-score/2)``; what the models differ by is in the variance.

    Parameters
    ----------
    values, variances, scores
        Of each model: its value, the variance of that, and Akaike's criterion, shape ``(models,)``.
    """
    weights = np.exp(-0.5 * (scores - scores.min()))
    weights /= weights.sum()
    mean = float(weights @ values)
    return mean, float(weights @ (variances + (values - mean) ** 2)), weights
