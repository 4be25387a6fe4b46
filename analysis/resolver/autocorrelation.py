"""How much autocorrelated noise widens an interval, from the sequence of the periods' values.

The mean of m values has the standard deviation of one over the root of m only where they are
independent. Noise with memory (a slow wander of the mean, a wave so near a harmonic that it beats
slowly against the periods) shows in the sequence of the periods' values, but in ten of them no
estimate of its spectrum is sure. So the interval is averaged over the spectra that the noise may
have, each weighted by how well it explains the sequence: a Bayesian average over covariances, with
a flat prior for the level (and the drift's line) and Jeffreys' for the size. The spectra are:

* white, by far the likeliest beforehand;
* the Lorentzian of a memory that fades as ``exp(-d / tau)``;
* flicker noise, ``1 / f`` down to a hundredth of the lowest frequency in the gate;
* a slow beat, of a line narrower than the gate resolves.

Each but the first lies on white noise, 1, 10 or 1000 times as large in what can be seen of it. The
parts of a harmonic share their spectrum, along the axes of their scatter, so that another zero of
the phase turns the intervals and changes nothing else. For the mean there is one more witness:
noise around the harmonics, from their own scatter. A mean that scatters more than these betrays a
spectrum that rises towards zero frequency before its own sequence could.

A process of covariance ``k(d)`` enters by ``G`` with ``G'' = k``, whose second differences are the
covariances of averages over stretches.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from analysis.uncertainty.freedom import student_factor
from hardware.description.arrays import FloatArray

Doubled = Callable[[FloatArray], FloatArray]

LEVEL = 0.95
"""Of the interval that is widened: the factor is that of the half-width at this level."""
_WHITE = 0.92
"""Probability of white noise beforehand: 0.96, half as much for all others, costs 1 to 2 % of the
coverage in flicker noise at ten periods; 0.84, twice as much, widens intervals in white noise."""
_SIZES = (1.0, 10.0, 1000.0)  # of the coloured part over the white one, in the variance seen
_LONGEST = 2.0
"""Longest fading memory, gates. With half of it intervals in long memory are 0.7 times as wide and
those in flicker noise at ten periods cover 1 to 2 % less; with more, wider without end."""
_SHORTEST = 0.1  # fading memory, periods: below it the periods' averages are as good as white
_FLICKER = 100.0  # gates: only its logarithm counts
_MOST_BLOCKS = 64
"""Above so many periods they are averaged in blocks: what decides is slow, and time goes with the
cube."""


@dataclass(frozen=True)
class _Spectra:
    """The noises that may be, for a sequence of some length; first axis: which.

    Attributes
    ----------
    contrasts
        Orthonormal, shape ``(blocks, n)``: the sequence without its level, and line.
    whitening
        Shape ``(spectra, n, n)``; ``log_determinant`` is of the covariance.
    variance
        Of the gate's mean, where white noise has 1.
    around
        Variance of the parts of harmonics 1 to N where white noise has 1, shape
        ``(spectra, N)``.
    log_prior
        Shape ``(spectra,)``.
    """

    contrasts: FloatArray
    whitening: FloatArray
    log_determinant: FloatArray
    variance: FloatArray
    around: FloatArray
    log_prior: FloatArray


@dataclass(frozen=True)
class _ScatterTest:
    """Sum of squares of the scatter around each harmonic, in variances of a mean in white noise.

    Attributes
    ----------
    squares
        Shape ``(channels, N)``.
    degrees
        Of freedom, of both parts together.
    """

    squares: FloatArray
    degrees: int


def widened(residuals: FloatArray, cycles: FloatArray, gate_periods: int, line: bool) -> FloatArray:
    """Return the deviations of some periods, as large as the noise's memory makes them count.

    It is of the same shape; no smaller than ``residuals``.

    Parameters
    ----------
    residuals
        Each period's coefficients ``[A0, S1, C1, ...]`` about their mean, and the drift's line
        where one was taken out, shape ``(periods, channels, K)``; two periods or more.
    cycles
        Where each period opens, shape ``(periods,)``.
    gate_periods
        Periods of the gate whose mean is asked for.
    line
        Whether a drift was taken out of the means.
    """
    count, orders = len(residuals), residuals.shape[2] // 2
    block = -(-count // _MOST_BLOCKS)
    first = count % block
    numbers = np.rint(cycles[first::block] - cycles[first]).astype(int)
    spectrum_key = tuple(numbers.tolist()), block, gate_periods, orders
    wider, quiet = residuals.copy(), []
    for n in range(1, orders + 1):
        pair = residuals[:, :, 2 * n - 1 : 2 * n + 1]
        products = np.einsum("pci,pcj->cij", pair, pair)
        axes = np.linalg.eigh(products)[1]
        components = np.einsum("pci,cij->pcj", pair, axes)
        components *= _factors(_blocks(components, block), _spectra(*spectrum_key, line=False))
        wider[:, :, 2 * n - 1 : 2 * n + 1] = np.einsum("pcj,cij->pci", components, axes)
        quiet.append(np.trace(products, axis1=1, axis2=2))
    if len(numbers) > 1 + line:
        # In white noise a part has twice a mean's variance.
        witness = _ScatterTest(np.stack(quiet, axis=1) / 2.0 / block, 2 * (count - 1))
        means = _blocks(residuals[:, :, :1], block)
        wider[:, :, :1] *= _factors(means, _spectra(*spectrum_key, line=line), witness)
    return wider


def _blocks(values: FloatArray, block: int) -> FloatArray:
    """Return averages over so many periods each; those that are over at the start are left out."""
    first = len(values) % block
    return np.asarray(values[first:].reshape(-1, block, *values.shape[1:]).mean(axis=1))


def _factors(
    blocks: FloatArray, spectra: _Spectra, witness: _ScatterTest | None = None
) -> FloatArray:
    """Return the factors of sequences that share a spectrum, shape ``(channels, sequences)``."""
    contrasts = np.einsum("bn,bcs->csn", spectra.contrasts, blocks)
    freedom = contrasts.shape[-1]
    white = (contrasts**2).sum(axis=-1)[:, None]
    varying = white > 0.0
    white = np.where(varying, white, 1.0)
    squares = (np.einsum("knm,csm->cksn", spectra.whitening, contrasts) ** 2).sum(axis=-1) / white
    silent = np.exp(-spectra.log_determinant / freedom)[:, None]  # a constant tells no spectrum
    squares = np.where(varying, squares, silent)
    fit = spectra.log_prior - blocks.shape[2] * spectra.log_determinant / 2.0
    if witness is None:
        fit = fit - freedom / 2.0 * np.log(squares).sum(axis=2)
    else:
        quietest = witness.squares.argmin(axis=1)
        around = spectra.around[:, quietest].T
        heard = witness.squares.min(axis=1)[:, None] / white[:, :, 0] / around
        fit = fit - witness.degrees / 2.0 * np.log(around)
        fit = fit - (freedom + witness.degrees) / 2.0 * np.log(squares[:, :, 0] + heard)
    weight = np.exp(fit - fit.max(axis=1, keepdims=True))
    weight /= weight.sum(axis=1, keepdims=True)
    scale = np.sqrt(spectra.variance[:, None] * squares)
    return np.maximum(_half_width(weight[:, :, None], scale, freedom), 1.0)


def _half_width(weight: FloatArray, scale: FloatArray, freedom: int) -> FloatArray:
    """Half-width of a mixture of Student's t about 0, over that of a t of scale 1.

    The spectra are on the second axis. The probability within is concave in the half-width, so
    Newton's steps from below stay there.
    """
    from scipy.special import gammaln, stdtr

    factor = float(student_factor(freedom, LEVEL))
    log_peak = gammaln((freedom + 1) / 2.0) - gammaln(freedom / 2.0) - np.log(freedom * np.pi) / 2.0
    half = factor * scale.min(axis=1)
    for _ in range(60):
        reach = half[:, None] / scale
        within = (weight * (2.0 * stdtr(freedom, reach) - 1.0)).sum(axis=1)
        density = np.exp(log_peak - (freedom + 1) / 2.0 * np.log1p(reach**2 / freedom)) / scale
        step = (LEVEL - within) / (2.0 * (weight * density).sum(axis=1))
        half = half + step
        if np.all(np.abs(step) <= 1e-6 * half):
            break
    return np.asarray(half / factor)


@lru_cache(maxsize=16)
def _spectra(
    numbers: tuple[int, ...], block: int, gate_periods: int, orders: int, *, line: bool
) -> _Spectra:
    """Return the spectra for blocks of periods that open at some numbers of periods."""
    opening = np.array(numbers, dtype=np.float64)
    columns = np.stack((np.ones_like(opening), opening - opening.mean())[: 1 + line], axis=1)
    contrasts = np.linalg.qr(columns, mode="complete")[0][:, 1 + line :]
    distances = np.abs(np.subtract.outer(opening, opening))
    identity = np.eye(contrasts.shape[1])
    covariances, variance, around = [identity], [1.0], [np.ones(orders)]
    for doubled in _colours(opening[-1] + block):
        covariance = contrasts.T @ _mean_covariance(doubled, distances, block) @ contrasts * block
        share = len(covariance) / np.trace(covariance)
        long = float(_mean_covariance(doubled, np.zeros(1), gate_periods)[0]) * gate_periods
        parts = _parts(doubled, orders)
        for size in _SIZES:
            covariances.append(identity + size * share * covariance)
            variance.append(1.0 + size * share * long)
            around.append(1.0 + size * share * parts)
    factor = np.linalg.cholesky(np.array(covariances))
    prior = np.full(len(covariances), (1.0 - _WHITE) / (len(covariances) - 1))
    prior[0] = _WHITE
    return _Spectra(
        contrasts,
        np.asarray(np.linalg.inv(factor), dtype=np.float64),
        2.0 * np.log(np.diagonal(factor, axis1=1, axis2=2)).sum(axis=1),
        np.array(variance),
        np.array(around),
        np.log(prior),
    )


def _colours(gate: float) -> list[Doubled]:
    """Return ``G`` of each colour, of distances in periods, for a sequence of so many periods."""
    steps = int(2.0 * np.log10(_LONGEST * gate / _SHORTEST)) + 1
    fading = [_fading(_LONGEST * gate * 10.0 ** (-k / 2.0)) for k in range(steps)]
    return [*fading, _flicker(_FLICKER * gate), _beat(gate)]


def _fading(tau: float) -> Doubled:
    return lambda d: tau**2 * np.expm1(-d / tau) + tau * d


def _flicker(longest: float) -> Doubled:
    """Of ``k = log(longest / d)``."""

    def doubled(d: FloatArray) -> FloatArray:
        return np.asarray(d**2 / 2.0 * (np.log(longest / np.where(d > 0.0, d, longest)) + 1.5))

    return doubled


def _beat(length: float) -> Doubled:
    """Of ``k = exp(-d^2 / (2 length^2))``: lines about the harmonic, narrower than the gate."""
    from scipy.special import erf

    def doubled(d: FloatArray) -> FloatArray:
        z = d / length
        root = np.sqrt(np.pi / 2.0) * z * erf(z / np.sqrt(2.0))
        return np.asarray(length**2 * (np.expm1(-(z**2) / 2.0) + root))

    return doubled


def _mean_covariance(doubled: Doubled, distances: FloatArray, length: float) -> FloatArray:
    """Return the covariance of averages over stretches of some length that open so far apart."""
    neighbours = doubled(distances + length) + doubled(np.abs(distances - length))
    return np.asarray((neighbours - 2.0 * doubled(distances)) / length**2)


def _parts(doubled: Doubled, orders: int) -> FloatArray:
    """Variance of the parts of harmonics 1 to N of one period over that in white noise."""
    cells = 32 * orders
    lag = np.arange(cells) / cells
    covariance = _mean_covariance(doubled, lag, 1.0 / cells) * (1.0 - lag) * 2.0 / cells
    covariance[0] /= 2.0
    turned = np.cos(2.0 * np.pi * np.outer(np.arange(1.0, orders + 1.0), lag))
    return np.asarray(turned @ covariance)
