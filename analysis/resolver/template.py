"""The resolver's basis ``[1, sin theta, cos theta, sin 2 theta, ...]`` over some samples."""

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

_FINE = 128  # samples that share one coarse phasor


def template(cycles: FloatArray, orders: FloatArray) -> FloatArray:
    """Return the basis for any orders at some phases, shape ``(2 * orders + 1, samples)``."""
    basis = np.empty((2 * len(orders) + 1, len(cycles)))
    basis[0] = 1.0
    for k, order in enumerate(orders):
        phase = 2.0 * np.pi * ((order * cycles) % 1.0)
        np.sin(phase, out=basis[2 * k + 1])
        np.cos(phase, out=basis[2 * k + 2])
    return basis


def straight_template(first_cycle: float, step: float, count: int, harmonics: int) -> FloatArray:
    """Return the basis where the phase runs straight, shape ``(2 * harmonics + 1, samples)``.

    The phase of sample ``k`` is ``first_cycle + k * step``, in cycles. A fine and a coarse row of
    phasors are multiplied (angle sums), so that sines are taken of a few samples only.
    """
    rows = -(-count // _FINE)
    fine = 2.0 * np.pi * (np.arange(_FINE) * step)
    coarse = 2.0 * np.pi * ((first_cycle + np.arange(rows) * (_FINE * step)) % 1.0)
    basis = np.empty((2 * harmonics + 1, rows, _FINE))
    basis[0] = 1.0
    sine, cosine = np.sin(coarse)[:, None], np.cos(coarse)[:, None]
    _angle_sum(sine, cosine, np.sin(fine), np.cos(fine), basis[1], basis[2])
    for n in range(2, harmonics + 1):
        below, here = 2 * n - 3, 2 * n - 1
        _angle_sum(basis[below], basis[below + 1], basis[1], basis[2], basis[here], basis[here + 1])
    return basis.reshape(2 * harmonics + 1, rows * _FINE)[:, :count]


def _angle_sum(
    sine: FloatArray,
    cosine: FloatArray,
    other_sine: FloatArray,
    other_cosine: FloatArray,
    sum_sine: FloatArray,
    sum_cosine: FloatArray,
) -> None:
    """Write the sine and cosine of the sum of two angles."""
    np.multiply(sine, other_cosine, out=sum_sine)
    sum_sine += cosine * other_sine
    np.multiply(cosine, other_cosine, out=sum_cosine)
    sum_cosine -= sine * other_sine
