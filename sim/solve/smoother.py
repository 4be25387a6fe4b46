"""Measured motion as the three signals that a chain needs: displacement, velocity, acceleration.

Samples are never differenced. A periodic motion goes in by its gated harmonics
(:func:`from_harmonics`); any other by a :class:`Smoother`, whose transfer function and noise are
known, so that what it takes away or lets through can enter an uncertainty.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.errors import ConfigurationError, DataError


class MeasuredMotion(NamedTuple):
    """Displacement (m), velocity (m/s) and acceleration (m/s2), shape ``(samples,)`` each."""

    displacement: FloatArray
    velocity: FloatArray
    acceleration: FloatArray


def from_harmonics(
    harmonics: ComplexArray, frequency_hz: float, time_s: FloatArray
) -> MeasuredMotion:
    """Return the motion that harmonics describe, ``x(t) = Re sum X_n exp(i n w t)``.

    Parameters
    ----------
    harmonics
        The mean and each order, shape ``(orders + 1,)``.
    """
    s = 2j * math.pi * frequency_hz * np.arange(harmonics.size)
    waves = np.exp(np.multiply.outer(time_s, s))
    return MeasuredMotion(*((waves @ (harmonics * s**d)).real for d in range(3)))


@dataclass(frozen=True)
class Smoother:
    """A polynomial fitted to the samples around each one (Savitzky and Golay).

    Value, slope and curvature of the polynomial in its middle are weighted sums of ``2 half_width
    + 1`` samples. A motion that is a polynomial of that degree comes through unchanged; what is
    taken from a sine is :meth:`gain`, what is left of white noise is :meth:`noise_gain`.

    Attributes
    ----------
    half_width
        Samples to either side.
    degree
        Of the polynomial.

    Raises
    ------
    ConfigurationError
        If the samples do not determine the polynomial, or its degree is below 2.
    """

    half_width: int
    degree: int = 4

    def __post_init__(self) -> None:
        if self.degree < 2 or 2 * self.half_width < self.degree:
            raise ConfigurationError(
                f"half_width = {self.half_width} and degree = {self.degree}: the degree must be at "
                f"least 2 and at most twice the half width"
            )

    def weights(self, derivative: int, sample_rate_hz: float) -> FloatArray:
        """Return the weights of the samples, oldest first, for derivative 0, 1 or 2."""
        nodes = np.arange(-self.half_width, self.half_width + 1) / max(self.half_width, 1)
        rows = np.linalg.pinv(np.vander(nodes, self.degree + 1, increasing=True))
        unit = (sample_rate_hz / max(self.half_width, 1)) ** derivative
        weights: FloatArray = rows[derivative] * math.factorial(derivative) * unit
        return weights

    def gain(
        self, derivative: int, frequency_hz: FloatArray, sample_rate_hz: float
    ) -> ComplexArray:
        """Return what comes out per true derivative of a sine: 1 where nothing is lost.

        Parameters
        ----------
        frequency_hz
            Shape ``(k,)``; above 0 for derivatives 1 and 2.
        """
        shifts = np.arange(-self.half_width, self.half_width + 1) / sample_rate_hz
        s = 2j * math.pi * np.asarray(frequency_hz, dtype=np.float64)
        summed = np.exp(np.multiply.outer(s, shifts)) @ self.weights(derivative, sample_rate_hz)
        gain: ComplexArray = summed / s**derivative
        return gain

    def noise_gain(self, derivative: int, sample_rate_hz: float) -> float:
        """Return the standard deviation that white noise of 1 m in the samples leaves."""
        return float(np.linalg.norm(self.weights(derivative, sample_rate_hz)))

    def motion(self, displacement: FloatArray, sample_rate_hz: float) -> MeasuredMotion:
        """Return the motion at every sample that has ``half_width`` others on either side.

        Parameters
        ----------
        displacement
            Evenly spaced samples, shape ``(samples,)``. The result is ``2 half_width`` shorter and
            begins with the sample of number ``half_width``.

        Raises
        ------
        DataError
            If there are too few samples, or one is not finite.
        """
        needed = 2 * self.half_width + 1
        if displacement.ndim != 1 or displacement.size < needed:
            raise DataError(
                f"a smoother of half_width {self.half_width} needs at least {needed} samples in a "
                f"row; {displacement.shape} were given"
            )
        bad = int(np.count_nonzero(~np.isfinite(displacement)))
        if bad:
            raise DataError(f"{bad} of {displacement.size} displacements are not finite")
        return MeasuredMotion(
            *(
                np.convolve(displacement, self.weights(d, sample_rate_hz)[::-1], mode="valid")
                for d in range(3)
            )
        )
