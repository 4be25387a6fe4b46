"""What a further run is worth: the log odds that the right answer gains over all others."""

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

ENOUGH: Final = 20.0  # log odds beyond which more is worth no more


def gained(shares: Sequence[float], odds: FloatArray) -> float:
    """Return the log odds that the right answer gains over all others, over which it may be.

    Parameters
    ----------
    shares
        How probable each answer is, shape ``(answers,)``; they need not sum to 1.
    odds
        Expected log odds between each two of the answers after a run, ``(answers, answers)``.
    """
    if len(shares) < 2:
        return 0.0
    others = np.asarray(shares) * (1.0 - np.eye(len(shares)))
    left = np.sum(others * np.exp(-np.minimum(odds, ENOUGH)), axis=1)
    return float(np.average(np.log(others.sum(axis=1) / left), weights=shares))


def apart(means: FloatArray, roots: Sequence[FloatArray]) -> FloatArray:
    """Return the expected log odds between each two answers after a run, by symmetric divergence.

    Parameters
    ----------
    means
        What each answer predicts, shape ``(observations, answers)``.
    roots
        The root of its covariance without the noise, shape ``(observations, any)``.
    """
    squares = np.zeros((means.shape[1], means.shape[1]))
    for number, whole in enumerate(roots):
        root = whole[:, whole.any(axis=0)]  # frequency and noise are each run's own
        away = means - means[:, number, None]
        towards = np.linalg.solve(np.eye(root.shape[1]) + root.T @ root, root.T @ away)
        squares[number] = np.sum(away * (away - root @ towards), axis=0)
    return 0.25 * (squares + squares.T)
