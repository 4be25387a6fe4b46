"""A first lag and clock rate: where short pieces of two channels correlate along one line."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.comparison.band import BandTrack
from analysis.comparison.warp import Warped
from hardware.description.arrays import FloatArray

FASTEST: Final = 0.02  # clock rate
_PERIODS: Final = 12.0  # of a piece: at the fastest rate its ends are a quarter of a period apart
_PIECES: Final = 64
_STEPS: Final = 8.0  # a period, in which the ends of the line are tried
_ALIKE: Final = 0.98  # of the highest correlation: one as good, as far as pieces tell


@dataclass(frozen=True)
class Alignment:
    """The second channel shows at ``t`` what the first shows at ``t - lag_s - rate (t - mid_s)``.

    Attributes
    ----------
    stretch
        Samples of the second channel that this was found in.
    """

    lag_s: float
    rate: float
    mid_s: float
    stretch: slice

    def times_s(self, time_s: FloatArray) -> FloatArray:
        """Return the times on the first channel's clock."""
        times: FloatArray = time_s - self.lag_s - self.rate * (time_s - self.mid_s)
        return times


def first_guess(
    warped: Warped, second: BandTrack, motion_hz: float, most_lag_s: float
) -> Alignment:
    """Try all lags and clock rates on the part of the record where most happens.

    The sum of the pieces' correlations along ``lag + rate t`` is the Radon transform of the
    correlogram; it is normalised by the first channel's power. Of several that are as good, the
    slowest rate and then the smallest lag are taken.
    """
    values = second.derivatives[0]
    size = max(8, min(int(_PERIODS / motion_hz * second.rate_hz), len(values) // 4))
    start, count = _most_power(values, size)
    stretch = slice(start, start + count * size)
    reach = int(most_lag_s * second.rate_hz) + 1
    time_s = second.time_s
    mid_s = float(time_s[stretch].mean())
    pieces = values[stretch].reshape(count, size)
    before_s = np.arange(-reach, size + reach) / second.rate_hz
    window_s = time_s[stretch].reshape(count, size)[:, :1] + before_s
    first = warped.values(window_s.ravel(), 0).reshape(window_s.shape)
    correlation, power = _correlograms(pieces, first)
    from_mid_s = time_s[stretch].reshape(count, size).mean(axis=1) - mid_s
    steps = int(_STEPS * FASTEST * motion_hz * count * size / second.rate_hz / 2.0) + 1
    rates = np.linspace(-FASTEST, FASTEST, 2 * steps + 1)
    tried = [
        _line_correlation(correlation, power, rate * from_mid_s * second.rate_hz) for rate in rates
    ]
    score = np.array(tried)
    row, place = _slowest(score, reach)
    return Alignment(float((reach - place) / second.rate_hz), float(rates[row]), mid_s, stretch)


def _most_power(values: FloatArray, size: int) -> tuple[int, int]:
    """Return the first sample and the number of the pieces around the middle of the power."""
    count = min(_PIECES, len(values) // size)
    power = values**2
    middle = float(np.arange(len(values)) @ power / power.sum())
    start = int(np.clip(middle - count * size / 2.0, 0, len(values) - count * size))
    return start, count


def _correlograms(pieces: FloatArray, first: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return each piece's correlation with the first channel, and its power, over all places."""
    from scipy.fft import irfft, next_fast_len, rfft

    size, length = pieces.shape[1], first.shape[1]
    long = next_fast_len(length + size, real=True)
    product = rfft(first, long) * rfft(pieces, long).conj()
    correlation = irfft(product, long)[:, : length - size + 1]
    total = np.cumsum(np.pad(first**2, ((0, 0), (1, 0))), axis=1)
    return correlation, total[:, size:] - total[:, :-size]


def _line_correlation(correlation: FloatArray, power: FloatArray, moved: FloatArray) -> FloatArray:
    """Return the correlation along one line, for each lag; ``moved`` samples of each piece."""
    shift = np.rint(moved).astype(np.int64)
    lags = np.arange(correlation.shape[1])
    at = np.clip(lags - shift[:, None], 0, len(lags) - 1)
    summed = np.take_along_axis(correlation, at, axis=1).sum(axis=0)
    energy = np.take_along_axis(power, at, axis=1).sum(axis=0)
    return np.asarray(np.abs(summed) / np.sqrt(energy + 0.01 * energy.max()))


def _slowest(score: FloatArray, reach: int) -> tuple[int, int]:
    middle = len(score) // 2
    good = np.flatnonzero(score.max(axis=1) >= _ALIKE * score.max())
    row = int(good[np.argmin(np.abs(good - middle))])
    best = score[row]
    inside = np.r_[False, (best[1:-1] >= best[:-2]) & (best[1:-1] >= best[2:]), False]
    tops = np.flatnonzero(inside & (best >= _ALIKE * best.max()))
    if not len(tops):
        return row, int(np.argmax(best))
    return row, int(tops[np.argmin(np.abs(tops - reach))])
