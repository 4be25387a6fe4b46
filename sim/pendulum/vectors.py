"""Products of small vectors and matrices for the compiled loop, without a library call each.

numba keeps compiled code on disk and does not notice when a function of another file changes: who
changes one of these removes ``__pycache__``.
"""

import numpy as np

from hardware.description.arrays import FloatArray
from sim.solve.compilation import available, compile_loop


def product(matrix: FloatArray, vector: FloatArray) -> FloatArray:
    """Return a small matrix times a vector."""
    out = np.zeros(matrix.shape[0])
    for i in range(matrix.shape[0]):
        for j in range(vector.size):
            out[i] += matrix[i, j] * vector[j]
    return out


times = compile_loop(product) if available() else np.dot


@compile_loop
def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return a x b."""
    return np.array(
        (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
    )
