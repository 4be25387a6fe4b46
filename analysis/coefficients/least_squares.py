"""Least squares of many trials at once, for columns known to be linearly independent."""

import numpy as np

from hardware.description.arrays import FloatArray


def least_squares(matrix: FloatArray, target: FloatArray) -> FloatArray:
    """Return the x that makes ``matrix @ x`` come nearest to ``target``.

    By the normal equations of columns scaled to one size. They double the digits that a fit loses,
    and whoever fits here has refused columns of which more than two would go; a decomposition of
    each trial takes several times as long.

    The result has the shape ``(trials, n)``.

    Parameters
    ----------
    matrix
        Shape ``(trials, equations, n)``.
    target
        Shape ``(trials, equations)``.
    """
    size = np.sqrt((matrix**2).sum(axis=-2, keepdims=True))
    scale = np.where(size > 0.0, size, 1.0)
    scaled = matrix / scale
    turned = scaled.swapaxes(-1, -2)
    solved = np.linalg.solve(turned @ scaled, turned @ target[..., None])
    return np.asarray(solved[..., 0] / scale[..., 0, :])
