"""Residuals of a fit: their spectrum widens the covariance, their structure shows a wrong model.

A damped sinusoid's parameters feel the noise near its own frequency only, an offset that near zero.
So each column of the covariance is widened by the residual's spectral density near its frequency
over the density that white noise of the same variance has.
"""

from dataclasses import dataclass

import numpy as np

from analysis.inertia.elementary_functions import inner
from hardware.description.arrays import FloatArray

_NEAR_BINS = 12  # bins of one cycle per record on either side
_STRUCTURE_BINS = 3
STRUCTURED = 20.0  # times the density further away


@dataclass(frozen=True)
class ResidualDiagnostics:
    """Spectrum and structure of a fit's residual.

    Attributes
    ----------
    rms
        Standard deviation of the residual, in the record's unit.
    lag1_correlation
        Correlation of neighbouring samples; near 0 for white noise.
    mode_inflation, offset_inflation
        Factors on the variances of each mode's parameters, shape ``(modes,)``, and of the offset.
    structure
        Residual power within three cycles per record of the modes, over that beside it: large where
        the model is wrong (period or decay vary with amplitude, another mode).
    """

    rms: float
    lag1_correlation: float
    mode_inflation: FloatArray
    offset_inflation: float
    structure: float

    @property
    def structured(self) -> bool:
        """Whether the model, not the noise, seems to be at fault."""
        return self.structure > STRUCTURED


def diagnose(
    residual: FloatArray, time_s: FloatArray, frequency_hz: FloatArray
) -> ResidualDiagnostics:
    """Return the diagnostics of a residual.

    Parameters
    ----------
    residual, time_s
        Shape ``(samples,)``; samples may be missing between.
    frequency_hz
        The modes' frequencies, shape ``(modes,)``.
    """
    grid = _on_grid(residual, time_s)
    density = np.abs(np.fft.rfft(grid)) ** 2 / residual.size
    variance = inner(residual, residual) / residual.size
    white = variance if variance > 0.0 else 1.0
    step = float(time_s[-1] - time_s[0]) / max(grid.size - 1, 1)
    bins = np.rint(np.abs(frequency_hz) * step * grid.size).astype(int)
    inflation = [_density(density, k, 1, _NEAR_BINS) / white for k in bins]
    inside = max((_density(density, k, 0, _STRUCTURE_BINS) for k in bins), default=0.0)
    background = min(
        (_density(density, k, _STRUCTURE_BINS + 1, 4 * _NEAR_BINS) for k in bins), default=1.0
    )
    neighbours = inner(residual[1:], residual[:-1]) / (residual.size * white)
    return ResidualDiagnostics(
        rms=float(np.sqrt(variance)),
        lag1_correlation=neighbours,
        mode_inflation=np.maximum(np.array(inflation), 1.0),
        offset_inflation=max(_density(density, 0, 1, _NEAR_BINS) / white, 1.0),
        structure=inside / background if background > 0.0 else 1.0,
    )


def _on_grid(residual: FloatArray, time_s: FloatArray) -> FloatArray:
    """Put samples on the even grid nearest to them, zero where missing."""
    step = float(np.median(np.diff(time_s)))
    place = np.rint((time_s - time_s[0]) / step).astype(int)
    if place[-1] + 1 > 4 * residual.size:
        return residual
    return np.bincount(place, residual).astype(np.float64)  # uneven ones that share a place add


def _density(density: FloatArray, centre: int, nearest: int, farthest: int) -> float:
    """Mean density of the bins at these distances on either side."""
    left = density[max(centre - farthest, 0) : max(centre - nearest + 1, 0)]
    right = density[max(centre + max(nearest, 1), 0) : centre + farthest + 1]
    count = left.size + right.size
    return float(left.sum() + right.sum()) / count if count else 0.0
