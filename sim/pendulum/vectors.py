"""Sums and products of small vectors for the compiled loop, without a library call each."""

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


def total(a: float, one: FloatArray, b: float, other: FloatArray) -> FloatArray:
    """Return ``a one + b other``."""
    out = np.empty(one.size)
    for i in range(one.size):
        out[i] = a * one[i] + b * other[i]
    return out


def _by_arrays(a: float, one: FloatArray, b: float, other: FloatArray) -> FloatArray:
    return a * one + b * other


times = compile_loop(product) if available() else np.dot
combine = compile_loop(total) if available() else _by_arrays


@compile_loop
def vector(x: float, y: float, z: float) -> FloatArray:
    """Return the vector of three components."""
    out = np.empty(3)
    out[0], out[1], out[2] = x, y, z
    return out


@compile_loop
def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return a x b."""
    return vector(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
