"""One period of a signal as harmonics, and the way to samples and back.

``x(t) = Re sum_n X_n exp(i n w t)``; time 0 is where the mean shaft angle is 0.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeAlias

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray

# Harmonics by signal name, shape (orders + 1,) each. The shaft angle's are those of what it has
# beyond w t; the photocell's edge time is one time within the period.
Spectra: TypeAlias = Mapping[str, ComplexArray]


@dataclass(frozen=True)
class Period:
    """One period of a periodic steady state.

    Attributes
    ----------
    frequency_hz
        At which the shaft really turns.
    orders
        Highest harmonic that is kept.
    points
        Samples of the period at which what is not linear is evaluated: even, more than 2 orders.
    """

    frequency_hz: float
    orders: int = 12
    points: int = 128

    @property
    def omega_rad_s(self) -> float:
        """Angular frequency."""
        return 2.0 * math.pi * self.frequency_hz

    @cached_property
    def s(self) -> ComplexArray:
        """Laplace variable i n w of each order, shape ``(orders + 1,)``; not to be written to."""
        s = np.zeros(self.orders + 1, dtype=np.complex128)
        s.imag = self.omega_rad_s * np.arange(self.orders + 1)
        s.setflags(write=False)
        return s

    @property
    def time_s(self) -> FloatArray:
        """Times of the points, shape ``(points,)``."""
        return np.arange(self.points) / (self.points * self.frequency_hz)

    @property
    def step_s(self) -> float:
        """Time from point to point."""
        return 1.0 / (self.points * self.frequency_hz)

    def at(self, frequency_hz: float) -> "Period":
        """Return the period at another frequency."""
        return replace(self, frequency_hz=frequency_hz)

    def values(self, harmonics: ComplexArray) -> FloatArray:
        """Return the values at the points; harmonics along the first axis."""
        half = harmonics * (self.points / 2.0)
        half[0] = harmonics[0].real * self.points
        values: FloatArray = np.fft.irfft(half, self.points, axis=0)
        return values

    def harmonics(self, values: FloatArray) -> ComplexArray:
        """Return the harmonics of values at the points, along the first axis."""
        spectrum = np.fft.rfft(values, axis=0)[: self.orders + 1]
        harmonics: ComplexArray = spectrum.astype(np.complex128) * (2.0 / self.points)
        harmonics[0] /= 2.0
        return harmonics

    def constant(self, value: float) -> ComplexArray:
        """Return the harmonics of a constant."""
        harmonics = np.zeros(self.orders + 1, dtype=np.complex128)
        harmonics[0] = value
        return harmonics


def apply(matrices: ComplexArray, vectors: ComplexArray) -> ComplexArray:
    """Return each harmonic's matrix times its vector."""
    product: ComplexArray = (matrices @ vectors[:, :, np.newaxis])[:, :, 0]
    return product
