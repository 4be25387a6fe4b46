"""The compiled loops of :mod:`analysis.resolver.compiled`; importing this needs numba.

Plain module-level functions, so that numba finds them in its cache in the next process.
"""

from collections.abc import Callable
from typing import Any, TypeVar

import numba
import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

Function = TypeVar("Function", bound=Callable[..., Any])


def _compiled(function: Function) -> Function:
    """Compile a function on its first call, or take it from the cache."""
    options: Any = numba.njit(fastmath=True, cache=True, nogil=True)
    compiled: Function = options(function)
    return compiled


@_compiled
def _add(sums: FloatArray, values: FloatArray, basis: FloatArray) -> None:
    """Add products of the values with each row of the basis; pairs of rows share the loads."""
    plain = 0.0
    for j in range(len(values)):
        plain += values[j]
    sums[0] += plain
    for k in range(1, len(sums), 2):
        sines, cosines = basis[k], basis[k + 1]
        sine, cosine = 0.0, 0.0
        for j in range(len(values)):
            sine += values[j] * sines[j]
            cosine += values[j] * cosines[j]
        sums[k] += sine
        sums[k + 1] += cosine


@_compiled
def _tabulate(fine: FloatArray, step: float) -> None:
    """Write sines and cosines of the first steps: each run of 32 from the one before it."""
    run = 32
    for j in range(run):
        fine[0, j], fine[1, j] = np.sin(2.0 * np.pi * step * j), np.cos(2.0 * np.pi * step * j)
    for start in range(run, fine.shape[1], run):
        angle = 2.0 * np.pi * step * start
        sine, cosine = np.sin(angle), np.cos(angle)
        for j in range(run):
            fine[0, start + j] = sine * fine[1, j] + cosine * fine[0, j]
            fine[1, start + j] = cosine * fine[1, j] - sine * fine[0, j]


@_compiled
def _fill(
    basis: FloatArray, fine: FloatArray, first_cycle: float, harmonics: int, width: int
) -> None:
    """Write sines and cosines of harmonics 1 to N from the fine table (angle sums)."""
    angle = 2.0 * np.pi * (first_cycle % 1.0)
    sine, cosine = np.sin(angle), np.cos(angle)
    for j in range(width):
        basis[1, j] = sine * fine[1, j] + cosine * fine[0, j]
        basis[2, j] = cosine * fine[1, j] - sine * fine[0, j]
    for n in range(1, harmonics):
        for j in range(width):
            below_sine, below_cosine = basis[2 * n - 1, j], basis[2 * n, j]
            basis[2 * n + 1, j] = below_sine * basis[2, j] + below_cosine * basis[1, j]
            basis[2 * n + 2, j] = below_cosine * basis[2, j] - below_sine * basis[1, j]


@_compiled
def all_periods(
    samples: FloatArray,
    first: IntArray,
    count: IntArray,
    cycle: FloatArray,
    step: FloatArray,
    harmonics: int,
    chunk: int,
) -> FloatArray:
    """Sum ``b y`` over each period, all samples of weight 1.

    Parameters
    ----------
    samples
        Shape ``(channels, samples)``, rows contiguous.
    first, count, cycle, step
        First sample, number of samples, cycles there and per sample, shape ``(periods,)``.
    chunk
        Samples whose basis is held at a time.

    Returns
    -------
    numpy.ndarray
        Shape ``(periods, channels + 1, K)``; the last row holds ``b`` times the sample number.
    """
    channels = samples.shape[0]
    size = 2 * harmonics + 1
    sums = np.zeros((len(first), channels + 1, size))
    fine, basis, number = np.empty((2, chunk)), np.empty((size, chunk)), np.empty(chunk)
    for period in range(len(first)):
        _tabulate(fine, step[period])
        for start in range(0, count[period], chunk):
            width = min(chunk, count[period] - start)
            _fill(basis, fine, cycle[period] + start * step[period], harmonics, width)
            begin = first[period] + start
            for channel in range(channels):
                _add(sums[period, channel], samples[channel, begin : begin + width], basis)
            for j in range(width):
                number[j] = begin + j
            _add(sums[period, channels], number[:width], basis)
    return sums
