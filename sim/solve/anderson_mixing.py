"""Anderson's mixing of answers to a fixed point, compiled; the sweeps are the caller's."""

import numpy as np

from hardware.description.arrays import BoolArray, FloatArray
from sim.solve.array_loops import copy, inner
from sim.solve.compilation import compile_loop

_DEPENDENT = 1e-12  # of a direction's square: what is left of it beside the others


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
def _weights(gram: FloatArray, right: FloatArray) -> FloatArray:
    """Return the solution of ``gram x = right``, directions that depend on others left out."""
    size = right.size
    left, rest = np.empty((size, size)), np.empty(size)
    for i in range(size):
        copy(gram[i], left[i])
    copy(right, rest)
    order, weights = np.zeros(size, dtype=np.int64), np.zeros(size)
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
            total -= left[i, order[later]] * weights[order[later]]
        weights[i] = total / left[i, i]
    return weights


@compile_loop
def mix(answers: FloatArray, changes: FloatArray, count: int, at: FloatArray) -> None:
    """Fill in the mean of the answers whose changes cancel best (Anderson); newest last."""
    size = at.size
    steps = np.empty((count - 1, size))
    for i in range(count - 1):
        for j in range(size):
            steps[i, j] = changes[i + 1, j] - changes[i, j]
    gram, right = np.zeros((count - 1, count - 1)), np.zeros(count - 1)
    for i in range(count - 1):
        right[i] = inner(steps[i], changes[count - 1])
        for j in range(count - 1):
            gram[i, j] = inner(steps[i], steps[j])
    weights = _weights(gram, right)
    copy(answers[count - 1], at)
    for i in range(count - 1):
        for j in range(size):
            at[j] -= weights[i] * (answers[i + 1, j] - answers[i, j])
