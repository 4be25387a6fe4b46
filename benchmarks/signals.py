"""Records whose truth is known."""

from dataclasses import dataclass

import numpy as np

from analysis.recording import Recording, Samples
from analysis.resolver.basis import harmonic_basis
from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel


@dataclass(frozen=True)
class Truth:
    """A motion and what it makes each channel read.

    Attributes
    ----------
    frequency_hz, opening_cycle
        Revolutions at time t are ``opening_cycle + frequency_hz t``.
    coefficients
        ``[A0, S1, C1, ...]``, shape ``(channels, K)``.
    """

    frequency_hz: float
    opening_cycle: float
    coefficients: FloatArray

    def cycles(self, times_s: FloatArray) -> FloatArray:
        """Return the revolutions at some times."""
        return np.asarray(self.opening_cycle + self.frequency_hz * times_s)

    def values(self, times_s: FloatArray) -> FloatArray:
        """Return what the channels read, shape ``(channels, samples)``."""
        orders = np.arange(1.0, (self.coefficients.shape[1] - 1) // 2 + 1.0)
        return np.asarray(self.coefficients @ harmonic_basis(self.cycles(times_s), orders))

    def edges_s(self, end_s: float) -> FloatArray:
        """Return the times of the photocell's pulses from 0 to ``end_s``."""
        turns = np.arange(np.ceil(self.opening_cycle), self.cycles(np.array([end_s]))[0])
        return np.asarray((turns - self.opening_cycle) / self.frequency_hz)


def draw_coefficients(
    amplitudes: tuple[float, ...], channels: int, rng: np.random.Generator
) -> FloatArray:
    """Return ``[A0, S1, C1, ...]`` of harmonics with random phases, shape ``(channels, K)``.

    Parameters
    ----------
    amplitudes
        Of the mean and of harmonics 1 to N.
    """
    phase = 2.0 * np.pi * rng.random((channels, len(amplitudes) - 1))
    coefficients = np.empty((channels, 2 * len(amplitudes) - 1))
    coefficients[:, 0] = amplitudes[0]
    coefficients[:, 1::2] = np.cos(phase) * amplitudes[1:]
    coefficients[:, 2::2] = np.sin(phase) * amplitudes[1:]
    return coefficients


def recorded(
    samples: Samples, sample_rate_hz: float, edges_s: FloatArray | None = None
) -> Recording:
    """Return samples, shape ``(channels, samples)``, as a recording from time 0 on."""
    channels = tuple(Channel(f"channel_{k}", "N") for k in range(samples.shape[0]))
    return Recording("benchmark", channels, samples, sample_rate_hz, photocell_edges_s=edges_s)
