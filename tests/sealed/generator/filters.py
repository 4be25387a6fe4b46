"""Amplifiers' filters of several poles, exact for what is straight between samples."""

import math

import numpy as np
from numpy.typing import NDArray

from tests.sealed.generator.parameters import FloatArray

Complex = NDArray[np.complex128]

_BESSEL = (1.0, 10.0, 45.0, 105.0, 105.0)  # reverse Bessel polynomial of order 4: delay 1 s


def butterworth(poles: int, cutoff_hz: float) -> Complex:
    """Return the poles of a Butterworth filter, rad/s."""
    k = np.arange(1, poles + 1)
    turn = np.exp(0.5j * math.pi * (2 * k + poles - 1) / poles)
    return np.asarray(2.0 * math.pi * cutoff_hz * turn)


def bessel(cutoff_hz: float) -> Complex:
    """Return the four poles of a Bessel filter whose delay at rest is 1/(2 pi cutoff)."""
    return np.asarray(2.0 * math.pi * cutoff_hz * np.roots(_BESSEL))


def filtered(rows: FloatArray, poles: Complex, rate_hz: float) -> FloatArray:
    """Return rows behind simple poles with unit gain at rest, settled at their first samples."""
    from scipy.signal import lfilter

    h, out = 1.0 / rate_hz, np.zeros(rows.shape, dtype=np.complex128)
    for i, s in enumerate(poles):
        others = np.delete(poles, i)
        residue = np.prod(-poles) / np.prod(s - others)
        e = np.exp(s * h)
        ramp = (e - 1.0 - s * h) / (s * s * h)
        late, early = residue * ramp, residue * ((e - 1.0) / s - ramp)
        start = -residue / s * rows[:, :1]
        state = start - late * rows[:, :1]
        out += lfilter([late, early], [1.0, -e], rows, axis=1, zi=state)[0]
    return np.asarray(out.real)
