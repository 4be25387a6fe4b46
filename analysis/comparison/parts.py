"""What a comparison leaves, part by part of the record and of the frequencies."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np

from analysis.comparison.fit import ComparisonFit
from analysis.comparison.linear import ComparisonProblem
from hardware.description.arrays import BoolArray, FloatArray

_PERIODS: Final = 5.0  # of the motion in a part of the record
_MOST: Final = 24
_GROUPS: Final = 8  # of frequencies
_SURE: Final = 1e-3  # probability by which scatter is chance


@dataclass(frozen=True)
class Parts:
    """Gain and lag of several parts beside those of the whole.

    Attributes
    ----------
    at
        Time in s on the second channel's clock, or frequency in Hz, shape ``(parts,)``.
    gain, gain_uncertainty
        Relative to that of the whole; one standard deviation.
    lag_s, lag_uncertainty_s
        What is left of the lag, in s.
    """

    at: FloatArray
    gain: FloatArray
    gain_uncertainty: FloatArray
    lag_s: FloatArray
    lag_uncertainty_s: FloatArray

    def excess(self, values: FloatArray, uncertainty: FloatArray, taken: int) -> float:
        """Return by how much the parts scatter more than their intervals; 1 where by chance.

        The Birge ratio (R. T. Birge, The calculation of errors by the method of least squares,
        1932).

        Parameters
        ----------
        taken
            Parameters that the whole has taken from them.
        """
        from scipy.stats import chi2

        freedom = len(values) - taken
        if freedom < 1:
            return 1.0
        squares = float(((values / uncertainty) ** 2).sum())
        return float(np.sqrt(squares / freedom)) if chi2.sf(squares, freedom) < _SURE else 1.0

    @property
    def gain_excess(self) -> float:
        """By how much the gains scatter more than their intervals, as :meth:`excess`."""
        return self.excess(self.gain - 1.0, self.gain_uncertainty, 1)


def over_time(problem: ComparisonProblem, fit: ComparisonFit) -> Parts:
    """Return the parts of the record, ten periods long or more."""
    from scipy.fft import irfft

    duration_s = fit.count / problem.second.rate_hz
    count = int(np.clip(duration_s * problem.motion_hz / _PERIODS, 1, _MOST))
    wide = _widened(fit.stands_out, 2 * count)
    rows = np.array([fit.shape, fit.columns[problem.channels], fit.residual])
    spectra = np.zeros((3, fit.count // 2 + 1), dtype=complex)
    last = fit.first_bin + len(fit.noise)
    scale = np.sqrt((fit.taper**2).mean() * fit.count)
    spectra[:, fit.first_bin : last] = np.where(wide, rows / np.sqrt(fit.noise), 0.0) * scale
    values = irfft(spectra, fit.count)
    edges = np.linspace(0, fit.count, count + 1).astype(int)
    part_values = [_part(*values[:, a:b]) for a, b in pairwise(edges)]
    times_s = problem.second.time_s[fit.start : fit.start + fit.count]
    middles = [float(times_s[a:b].mean()) for a, b in pairwise(edges)]
    return _parts(middles, part_values)


def over_frequency(problem: ComparisonProblem, fit: ComparisonFit) -> Parts:
    """Return the groups of frequencies, each harmonic by itself where there are harmonics."""
    bins = np.flatnonzero(fit.stands_out)
    breaks = np.flatnonzero(np.diff(bins) > 2) + 1
    groups = np.split(bins, breaks)
    if len(groups) > _GROUPS or len(groups) == 1:
        groups = np.array_split(bins, int(np.clip(len(bins) // 2, 1, _GROUPS)))
    part_values, frequencies_hz = [], []
    step_hz = problem.second.rate_hz / fit.count
    motion = fit.columns[problem.channels]
    for group in groups:
        weight = np.sqrt(2.0 / fit.noise[group])
        rows = [
            np.concatenate((column.real, column.imag))
            for column in (
                fit.shape[group] * weight,
                motion[group] * weight,
                fit.residual[group] * weight,
            )
        ]
        part_values.append(_part(*rows))
        power = np.abs(fit.shape[group]) ** 2
        frequencies_hz.append(float((group + fit.first_bin) @ power / power.sum()) * step_hz)
    return _parts(frequencies_hz, part_values)


def _widened(bins: BoolArray, reach: int) -> BoolArray:
    from scipy.ndimage import binary_dilation

    return np.asarray(binary_dilation(bins, iterations=reach))


def _part(shape: FloatArray, motion: FloatArray, residual: FloatArray) -> FloatArray:
    """Return change of gain, its uncertainty, change of lag and its uncertainty."""
    columns = np.array([shape, motion])
    inverse = np.linalg.pinv(columns @ columns.T, hermitian=True)
    gain, lag = inverse @ (columns @ residual)
    spread = np.sqrt(np.diag(inverse))
    return np.array([gain, spread[0], lag, spread[1]])


def _parts(places: list[float], part_values: list[FloatArray]) -> Parts:
    gain, gain_u, lag, lag_u = np.array(part_values).T
    return Parts(np.array(places), 1.0 + gain, gain_u, lag, lag_u)
