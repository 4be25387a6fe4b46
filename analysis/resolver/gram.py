"""The sums ``sum w b b^T`` of the basis alone, in closed form where the phase runs straight.

Products of the basis are sums of phasors ``exp(i n theta)`` of orders up to twice the harmonics,
and a phasor's sum over evenly spaced samples is a geometric series.
"""

from functools import cache

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray, IntArray


def phasor_series(
    first_cycle: FloatArray, step: FloatArray, count: IntArray, highest: int
) -> tuple[ComplexArray, ComplexArray]:
    """Sum ``exp(i n theta)`` over ``count`` samples whose cycles are ``first_cycle + k * step``.

    Returns
    -------
    sums, moments
        For n = 0 to ``highest``, shape ``(periods, highest + 1)``: of the phasors, and of the
        phasors times the samples' distance from the middle one.
    """
    orders = np.arange(1, highest + 1)
    middle = (first_cycle + step * (count - 1) / 2.0)[:, None] * orders
    turned = np.exp(2j * np.pi * (middle % 1.0))
    half = np.pi * step[:, None] * orders
    sine, whole = np.sin(half), count[:, None] * half
    kernel = np.sin(whole) / sine
    # Its derivative by the angle from one sample to the next.
    slope = (count[:, None] * np.cos(whole) - kernel * np.cos(half)) / (2.0 * sine)
    plain = count[:, None].astype(np.complex128)
    sums = np.concatenate((plain, kernel * turned), axis=1)
    return sums, np.concatenate((0.0 * plain, -1j * slope * turned), axis=1)


def gram_of(sums: ComplexArray, harmonics: int) -> FloatArray:
    """Turn sums of phasors, shape ``(periods, 2 N + 1)``, into those of ``b b^T``."""
    order = np.arange(-harmonics, harmonics + 1)
    both = order[:, None] + order
    phasors = np.where(both >= 0, sums[:, np.abs(both)], sums[:, np.abs(both)].conj())
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
