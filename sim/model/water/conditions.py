"""Least squares under linear conditions."""

from typing import Final

import numpy as np

from hardware.description.arrays import FloatArray

_RIDGE: Final = 1e-12  # of the largest singular value: what keeps coinciding columns apart


def least_squares(
    system: FloatArray,
    target: FloatArray,
    conditions: FloatArray | None = None,
    least: FloatArray | None = None,
) -> FloatArray:
    """Return the x that brings system x nearest to the target, with conditions x >= least.

    Least distance programming by non-negative least squares (Lawson and Hanson, Solving Least
    Squares Problems, 1974, ch. 23). Where no x meets the conditions, or the active ones do not
    settle, it is the x without conditions.

    Parameters
    ----------
    system, target
        Shapes ``(r, p)`` and ``(r,)``.
    conditions, least
        Shapes ``(c, p)`` and ``(c,)``; c may be 0.
    """
    norm = np.linalg.norm(system, axis=0)
    norm = np.where(norm > 0.0, norm, 1.0)
    left, sizes, right = np.linalg.svd(system / norm, full_matrices=False)
    back = (right.T / np.maximum(sizes, _RIDGE * sizes[0])) / norm[:, None]
    start = left.T @ target
    if conditions is not None and least is not None and least.size:
        matrix = conditions @ back
        start = start + _shortest_solution(matrix, least - matrix @ start)
    solution: FloatArray = back @ start
    return solution


def _shortest_solution(matrix: FloatArray, least: FloatArray) -> FloatArray:
    """Return the shortest x with matrix x >= least; zero where there is none."""
    from scipy.optimize import nnls

    size = np.linalg.norm(matrix, axis=1)
    system = np.vstack([matrix.T, least]) / np.where(size > 0.0, size, 1.0)
    scale = float(np.abs(system[-1]).max()) or 1.0
    system[-1] /= scale
    aim = np.append(np.zeros(len(system) - 1), 1.0)
    try:
        rest = system @ nnls(system, aim)[0] - aim
    except RuntimeError:
        return aim[:-1]
    return -rest[:-1] / rest[-1] * scale if rest[-1] else aim[:-1]
