"""The resolver's result for one gate: mean and harmonics of each channel, with uncertainty."""

from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property

import numpy as np

from analysis.uncertainty.freedom import student_factor
from hardware.description.arrays import FloatArray
from hardware.description.flags import Flag


class IntervalSource(StrEnum):
    """Where the uncertainty comes from."""

    PERIODS = "scatter between the gate's periods"
    NEIGHBOURS = "scatter between the periods around the gate"
    BINS = "lines beside the harmonics"
    NONE = "none: too few periods"


class DriftSource(StrEnum):
    """Where the drift that was taken out comes from."""

    GATE = "the gate's own periods"
    NEIGHBOURS = "the periods around the gate"
    NONE = "not taken out"


@dataclass(frozen=True)
class Harmonics:
    """Mean and harmonics 1 to N of each channel over one gate.

    ``y = A0 + sum S_n sin(n theta) + C_n cos(n theta)``: S in phase with the reference, C in
    quadrature (ahead of it); amplitude and phase are those of ``A_n sin(n theta + phi_n)``.

    Attributes
    ----------
    opened_s, closed_s, periods
        The gate: m whole periods of the reference.
    coefficients
        ``[A0, S1, C1, S2, C2, ...]``, shape ``(channels, K)`` with ``K = 2 N + 1``; the mean is
        that at the gate's middle where a drift was taken out.
    deviations
        Change of each coefficient per standard deviation of each of k deviates that are independent
        of each other and common to all channels, shape ``(channels, K, k)``; NaN where no interval
        can be given.
    degrees_of_freedom
        Shape ``(K,)``, for Student's t.
    widening
        How many times wider than in white noise of the same scatter an interval is for the memory
        that the periods show, 1 or more, shape ``(channels, K)``.
    drift_per_s
        Slope taken out, shape ``(channels,)``; zero where none was.
    """

    run: str
    channel_names: tuple[str, ...]
    units: tuple[str, ...]
    opened_s: float
    closed_s: float
    periods: int
    coefficients: FloatArray
    deviations: FloatArray
    degrees_of_freedom: FloatArray
    widening: FloatArray
    drift_per_s: FloatArray
    drift_source: DriftSource
    interval_source: IntervalSource
    estimator: str = "whole periods"
    flags: tuple[Flag, ...] = ()

    @property
    def order(self) -> int:
        """Highest harmonic."""
        return int(self.coefficients.shape[1] - 1) // 2

    @property
    def frequency_hz(self) -> float:
        """Mean frequency over the gate."""
        return self.periods / (self.closed_s - self.opened_s)

    @property
    def mean(self) -> FloatArray:
        """Mean of each channel, shape ``(channels,)``."""
        return self.coefficients[:, 0]

    @property
    def in_phase(self) -> FloatArray:
        """``S_n``, shape ``(channels, N)``."""
        return self.coefficients[:, 1::2]

    @property
    def quadrature(self) -> FloatArray:
        """``C_n``, shape ``(channels, N)``."""
        return self.coefficients[:, 2::2]

    @property
    def amplitude(self) -> FloatArray:
        """``A_n``, shape ``(channels, N)``."""
        return np.hypot(self.in_phase, self.quadrature)

    @property
    def phase_rad(self) -> FloatArray:
        """``phi_n`` in (-pi, pi], shape ``(channels, N)``."""
        return np.asarray(np.arctan2(self.quadrature, self.in_phase))

    @cached_property
    def covariance(self) -> FloatArray:
        """Of each channel's coefficients, shape ``(channels, K, K)``."""
        return np.asarray(self.deviations @ self.deviations.transpose(0, 2, 1))

    @property
    def standard_uncertainty(self) -> FloatArray:
        """One standard deviation of each coefficient, shape ``(channels, K)``."""
        return np.asarray(np.linalg.norm(self.deviations, axis=2))

    def coverage_factor(self, level: float = 0.95) -> FloatArray:
        """Return Student's t of a two-sided interval for each coefficient, shape ``(K,)``."""
        return student_factor(self.degrees_of_freedom, level)

    def half_width(self, level: float = 0.95) -> FloatArray:
        """Return the half-width of each coefficient's interval, shape ``(channels, K)``."""
        return self.standard_uncertainty * self.coverage_factor(level)

    def polar_uncertainty(self) -> tuple[FloatArray, FloatArray]:
        """Return one standard deviation of amplitude and of phase, shapes ``(channels, N)``.

        Along and across the phasor, to first order: fair where the amplitude is several times its
        uncertainty.
        """
        direction = np.stack((np.cos(self.phase_rad), np.sin(self.phase_rad)), axis=-1)
        across = np.stack((-direction[..., 1], direction[..., 0]), axis=-1)
        blocks = self.phasor_covariance()
        along = np.sqrt(np.einsum("cni,cnij,cnj->cn", direction, blocks, direction))
        sideways = np.sqrt(np.einsum("cni,cnij,cnj->cn", across, blocks, across))
        anywhere = np.full_like(sideways, np.pi)  # the phase of nothing
        turned = np.divide(sideways, self.amplitude, out=anywhere, where=self.amplitude > 0.0)
        return along, np.minimum(turned, np.pi)

    def phasor_covariance(self) -> FloatArray:
        """Return the covariance of ``(S_n, C_n)``, shape ``(channels, N, 2, 2)``."""
        pairs = np.arange(1, 2 * self.order + 1).reshape(self.order, 2)
        return self.covariance[:, pairs[:, :, None], pairs[:, None, :]]
