"""Where two channels have their power, and what of them is kept: low-passed, at a working rate."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError

_POWER: Final = 0.999  # part of a channel's power that lies below its edge
_TAPER: Final = 0.2  # of a record, both ends together
_LONGEST: Final = 1 << 18  # samples that are transformed at a time: a band needs no finer lines
_OVER_FLOOR: Final = 10.0  # a line of noise lies higher once in a thousand, by 10 ln 2
_RATE: Final = 15.0  # working rate over the edge, where the record is sampled faster
_LEAST_RATE: Final = 8.0  # the same, below which a record is sampled anew: 1e-5 of a quintic spline
_HIGHEST: Final = 0.4  # highest frequency that counts, over the working rate
_BELOW_NYQUIST: Final = 0.45  # the same, over the rate of the record
_HARMONICS: Final = 6.0  # the same, over the edge: what a dead band makes of a line
_POWER_OF_COSINE: Final = 8  # of the filters' window, which ends smoothly enough for derivatives
_HALF_WIDTH: Final = 5.0  # of that window, times the filter's transition
_FINE: Final = 16  # steps a sample in which a filter is differentiated


@dataclass(frozen=True)
class Band:
    """Frequencies of two channels in Hz: that of the motion, the edge of its power, the highest."""

    motion_hz: float
    edge_hz: float
    top_hz: float


@dataclass(frozen=True)
class BandTrack:
    """A channel at its working rate, each derivative low-passed alike.

    Attributes
    ----------
    derivatives
        Shape ``(orders, samples)``, from the lowest order that was asked for.
    """

    start_s: float
    rate_hz: float
    derivatives: FloatArray

    @property
    def time_s(self) -> FloatArray:
        """Times of the samples."""
        times: FloatArray = self.start_s + np.arange(self.derivatives.shape[1]) / self.rate_hz
        return times

    @property
    def end_s(self) -> float:
        """Time of the last sample."""
        return self.start_s + float(self.derivatives.shape[1] - 1) / self.rate_hz


def find_band(first: FloatArray, second: FloatArray, rates_hz: tuple[float, float]) -> Band:
    """Return the band of the channel that has its power lowest: what both can show.

    Parameters
    ----------
    first, second
        Without mean and slope.
    """
    edges = [edge_of(values, rate) for values, rate in zip((first, second), rates_hz, strict=True)]
    motion_hz, edge_hz = min(edges, key=lambda edge: edge[1])
    return Band(motion_hz, edge_hz, min(_HARMONICS * edge_hz, _BELOW_NYQUIST * min(rates_hz)))


def edge_of(values: FloatArray, rate_hz: float) -> tuple[float, float]:
    """Return where half of the power lies below, and nearly all of it."""
    from scipy.fft import next_fast_len, rfft
    from scipy.signal.windows import tukey

    pieces = -(-len(values) // _LONGEST)
    count = len(values) // pieces
    parts = values[: count * pieces].reshape(pieces, count) * tukey(count, _TAPER)
    power = (np.abs(rfft(parts, next_fast_len(count, real=True))) ** 2).sum(axis=0)
    frequency_hz = np.arange(len(power)) * rate_hz / (2.0 * (len(power) - 1.0))
    above = np.maximum(power - _OVER_FLOOR * np.median(power), 0.0)
    power = above if above.sum() > 0.5 * power.sum() else power
    total = np.cumsum(power)
    places = np.searchsorted(total, np.array([0.5, _POWER]) * total[-1])
    return float(frequency_hz[places[0]]), float(frequency_hz[max(places[1], 1)])


def without_line(values: FloatArray) -> FloatArray:
    """Return values without their mean and their slope."""
    place = np.linspace(-1.0, 1.0, len(values))
    slope = float(place @ values) / float(place @ place)
    residual: FloatArray = values - values.mean() - slope * place
    return residual


def track(
    values: FloatArray, start_s: float, rate_hz: float, band: Band, orders: range
) -> BandTrack:
    """Return some derivatives of a channel without mean and slope, at its working rate.

    Samples near the ends, of which the filter would need neighbours that are not there, go.

    Raises
    ------
    DataError
        If fewer than 16 samples are left.
    """
    from scipy.signal import upfirdn

    down = max(1, int(rate_hz / (_RATE * band.edge_hz)))
    up = max(1, int(np.ceil(_LEAST_RATE * band.edge_hz / rate_hz)))
    half, kernels = _kernels(rate_hz, up, down, band, orders)
    first = -(-2 * half // down)
    last = (len(values) - 1) * up // down
    if last - first < 16:
        raise DataError(
            f"{len(values) / rate_hz:.3g} s at {rate_hz:g} Hz are too short for a motion of "
            f"{band.motion_hz:.3g} Hz"
        )
    rows = [upfirdn(kernel, values, up, down)[first : last + 1] for kernel in kernels]
    start = start_s + (first * down - half) / (rate_hz * up)
    return BandTrack(start, rate_hz * up / down, np.array(rows))


def _kernels(
    rate_hz: float, up: int, down: int, band: Band, orders: range
) -> tuple[int, list[FloatArray]]:
    """Return half the filters' length and the filters: a low pass and its derivatives.

    A windowed sinc is known between its samples, so that its derivative in time is the filter of
    the signal's (A. V. Oppenheim and R. W. Schafer, Discrete-Time Signal Processing, 7.5).
    """
    fine_hz, narrow_hz = rate_hz * up, min(rate_hz, rate_hz * up / down)
    top_hz = min(band.top_hz, _HIGHEST * rate_hz * up / down)
    half = int(np.ceil(_HALF_WIDTH * fine_hz / (narrow_hz - 2.0 * top_hz))) + 1
    place = np.arange(-half * _FINE, half * _FINE + 1) / _FINE / fine_hz
    window = np.cos(np.linspace(-np.pi / 2.0, np.pi / 2.0, len(place))) ** _POWER_OF_COSINE
    low = narrow_hz / fine_hz * np.sinc(narrow_hz * place) * window * up
    size = 4 * half * _FINE
    turn = 2j * np.pi * np.fft.rfftfreq(size, 1.0 / (_FINE * fine_hz))
    spectrum = np.fft.rfft(low, size)
    filters = (np.fft.irfft(spectrum * turn**order, size) for order in orders)
    return half, [taps[: len(place) : _FINE] for taps in filters]
