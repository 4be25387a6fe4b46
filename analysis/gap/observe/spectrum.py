"""How loud each channel is at each frequency: the lines of the records that no harmonic reaches.

A harmonic is as uncertain as its channel is loud next to it. The scatter from cycle to cycle says
so too, but six cycles know it to 30 %, and they scatter as the photocell's pulses do, which is the
same for all channels and left free by itself. Between the harmonics of all runs there are some
hundred lines, in a time that no pulse defines.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from hardware.description.arrays import FloatArray

_ALIKE = 1e-10  # of the largest: squared size from which a direction is more than rounding
_BESIDE = 1.5  # bins on either side of a harmonic that its own leakage may reach
_FEWEST = 30  # lines
_CORNERS = 9
_SWEEPS = 5
_LOUD = 9.0  # times its density, which one line of noise in ten thousand reaches
_LEAST = 1e-3  # of the usual density
_COUNTED = 0.66  # lines under a Hann taper that tell something of their own
_MEDIAN = float(np.log(2.0))  # of a line's power over its mean, for Gaussian noise


@dataclass(frozen=True, eq=False)
class Lines:
    """Lines between the harmonics of one record.

    Attributes
    ----------
    density
        Two-sided power density, the channel's unit squared per Hz, shape ``(lines,)``.
    """

    frequency_hz: FloatArray
    density: FloatArray


def quiet_lines(
    time_s: FloatArray, values: FloatArray, frequency_hz: float, orders: int
) -> list[Lines]:
    """Return the lines between the harmonics of a record of whole periods, and below them.

    Parameters
    ----------
    time_s
        Of the samples, shape ``(samples,)``, evenly spaced.
    values
        Of each channel, shape ``(channels, samples)``.
    frequency_hz
        Of the oscillation.
    orders
        Harmonics up to which lines are wanted.
    """
    count, step_s = len(time_s), float(time_s[1] - time_s[0])
    basis = repeating(2.0 * np.pi * frequency_hz * (time_s - time_s[0]), 2 * orders)
    taper = np.hanning(count)
    weight = max(float(np.sum(taper**2)), np.finfo(float).tiny)  # of two samples nothing is left
    remainder = (values - (values @ basis) @ basis.T) * taper
    power = np.abs(np.fft.rfft(remainder, axis=1)) ** 2 / weight * step_s
    lines_hz = np.arange(power.shape[1]) / (count * step_s)
    beside_hz = np.abs(lines_hz - np.round(lines_hz / frequency_hz) * frequency_hz)
    quiet = (beside_hz > _BESIDE * lines_hz[1]) & (lines_hz < (orders + 1) * frequency_hz)
    return [Lines(lines_hz[quiet], row[quiet]) for row in power]


def repeating(angle_rad: FloatArray, orders: int) -> FloatArray:
    """Return an orthonormal basis of what repeats with an angle, and of a trend.

    Shape ``(samples, 2 + 2 orders)``, with fewer columns where the sampling folds some onto others.
    """
    count = len(angle_rad)
    columns = np.empty((2 + 2 * orders, count))
    columns[0], columns[1] = 1.0, np.linspace(-1.0, 1.0, count)
    turned = np.ones(count, dtype=np.complex128)
    first = np.exp(1j * angle_rad)
    for order in range(orders):
        turned *= first
        columns[2 + 2 * order], columns[3 + 2 * order] = turned.imag, turned.real
    # Columns that the sampling cannot tell apart are one: their difference is rounding.
    squares, ways = np.linalg.eigh(columns @ columns.T)
    apart = squares > _ALIKE * squares[-1]
    return np.asarray(columns.T @ (ways[:, apart] / np.sqrt(squares[apart])))


@dataclass(frozen=True)
class Loudness:
    """A channel's power density: white noise, and noise behind one pole.

    Amplifiers hiss, and what warms, settles or leaks has a time constant: two terms hold both
    within some per cent from a hundred lines, and tell the density at zero frequency too.

    Attributes
    ----------
    white, coloured
        Two-sided density in the channel's unit squared per Hz; of the second at zero frequency.
    """

    white: float
    coloured: float
    corner_hz: float

    def at(self, frequency_hz: float) -> float:
        """Return the density at a frequency."""
        return self.white + self.coloured / (1.0 + (frequency_hz / self.corner_hz) ** 2)


def loudness(records: Iterable[Lines]) -> Loudness | None:
    """Return what several records of a channel say together; ``None`` with too few lines.

    The most probable two terms by Whittle's likelihood, in which a line's power over its density is
    exponentially distributed. Lines far above it (the mains, an old wave) do not count as noise.
    """
    records = list(records)
    if sum(len(record.density) for record in records) < _FEWEST:
        return None
    lines_hz = np.concatenate([record.frequency_hz for record in records])
    power = np.concatenate([record.density for record in records])
    usual = float(np.median(power)) / _MEDIAN
    if not usual > 0.0:
        return None
    corners = np.geomspace(2.0 * lines_hz.min(), lines_hz.max(), _CORNERS)
    fits = [_fit_terms(lines_hz, power / usual, float(corner)) for corner in corners]
    best = min(fits, key=lambda pair: pair[0])[1]
    return Loudness(usual * best.white, usual * best.coloured, best.corner_hz)


@dataclass(frozen=True)
class Levels:
    """How loud single records are against what all say together, as logarithms of the power.

    Attributes
    ----------
    spread
        Standard deviation between the records, beyond what their few lines make of themselves.
    values, variances
        Of each record: drawn towards the usual level as far as the spread allows.
    """

    spread: float
    values: tuple[float, ...]
    variances: tuple[float, ...]


def levels(records: Sequence[Lines], usual: Loudness) -> Levels:
    """Return each record's own level: an empirical Bayes estimate (DerSimonian and Laird 1986).

    A record's median line over the usual density tells its level, with a variance of 1 / (n ln² 2)
    for n lines that count (Gaussian noise: powers are exponentially distributed).
    """
    log_levels = np.zeros(len(records))
    weight = np.zeros(len(records))
    for at, record in enumerate(records):
        if record.density.any():
            ratio = record.density / np.array([usual.at(hz) for hz in record.frequency_hz])
            log_levels[at] = math.log(float(np.median(ratio)) / _MEDIAN + _LEAST)
            weight[at] = _COUNTED * record.density.size * _MEDIAN**2
    if not weight.any():
        return Levels(0.0, (0.0,) * len(records), (0.0,) * len(records))
    middle = float(weight @ log_levels / weight.sum())
    spread = spread_about(np.ones((len(log_levels), 1)), log_levels, weight) ** 2
    drawn = spread * weight / (1.0 + spread * weight)
    values = middle + drawn * (log_levels - middle)
    variances = spread / (1.0 + spread * weight)
    return Levels(math.sqrt(spread), tuple(values.tolist()), tuple(variances.tolist()))


def spread_about(terms: FloatArray, values: FloatArray, weight: FloatArray) -> float:
    """Return the standard deviation that values have about what fits them, beyond their own.

    By moments, of weighted least squares (DerSimonian and Laird 1986).

    Parameters
    ----------
    terms
        What may fit them, shape ``(values, terms)``.
    weight
        Inverse variances of the values; 0 for one that is not known.
    """
    rooted = terms * np.sqrt(weight)[:, None]
    freedom = np.count_nonzero(weight) - int(np.linalg.matrix_rank(rooted))
    if freedom < 1:
        return 0.0
    basis = np.linalg.svd(rooted, full_matrices=False)[0][:, : np.linalg.matrix_rank(rooted)]
    scaled = values * np.sqrt(weight)
    remainder = scaled - basis @ (basis.T @ scaled)
    information = float(weight.sum() - np.sum(weight[:, None] * basis**2))
    return math.sqrt(max(0.0, float(remainder @ remainder) - freedom) / max(information, 1e-12))


def _fit_terms(lines_hz: FloatArray, power: FloatArray, corner_hz: float) -> tuple[float, Loudness]:
    """Return what a corner costs in log likelihood, and the two terms that fit best with it.

    Each sweep is a least squares with the variance that the sweep before has found.
    """
    from scipy.optimize import nnls

    terms = np.column_stack((np.ones_like(power), 1.0 / (1.0 + (lines_hz / corner_hz) ** 2)))
    density = np.ones_like(power)
    for _ in range(_SWEEPS):
        is_noise = power < _LOUD * density
        weight = 1.0 / density[is_noise]
        sizes = nnls(terms[is_noise] * weight[:, None], power[is_noise] * weight)[0]
        density = np.maximum(terms @ sizes, _LEAST)
    quiet = np.minimum(power / density, _LOUD)
    cost = float(np.sum(np.log(density) + quiet))
    return cost, Loudness(float(sizes[0]) + _LEAST, float(sizes[1]), corner_hz)
