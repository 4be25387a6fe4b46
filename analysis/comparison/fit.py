"""Gain, lag and clock rate by least squares over frequencies, each weighed by its noise.

With the first channel ``a`` brought to the second one's clock, the second is to first order

    b(t) = sum g_j a_j(s) - dlag z'(s) - drate (t - mid) z'(s) + noise,    z = sum g_j a_j,

at ``s = t - lag - rate (t - mid)``. All are tapered alike and transformed, and the sum over bins of
``|residual|^2 / R`` is made small, R being the noise's spectrum found from the residual itself
(P. Whittle, Estimation and information in stationary time series, 1953). ``R`` holds the noise of
both channels. Bins where ``a`` stands little out of the noise carry no column: noise in a column
would draw the gain down.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np

from analysis.comparison.first_guess import FASTEST
from analysis.comparison.linear import (
    ComparisonProblem,
    Linear,
    Model,
    NothingInCommonError,
    linearised,
)
from hardware.description.arrays import BoolArray, ComplexArray, FloatArray

_STANDS_OUT: Final = 20.0  # power over the noise's; noise alone is that strong once in e^20
_WIDEST: Final = 32  # bins on each side over which the noise's spectrum is smoothed
_FLATTER: Final = 1  # times that a smoothed spectrum is taken off before it is smoothed again
_STEPS: Final = 20
_FEWEST: Final = 3  # steps
_UNEXPLAINED: Final = 0.5  # of the power where the first channel stands out
_LOST: Final = 2.0 * FASTEST  # clock rate: no clock, a fit that has left what was found
_SETTLED: Final = 0.02  # of an uncertainty, in the last step
_ROUNDING: Final = 1e-12  # of the mean power: splines and filters are no better


@dataclass(frozen=True, eq=False)
class ComparisonFit:
    """A model and what it leaves.

    Attributes
    ----------
    covariance
        Of ``[gains, lag, rate]``, half the dead band where it is fitted, and a level and a slope.
    freedom
        Degrees of freedom of the noise's spectrum.
    start
        First sample of the second channel.
    columns
        Spectra of the model's derivatives in the bins that count, shape ``(parameters, bins)``.
    shape
        Spectrum of what the model says of the second channel, shape ``(bins,)``.
    residual, noise
        Spectrum of what is left, and the mean of its squared magnitude, shape ``(bins,)``.
    stands_out
        Which bins carry the channels.
    first_bin
        The bins' own place in the transform.
    """

    model: Model
    covariance: FloatArray
    freedom: float
    start: int
    taper: FloatArray
    columns: ComplexArray
    shape: ComplexArray
    residual: ComplexArray
    noise: FloatArray
    power: FloatArray
    stands_out: BoolArray
    first_bin: int

    @property
    def count(self) -> int:
        """Samples of the second channel."""
        return len(self.taper)

    @property
    def uncertainty(self) -> FloatArray:
        """One standard deviation of each parameter."""
        return np.asarray(np.sqrt(np.diag(self.covariance)))

    @cached_property
    def squares(self) -> float:
        """Sum of squares of the residual in the bins that carry the channels, over the noise."""
        return self.squares_under(self.noise, self.stands_out)

    @property
    def noise_spread(self) -> float:
        """One standard deviation of the noise, in the second channel's unit."""
        return self.spread_of(self.noise)

    @cached_property
    def first_noise_power(self) -> FloatArray:
        """Power of what is left that goes as the first channel does where that carries nothing.

        It is the first channel's own noise, shape ``(bins,)``, also between and under the lines.
        """
        free, reach = ~self.stands_out, _reach(self.shape)
        cross = self.residual * self.shape.conj() * free
        size = np.hypot(_local_mean(cross.real, reach), _local_mean(cross.imag, reach))
        first_power = _local_mean(np.abs(self.shape) ** 2 * free, reach)
        share = np.maximum(_local_mean(free.astype(np.float64), reach), 0.5 / (2 * reach + 1))
        heard = size**2 / np.maximum(first_power, _ROUNDING * self.power.mean()) / share
        return np.asarray(np.minimum(heard, _local_mean(np.abs(self.residual) ** 2, reach)))

    def spread_of(self, power: FloatArray) -> float:
        """Return one standard deviation of a part of that power, in the second channel's unit."""
        return float(np.sqrt(2.0 * power.sum() / (self.taper**2).mean()) / self.count)

    def with_uncertainty(self, row: int, u: float) -> "ComparisonFit":
        """Return the same with a parameter's uncertainty, and what follows of it for the others."""
        slope = self.covariance[row] / self.covariance[row, row]
        growth = (u**2 - self.covariance[row, row]) * np.outer(slope, slope)
        return replace(self, covariance=self.covariance + growth)

    def squares_under(self, noise: FloatArray, bins: BoolArray) -> float:
        """Return the same under another noise, in other bins."""
        return float((2.0 * np.abs(self.residual[bins]) ** 2 / noise[bins]).sum())


def fit(problem: ComparisonProblem, model: Model, *, lines: bool = False) -> ComparisonFit:
    """Improve a model until it moves no more.

    Its gains are found anew. The lag must be right within a quarter of the motion's period or so.

    Parameters
    ----------
    lines
        Whether lines that the model does not explain yet are no noise: for a dead band, which makes
        harmonics.

    Raises
    ------
    NothingInCommonError
        If there is no frequency at which the second channel follows the first.
    """
    noise, bins = np.ones(0), np.ones(0, dtype=bool)
    for step in range(_STEPS):
        linear = linearised(problem, model)
        if noise.size != linear.target.size:
            noise, bins = np.ones(linear.target.size), _strongest_bins(linear)
        if not step:
            model = replace(model, gains=_gains(linear, bins, noise))
        columns = linear.columns(model.gains, bins)
        theta, inverse = _solve(columns, linear.residual(model.gains), noise)
        before, model = model, _moved_model(model, theta)
        nuisances = linear.other_derivatives(before.gains)
        residual = linear.residual(model.gains) - theta[problem.channels :] @ nuisances
        hidden = (columns.conj() * (inverse @ columns)).sum(axis=0).real if step else 0.0
        noise, reach = _smoothed(np.abs(residual) ** 2 + hidden, linear.target, lines=lines)
        power = _local_mean(np.abs(model.gains @ linear.channels) ** 2, 1)
        bins = power > _STANDS_OUT * noise
        if not bins.any():
            bins = _strongest_bins(linear)
        taken = np.abs(model.parameters - before.parameters)  # a dead band stays at none
        if step >= _FEWEST and (taken <= _SETTLED * np.sqrt(np.diag(inverse))[: len(taken)]).all():
            break
    residual_power, shown = (np.abs(spectrum[bins]) ** 2 for spectrum in (residual, linear.target))
    if residual_power.sum() > _UNEXPLAINED * shown.sum() or abs(model.alignment.rate) > _LOST:
        raise NothingInCommonError
    columns = linear.columns(before.gains, bins)
    freedom = max(2.0 * (2 * reach + 1) - len(columns), 1.0)
    # The weights are of the same record: they cost twice what their own scatter is.
    covariance = _covariance(columns, noise, linear) * (1.0 + 4.0 / freedom)
    return ComparisonFit(
        model, covariance, freedom, linear.start, linear.taper, columns,
        linear.target - residual, residual, noise, power, bins, linear.first_bin,
    )  # fmt: skip


def _gains(linear: Linear, bins: BoolArray, noise: FloatArray) -> FloatArray:
    columns = np.concatenate((linear.channels * bins, linear.drift))
    theta, _ = _solve(columns, linear.target, noise)
    return theta[: len(linear.channels)]


def _solve(
    columns: ComplexArray, target: ComplexArray, noise: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the parameters and the inverse of the normal equations."""
    weighted = columns.conj() / noise
    scale = np.sqrt(np.maximum((np.abs(columns) ** 2 / noise).sum(axis=1), 1e-300))
    normal = 2.0 * (weighted @ columns.T).real / np.outer(scale, scale)
    right = 2.0 * (weighted @ target).real / scale
    inverse = np.linalg.pinv(normal, hermitian=True)
    return inverse @ right / scale, inverse / np.outer(scale, scale)


def _moved_model(model: Model, theta: FloatArray) -> Model:
    at = len(model.gains)
    where = model.alignment
    alignment = replace(where, lag_s=where.lag_s + theta[at], rate=where.rate + theta[at + 1])
    half = model.half
    if half is not None:
        half = max(0.0, half + float(theta[at + 2]))
    return Model(alignment, model.gains + theta[:at], half)


def _strongest_bins(linear: Linear) -> BoolArray:
    """Return the bins in which both carry the most, for a start: a derivative lifts noise."""
    power = _local_mean(np.abs(linear.channels[0] * linear.target), 1)
    return np.asarray(power >= 0.01 * power.max())


def _reach(spectrum: ComplexArray) -> int:
    return int(np.clip(len(spectrum) // 10, 1, _WIDEST))


def _local_mean(values: FloatArray, reach: int) -> FloatArray:
    from scipy.ndimage import uniform_filter1d

    return np.asarray(uniform_filter1d(values, 2 * reach + 1, mode="reflect"))


def _smoothed(power: FloatArray, target: ComplexArray, *, lines: bool) -> tuple[FloatArray, int]:
    """Return the noise's spectrum, and over how many bins on each side it is smoothed.

    Parameters
    ----------
    power
        Of the residual, and what the fit has taken from it.
    """
    from scipy.ndimage import median_filter

    reach = _reach(target)
    floor = _ROUNDING * float((np.abs(target) ** 2).mean())
    power = np.maximum(power, 1e-3 * floor)
    if lines:
        usual = median_filter(power, 2 * reach + 1, mode="reflect") / np.log(2.0)
        return np.maximum(usual, floor), reach
    noise = _local_mean(power, reach)
    for _ in range(_FLATTER):  # smoothed flat: a steep spectrum is no lower beside its foot
        noise = noise * _local_mean(power / noise, reach)
    return np.maximum(noise, floor), reach


def _covariance(columns: ComplexArray, noise: FloatArray, linear: Linear) -> FloatArray:
    """Return the parameters' covariance, the taper's part in it and all.

    The estimate is a sum of the samples of the noise, each with a weight that the taper makes; the
    noise itself is not tapered.
    """
    from scipy.fft import irfft, rfft

    _, inverse = _solve(columns, linear.target, noise)
    count, last = len(linear.taper), linear.first_bin + linear.target.size
    padded = np.zeros((len(columns), count // 2 + 1), dtype=complex)
    padded[:, linear.first_bin : last] = columns / noise
    weights = rfft(irfft(padded, count) * linear.taper)[:, linear.first_bin : last]
    untapered = noise / (linear.taper**2).mean()
    middle = 2.0 * (weights * untapered @ weights.conj().T).real
    return np.asarray(inverse @ middle @ inverse)
