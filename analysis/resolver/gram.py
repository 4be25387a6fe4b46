"""The sums ``sum w b b^T`` of the basis alone, in closed form where the phase runs straight."""

from functools import cache

import numpy as np
from numpy.typing import NDArray

from analysis.resolver.weights import REACH

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


def straight_gram(
    first_cycle: float, step: float, weights: FloatArray, harmonics: int
) -> FloatArray:
    """Return ``sum w b b^T`` over samples whose phase is ``first_cycle + k * step`` (in cycles).

    Products of the basis are sums of phasors of orders up to twice the harmonics, and a phasor's
    sum over even samples is a geometric series; only the edges' weights differ from 1.

    Parameters
    ----------
    weights
        As :func:`analysis.resolver.weights.gate_weights` returns them: 1 but near the edges.
    """
    sums = _phasor_sums(first_cycle, step, weights, 2 * harmonics)
    order = np.arange(-harmonics, harmonics + 1)
    both = order[:, None] + order
    phasors = np.where(both >= 0, sums[np.abs(both)], sums[np.abs(both)].conj())
    mixing = _mixing(harmonics)
    return np.asarray((mixing @ phasors @ mixing.T).real)


@cache
def _mixing(harmonics: int) -> ComplexArray:
    """Matrix from the phasors ``exp(i n theta)``, n = -N to N, to the basis."""
    matrix = np.zeros((2 * harmonics + 1, 2 * harmonics + 1), dtype=np.complex128)
    matrix[0, harmonics] = 1.0
    for n in range(1, harmonics + 1):
        matrix[2 * n - 1, harmonics + n], matrix[2 * n - 1, harmonics - n] = -0.5j, 0.5j
        matrix[2 * n, harmonics + n], matrix[2 * n, harmonics - n] = 0.5, 0.5
    return matrix


def _phasor_sums(
    first_cycle: float, step: float, weights: FloatArray, highest: int
) -> ComplexArray:
    """Weighted sums of ``exp(i n theta)`` for n = 0 to ``highest``."""
    ends = min(2 * REACH, len(weights) // 2)
    count = len(weights) - 2 * ends
    middle = first_cycle + step * (ends + (count - 1) / 2.0)
    orders = np.arange(1, highest + 1)
    series = np.sin(np.pi * count * step * orders) / np.sin(np.pi * step * orders)
    sums = np.concatenate(([float(count)], series)) * np.exp(
        2j * np.pi * ((middle * np.arange(highest + 1)) % 1.0)
    )
    number = np.concatenate((np.arange(ends), np.arange(len(weights) - ends, len(weights))))
    phase = (first_cycle + step * number) % 1.0
    edges = np.exp(2j * np.pi * np.outer(np.arange(highest + 1), phase))
    return np.asarray(sums + edges @ weights[number])
