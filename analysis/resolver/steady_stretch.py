"""Where a run is steady: the longest stretch of periods whose first harmonics stay constant."""

import cmath
import math
from collections import deque
from dataclasses import dataclass

import numpy as np

from analysis.resolver.period_values import PeriodValues
from hardware.description.arrays import BoolArray, ComplexArray, FloatArray

_PRESENT = 0.2  # of the usual amplitude: below it nothing moves yet, or no longer
_ROUNDING = 1e-12  # of the mean: what a constant channel leaves in its harmonics
_LASTING = 3  # periods that show another first harmonic
_NOISE = 4.0  # standard deviations of a period's own noise that are no change


@dataclass(frozen=True)
class Stretch:
    """Periods ``start`` to ``stop`` (exclusive), and how far the worst channel strays in it.

    ``spread`` is the largest distance of a period's first harmonic from the stretch's mean,
    relative to the channel's usual amplitude; ``channel`` is the row of the channel that strays so.
    """

    start: int
    stop: int
    spread: float
    channel: int

    @property
    def period_count(self) -> int:
        """Number of periods."""
        return self.stop - self.start


@dataclass(frozen=True)
class Limit:
    """A period beside a stretch that one channel alone keeps out of it.

    ``channel`` is its row; ``spread`` is how far it would stray in the stretch with that period,
    to either side and relative to its usual amplitude; NaN where it has missing samples.
    ``beyond`` is the channel's first harmonic past that period over that in the stretch, where
    three periods or more keep another one there; else 1.
    """

    period: int
    channel: int
    spread: float
    beyond: complex = 1.0

    @property
    def lasts(self) -> bool:
        """Whether the channel keeps to another first harmonic beyond."""
        return self.beyond != 1.0

    @property
    def turned(self) -> bool:
        """Whether that differs in phase more than in amplitude."""
        return abs(cmath.phase(self.beyond)) > abs(math.log(abs(self.beyond)))


@dataclass(frozen=True)
class _FirstHarmonics:
    """What the first harmonics are judged by.

    Phasors have shape ``(periods, channels)``, the usual amplitudes ``size`` and what is
    ``allowed`` to either side ``(channels,)``; ``present`` says where there is motion.
    """

    phasors: ComplexArray
    size: FloatArray
    allowed: FloatArray
    present: BoolArray

    @property
    def parts(self) -> FloatArray:
        """In-phase parts, then quadrature, shape ``(periods, 2 * channels)``."""
        return np.concatenate((self.phasors.real, self.phasors.imag), axis=1)


def find_steady(values: PeriodValues, tolerance: float) -> Stretch:
    """Find the longest stretch in which every channel's first harmonic keeps within a tolerance.

    It may be as short as one period; it is for the caller to say how many are enough.

    Parameters
    ----------
    tolerance
        Largest distance, relative to the channel's usual amplitude, by which in-phase and
        quadrature may stray to either side. Where a channel's own noise is larger, four standard
        deviations of it are allowed, so that a channel of mere noise does not stand in the way.
    """
    judged = _judge(values, tolerance)
    finite = np.isfinite(judged.phasors).all(axis=1)
    usable = np.asarray(finite & judged.present.all(axis=1))
    start, stop = _longest_within(judged.parts, 2.0 * np.tile(judged.allowed, 2), usable)
    return _describe(judged.phasors, start, stop, judged.size)


def limits(values: PeriodValues, stretch: Stretch, tolerance: float) -> list[Limit]:
    """Return the periods beside a stretch that a single channel keeps out of it.

    Parameters
    ----------
    values, tolerance
        Those with which :func:`find_steady` found the stretch.
    """
    judged = _judge(values, tolerance)
    limits_met = []
    for period in (stretch.start - 1, stretch.stop):
        if not 0 <= period < len(judged.phasors):
            continue
        rows = slice(min(period, stretch.start), max(period + 1, stretch.stop))
        half_range = np.ptp(judged.parts[rows], axis=0).reshape(2, -1).max(axis=0) / 2.0
        out = ~(half_range <= judged.allowed) | ~judged.present[period]
        if out.sum() == 1:
            channel = int(np.argmax(out))
            spread = float(half_range[channel] / max(judged.size[channel], 1e-300))
            beyond = _beyond(judged, stretch, period, channel)
            limits_met.append(Limit(period, channel, spread, beyond))
    return limits_met


def _beyond(judged: _FirstHarmonics, stretch: Stretch, period: int, channel: int) -> complex:
    """Return a channel's first harmonic past a limit over that in the stretch; 1 where it is."""
    first_harmonic = judged.phasors[:, channel]
    past = first_harmonic[:period] if period < stretch.start else first_harmonic[period + 1 :]
    inside = first_harmonic[stretch.start : stretch.stop].mean()
    if len(past) < _LASTING or not np.isfinite(past).all() or inside == 0.0:
        return 1.0
    change, allowed = past.mean() - inside, judged.allowed[channel]
    lasts = np.abs(past - past.mean()).max() <= 2.0 * allowed < np.abs(change)
    return complex(1.0 + change / inside) if lasts else 1.0


def _judge(values: PeriodValues, tolerance: float) -> _FirstHarmonics:
    phasors = values.coefficients[:, :, 1] + 1j * values.coefficients[:, :, 2]
    size = np.array([_usual_amplitude(column) for column in np.abs(phasors).T])
    mean = values.coefficients[:, :, 0]
    rounding = _ROUNDING * np.abs(np.where(np.isfinite(mean), mean, 0.0)).max(axis=0)
    noise = np.maximum([_noise(column) for column in phasors.T], rounding)
    allowed = np.maximum(tolerance * size, _NOISE * noise)
    # A channel of noise alone says nothing about where the motion is.
    telling = size > 2.0 * _NOISE * noise
    present = (np.abs(phasors) > _PRESENT * size) | ~telling
    return _FirstHarmonics(phasors, size, allowed, np.asarray(present))


def _usual_amplitude(amplitude: FloatArray) -> float:
    finite = amplitude[np.isfinite(amplitude)]
    return float(np.quantile(finite, 0.9)) if finite.size else 0.0


def _noise(phasor: ComplexArray) -> float:
    """Standard deviation of one part between periods, blind to slow change and outliers."""
    second = np.diff(phasor[np.isfinite(phasor)], n=2)
    if second.size < 3:
        return 0.0
    parts = np.concatenate((second.real, second.imag))
    return float(1.4826 * np.median(np.abs(parts)) / np.sqrt(6.0))


def _longest_within(parts: FloatArray, allowed: FloatArray, usable: BoolArray) -> tuple[int, int]:
    """Longest run of usable rows in which no column's range exceeds what is allowed."""
    highs: list[deque[int]] = [deque() for _ in allowed]
    lows: list[deque[int]] = [deque() for _ in allowed]
    best, start = (0, 0), 0
    for row in range(len(parts)):
        if not usable[row]:
            start = row + 1
            continue
        for column, limit in enumerate(allowed):
            _keep(highs[column], parts[:, column], row, 1.0)
            _keep(lows[column], parts[:, column], row, -1.0)
            start = _first_within(highs[column], lows[column], parts[:, column], start, limit)
        if row + 1 - start > best[1] - best[0]:
            best = (start, row + 1)
    return best if best[1] else (0, 1)


def _keep(extremes: deque[int], column: FloatArray, row: int, sign: float) -> None:
    """Add a row to the candidates for the largest (or, with sign -1, the smallest) value."""
    while extremes and sign * column[extremes[-1]] <= sign * column[row]:
        extremes.pop()
    extremes.append(row)


def _first_within(
    highs: deque[int], lows: deque[int], column: FloatArray, start: int, limit: float
) -> int:
    """Earliest start from which the range up to the newest row is within the limit."""
    while True:
        while highs[0] < start:
            highs.popleft()
        while lows[0] < start:
            lows.popleft()
        if column[highs[0]] - column[lows[0]] <= limit:
            return start
        start = min(highs[0], lows[0]) + 1


def _describe(phasors: ComplexArray, start: int, stop: int, size: FloatArray) -> Stretch:
    inside = phasors[start:stop]
    departure = np.abs(inside - inside.mean(axis=0)).max(axis=0) / np.maximum(size, 1e-300)
    departure = np.where(np.isfinite(departure), departure, np.inf)
    channel = int(np.argmax(departure))
    return Stretch(start, stop, float(departure[channel]), channel)
