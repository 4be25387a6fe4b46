"""Anderson's mixing of answers to a fixed point, compiled; the sweeps are the caller's."""

import numpy as np

from hardware.description.arrays import FloatArray
from sim.solve.array_loops import copy, inner, solve
from sim.solve.compilation import compile_loop


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
    weights = solve(gram, right)
    copy(answers[count - 1], at)
    for i in range(count - 1):
        for j in range(size):
            at[j] -= weights[i] * (answers[i + 1, j] - answers[i, j])
