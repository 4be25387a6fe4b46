"""Synthetic runs of known content."""

from collections.abc import Callable

import numpy as np

from analysis.recording import Recording
from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel


def recording(values: FloatArray, sample_rate_hz: float = 100.0, **fields: object) -> Recording:
    """Make a run of plain channels in newtons."""
    values = np.atleast_2d(values)
    channels = tuple(Channel(f"force_{k}", "N") for k in range(len(values)))
    return Recording("synthetic", channels, values, sample_rate_hz, **fields)  # type: ignore[arg-type]


def series(coefficients: FloatArray, cycles: FloatArray) -> FloatArray:
    """``A0 + sum S_n sin + C_n cos`` for coefficients ``[A0, S1, C1, ...]``."""
    theta = 2.0 * np.pi * cycles
    values = np.full_like(theta, coefficients[0])
    for n in range(1, (len(coefficients) - 1) // 2 + 1):
        values += coefficients[2 * n - 1] * np.sin(n * theta)
        values += coefficients[2 * n] * np.cos(n * theta)
    return values


def resonance(
    generator: np.random.Generator, shape: tuple[int, int], cycles_per_sample: float, quality: float
) -> FloatArray:
    """Narrow-band noise of unit variance: white noise through a resonance, settled."""
    from scipy.signal import lfilter

    radius = np.exp(-np.pi * cycles_per_sample / quality)
    poles = [1.0, -2.0 * radius * np.cos(2.0 * np.pi * cycles_per_sample), radius**2]
    return _settled(lambda white: lfilter([1.0], poles, white), generator, shape)


def autoregressive(
    generator: np.random.Generator, shape: tuple[int, int], memory: float
) -> FloatArray:
    """First-order autoregressive noise of unit variance, settled."""
    from scipy.signal import lfilter

    return _settled(lambda white: lfilter([1.0], [1.0, -memory], white), generator, shape)


def _settled(
    colour: Callable[[FloatArray], FloatArray],
    generator: np.random.Generator,
    shape: tuple[int, int],
) -> FloatArray:
    lead = 2000
    noise = colour(generator.normal(size=(shape[0], shape[1] + lead)))[:, lead:]
    return np.asarray(noise / noise.std())
