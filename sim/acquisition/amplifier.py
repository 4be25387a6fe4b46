"""What stands between a sensor and the converter: amplifier filter, carrier, and sampling delay."""

import math
from dataclasses import dataclass
from enum import StrEnum
from functools import lru_cache
from typing import Final

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.errors import ConfigurationError
from hardware.description.motor import UNKNOWN_KEYS_REFUSED
from sim.solve.linear_system import Hold, LinearSystem, causal_hold

FILTER_DEGREE: Final = 5  # of the polynomial between samples; error 0.014 (w h)^6
_NODES: Final = 6  # samples that a delay interpolates


class FilterKind(StrEnum):
    """The family of a low-pass."""

    RC = "rc"
    BUTTERWORTH = "butterworth"
    BESSEL = "bessel"


@dataclass(frozen=True)
class LowPass:
    """An amplifier's low-pass, 3 dB down at ``cutoff_hz``; its gain at 0 is 1.

    Attributes
    ----------
    order
        Number of poles; an RC has one.

    Raises
    ------
    ConfigurationError
        If the cutoff or the order is out of range.
    """

    cutoff_hz: float
    kind: FilterKind = FilterKind.RC
    order: int = 1

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def __post_init__(self) -> None:
        if not (math.isfinite(self.cutoff_hz) and self.cutoff_hz > 0.0):
            raise ConfigurationError(f"cutoff_hz = {self.cutoff_hz} must be a positive number")
        most = 1 if self.kind is FilterKind.RC else 10
        if not 1 <= self.order <= most:
            raise ConfigurationError(f"order = {self.order} of a {self.kind} filter: 1 to {most}")

    @property
    def system(self) -> LinearSystem:
        """The filter as a state space."""
        return _low_pass(self)

    def response(self, s: ComplexArray) -> ComplexArray:
        """Return the transfer function at Laplace variables, in their shape."""
        return self.system.response(s)[:, 0, 0]

    def hold(self, step_s: float) -> Hold:
        """Return the filter's exact step from sample to sample."""
        return _low_pass_hold(self, step_s)

    def settled(self, value: float) -> FloatArray:
        """Return the filter's states after a long constant input."""
        return np.linalg.solve(self.system.A, -value * self.system.B[:, 0]).astype(np.float64)


@lru_cache(maxsize=64)
def _low_pass(filter_: LowPass) -> LinearSystem:
    from scipy import signal

    omega = 2.0 * math.pi * filter_.cutoff_hz
    if filter_.kind is FilterKind.BESSEL:
        poles = signal.bessel(filter_.order, 1.0, analog=True, norm="mag", output="zpk")[1]
    else:
        poles = signal.butter(filter_.order, 1.0, analog=True, output="zpk")[1]
    # Scaled by the cutoff, so that states of any order are of the size of the input.
    denominator = np.real(np.poly(poles))
    A = np.zeros((filter_.order, filter_.order))
    A[:-1, 1:] = np.eye(filter_.order - 1)
    A[-1] = -denominator[:0:-1]
    B = np.zeros((filter_.order, 1))
    B[-1] = denominator[-1]
    return LinearSystem(A * omega, B * omega, np.eye(1, filter_.order), np.zeros((1, 1)))


@lru_cache(maxsize=64)
def _low_pass_hold(filter_: LowPass, step_s: float) -> Hold:
    return causal_hold(filter_.system, step_s, FILTER_DEGREE)


@dataclass(frozen=True)
class BridgeCarrier:
    """A carrier on the bridge.

    Amplitude modulation, band-limited amplifier and phase-sensitive rectifier together act on the
    signal as the low-pass after the rectifier does, times the cosine of the rectifier's phase
    error; what they leave at twice the carrier is far beyond any low-pass that is in use. So the
    demodulated signal is simulated by that equivalent, and the low-pass is the channel's own.

    Attributes
    ----------
    phase_error_rad
        Of the rectifier against the carrier.
    demodulated
        False to record the modulated signal itself: the value times cos(2 pi f t).
    """

    frequency_hz: float = 1000.0
    phase_error_rad: float = 0.0
    demodulated: bool = True

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def modulation(self, time_s: FloatArray) -> FloatArray | float:
        """Return the factor by which the carrier multiplies the signal."""
        if self.demodulated:
            return math.cos(self.phase_error_rad)
        phase = 2.0 * math.pi * self.frequency_hz * time_s + self.phase_error_rad
        return np.asarray(np.cos(phase), dtype=np.float64)


def delay_weights(delay_s: float, sample_rate_hz: float) -> FloatArray:
    """Return the weights of the newest samples (newest first) that give the value a delay ago.

    The polynomial of fifth degree through the six samples nearest to the wanted time: relative
    error below (w h)^6 / 60, for a signal that is smooth between the samples. Noise is added after
    it and so is never interpolated.
    """
    late = delay_s * sample_rate_hz
    first = max(0, math.floor(late) - _NODES // 2 + 1)
    nodes = np.arange(first, first + _NODES, dtype=np.float64)
    weights = np.zeros(first + _NODES)
    for j, node in enumerate(nodes):
        other_nodes = np.delete(nodes, j)
        weights[first + j] = np.prod((late - other_nodes) / (node - other_nodes))
    return weights
