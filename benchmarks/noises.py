"""Noises of unit standard deviation, many channels at once."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
Noise = Callable[[int, FloatArray, np.random.Generator], FloatArray]
"""Draws noise, shape ``(channels, samples)``, at some cycles of the motion from mid-gate."""

SAMPLES_PER_PERIOD = 100.0  # of the motion, whose frequency the noises below refer to
_SLOSHING_ORDER, _SLOSHING_Q = 1.37, 20.0
_AR1 = 0.95


def white(channels: int, cycles: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Draw noise that knows nothing of the sample before."""
    return np.asarray(rng.standard_normal((channels, len(cycles))))


def autoregressive(channels: int, cycles: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Draw AR(1) noise of 0.95."""
    return _stationary(np.array([_AR1, 0.0]), channels, len(cycles), rng)


def sloshing(channels: int, cycles: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Draw the response of a resonator at 1.37 times the motion's frequency, Q = 20, to noise."""
    angle = 2.0 * np.pi * _SLOSHING_ORDER / SAMPLES_PER_PERIOD
    pole = np.exp(-angle / (2.0 * _SLOSHING_Q) + 1j * angle * np.sqrt(1 - 0.25 / _SLOSHING_Q**2))
    coefficients = np.array([2.0 * pole.real, -(abs(pole) ** 2)])
    return _stationary(coefficients, channels, len(cycles), rng)


def drift(channels: int, cycles: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Draw white noise on a straight drift of 1 per period, up or down, through 0 at mid-gate."""
    slope = rng.choice([-1.0, 1.0], channels)
    return np.asarray(white(channels, cycles, rng) + slope[:, None] * cycles)


def random_walk(channels: int, cycles: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Draw white noise on a random walk that strays by 1 (standard deviation) in a period."""
    steps = rng.standard_normal((channels, len(cycles))) / np.sqrt(SAMPLES_PER_PERIOD)
    return np.asarray(white(channels, cycles, rng) + np.cumsum(steps, axis=1))


def _stationary(
    coefficients: FloatArray, channels: int, samples: int, rng: np.random.Generator
) -> FloatArray:
    """Draw ``y_k = a1 y_(k-1) + a2 y_(k-2) + e_k``, in its steady state from the first sample."""
    from scipy.signal import lfilter

    first, second = coefficients
    correlation = first / (1.0 - second)
    drive = np.sqrt(1.0 - first * correlation - second * (first * correlation + second))
    last, other = rng.standard_normal((2, channels))
    before = correlation * last + np.sqrt(1.0 - correlation**2) * other
    memory = np.stack((first * last + second * before, second * last), axis=1)
    pushes = drive * rng.standard_normal((channels, samples))
    return np.asarray(lfilter([1.0], [1.0, -first, -second], pushes, zi=memory)[0])


NOISES: dict[str, Noise] = {
    "white": white,
    "ar1": autoregressive,
    "sloshing": sloshing,
    "drift": drift,
    "random_walk": random_walk,
}
