"""Plain loops over arrays for compiled loops.

numba takes seconds to compile an expression of whole arrays, with all that it checks and might say
of their shapes, and a few hundredths of one to compile these.
"""

import math

import numpy as np

from hardware.description.arrays import FloatArray
from sim.solve.compilation import compile_loop


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
