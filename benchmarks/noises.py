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


def remembering(correlation: float) -> Noise:
    """Return AR(1) noise of a correlation from sample to sample."""

    def draw(channels: int, cycles: FloatArray, rng: np.random.Generator) -> FloatArray:
        return _stationary(np.array([correlation, 0.0]), channels, len(cycles), rng)

    return draw


def flicker(channels: int, cycles: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Draw noise whose spectrum is ``1 / f`` down to a sixteenth of the record's lowest."""
    length = 16 * len(cycles)
    size = 1.0 / np.sqrt(np.arange(1.0, length // 2 + 1.0))
    drawn = np.empty((channels, len(cycles)))
    for row in drawn:
        parts = size * (rng.standard_normal(len(size)) + 1j * rng.standard_normal(len(size)))
        whole = np.fft.irfft(np.concatenate(([0.0], parts)), length)
        row[:] = whole[: len(cycles)]
    return np.asarray(drawn / (np.sqrt(2.0) * np.sqrt((size**2).sum()) * np.sqrt(2.0) / length))


def wave(order: float, decay_periods: float = np.inf) -> Noise:
    """Return a wave of amplitude 1 beside the motion's frequency, in white noise of 0.2."""

    def draw(channels: int, cycles: FloatArray, rng: np.random.Generator) -> FloatArray:
        phase = rng.uniform(0.0, 2.0 * np.pi, (channels, 1))
        size = np.exp(-(cycles - cycles[0]) / decay_periods)
        beside = size * np.cos(2.0 * np.pi * order * cycles + phase)
        return np.asarray(beside + 0.2 * white(channels, cycles, rng))

    return draw


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

MEMORIES: dict[str, Noise] = {
    "white": white,
    "ar1 0.9": remembering(0.9),
    "ar1 0.99": remembering(0.99),
    "ar1 0.995": remembering(0.995),
    "flicker": flicker,
    "random walk": random_walk,
}
"""What the mean's interval meets: from no memory to one that outlasts any gate."""

BEATS: dict[str, Noise] = {
    "1.05 w": wave(1.05),
    "1.02 w": wave(1.02),
    "0.9 w": wave(0.9),
    "1.2 w": wave(1.2),
    "1.02 w, decays in 5": wave(1.02, 5.0),
    "1.02 w, decays in 15": wave(1.02, 15.0),
    "1.05 w, decays in 5": wave(1.05, 5.0),
}
"""What the first harmonic's interval meets: waves that beat slowly against the periods."""
