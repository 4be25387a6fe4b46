"""Plain loops over arrays for compiled loops.

numba takes seconds to compile an expression of whole arrays, with all that it checks and might say
of their shapes, and a few hundredths of one to compile these.
"""

import math

import numpy as np

from hardware.description.arrays import BoolArray, FloatArray
from sim.solve.compilation import compile_loop

_DEPENDENT = 1e-12  # of a direction's square: what is left of it beside the others


@compile_loop
def clear(harmonics: FloatArray) -> None:
    """Fill an array of three dimensions with zeros."""
    for i in range(harmonics.shape[0]):
        for j in range(harmonics.shape[1]):
            for k in range(harmonics.shape[2]):
                harmonics[i, j, k] = 0.0


@compile_loop
def copy(source: FloatArray, into: FloatArray) -> None:
    """Copy one row into another."""
    for k in range(into.size):
        into[k] = source[k]


@compile_loop
def inner(first: FloatArray, second: FloatArray) -> float:
    """Return the inner product of two rows."""
    total = 0.0
    for k in range(first.size):
        total += first[k] * second[k]
    return total


@compile_loop
def largest(row: FloatArray) -> float:
    """Return the largest size of a row's values, NaN where one is not a number."""
    most = 0.0
    for k in range(row.size):
        size = abs(row[k])
        if size > most or math.isnan(size):
            most = size
    return most


@compile_loop
def product(left: FloatArray, right: FloatArray) -> FloatArray:
    """Return the product of two matrices."""
    result = np.zeros((left.shape[0], right.shape[1]))
    for i in range(left.shape[0]):
        for j in range(left.shape[1]):
            for k in range(right.shape[1]):
                result[i, k] += left[i, j] * right[j, k]
    return result


@compile_loop
def _pivot(residual: FloatArray, gram: FloatArray, free: BoolArray) -> int:
    """Return the free direction of which most is left, or -1 where they all depend on others."""
    best, most = -1, _DEPENDENT
    for i in range(free.size):
        if free[i] and residual[i, i] > most * gram[i, i]:
            best, most = i, residual[i, i] / gram[i, i]
    return best


@compile_loop
def _eliminate(residual: FloatArray, rest: FloatArray, free: BoolArray, best: int) -> None:
    """Take one direction off the others that are free."""
    for i in range(free.size):
        if free[i]:
            factor = residual[i, best] / residual[best, best]
            for j in range(free.size):
                residual[i, j] -= factor * residual[best, j]
            rest[i] -= factor * rest[best]


@compile_loop
def solve(gram: FloatArray, right: FloatArray) -> FloatArray:
    """Return the solution of ``gram x = right``, directions that depend on others left out.

    ``gram`` is symmetric without negative eigenvalues.
    """
    size = right.size
    residual, rest = np.empty((size, size)), np.empty(size)
    for i in range(size):
        copy(gram[i], residual[i])
    copy(right, rest)
    order, solution = np.zeros(size, dtype=np.int64), np.zeros(size)
    free = np.ones(size, dtype=np.bool_)
    rank = 0
    for _ in range(size):
        best = _pivot(residual, gram, free)
        if best < 0:
            break
        free[best] = False
        order[rank] = best
        rank += 1
        _eliminate(residual, rest, free, best)
    for place in range(rank - 1, -1, -1):
        i = order[place]
        total = rest[i]
        for later in range(place + 1, rank):
            total -= residual[i, order[later]] * solution[order[later]]
        solution[i] = total / residual[i, i]
    return solution
