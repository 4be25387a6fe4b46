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
def inner(one: FloatArray, other: FloatArray) -> float:
    """Return the inner product of two rows."""
    total = 0.0
    for k in range(one.size):
        total += one[k] * other[k]
    return total


@compile_loop
def largest(row: FloatArray) -> float:
    """Return the largest size of a row's values, NaN where one is not a number."""
    found = 0.0
    for k in range(row.size):
        size = abs(row[k])
        if size > found or math.isnan(size):
            found = size
    return found


@compile_loop
def product(one: FloatArray, other: FloatArray) -> FloatArray:
    """Return the product of two matrices."""
    found = np.zeros((one.shape[0], other.shape[1]))
    for i in range(one.shape[0]):
        for j in range(one.shape[1]):
            for k in range(other.shape[1]):
                found[i, k] += one[i, j] * other[j, k]
    return found


@compile_loop
def _pivot(left: FloatArray, gram: FloatArray, free: BoolArray) -> int:
    """Return the free direction of which most is left, or -1 where they all depend on others."""
    best, most = -1, _DEPENDENT
    for i in range(free.size):
        if free[i] and left[i, i] > most * gram[i, i]:
            best, most = i, left[i, i] / gram[i, i]
    return best


@compile_loop
def _eliminate(left: FloatArray, rest: FloatArray, free: BoolArray, best: int) -> None:
    """Take one direction off the others that are free."""
    for i in range(free.size):
        if free[i]:
            factor = left[i, best] / left[best, best]
            for j in range(free.size):
                left[i, j] -= factor * left[best, j]
            rest[i] -= factor * rest[best]


@compile_loop
def solve(gram: FloatArray, right: FloatArray) -> FloatArray:
    """Return the solution of ``gram x = right``, directions that depend on others left out.

    ``gram`` is symmetric without negative eigenvalues.
    """
    size = right.size
    left, rest = np.empty((size, size)), np.empty(size)
    for i in range(size):
        copy(gram[i], left[i])
    copy(right, rest)
    order, found = np.zeros(size, dtype=np.int64), np.zeros(size)
    free = np.ones(size, dtype=np.bool_)
    rank = 0
    for _ in range(size):
        best = _pivot(left, gram, free)
        if best < 0:
            break
        free[best] = False
        order[rank] = best
        rank += 1
        _eliminate(left, rest, free, best)
    for place in range(rank - 1, -1, -1):
        i = order[place]
        total = rest[i]
        for later in range(place + 1, rank):
            total -= left[i, order[later]] * found[order[later]]
        found[i] = total / left[i, i]
    return found
