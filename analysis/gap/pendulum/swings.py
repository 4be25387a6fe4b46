"""What a free oscillation shows, window by window: amplitude, phase, mean and third harmonic.

A window is a whole number of swings of a reference frequency. In each the record is

    x = c + (a + a' t) cos(w t) + (b + b' t) sin(w t) + second and third harmonic

so that decay and another frequency within the window do no harm. The phase is that against the
reference: it rises where the body swings faster. Measured and simulated records pass the same
windows, so that what a window does to a decay drops out of the difference. A motion that has
settled under a force has a fourth and a fifth harmonic in place of a' and b'.
"""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.inertia.gates import Passages
from hardware.description.arrays import FloatArray

KINDS: Final = ("decay", "period", "mean", "third in phase", "third in quadrature")
_DECAY, _PERIOD, _MEAN, _THIRD = 0, 1, 2, 3
_TERMS = 9  # 11 of a motion that has settled
_SAMPLES: Final = 2 * _TERMS  # in a window, at least
FEWEST_WINDOWS: Final = (
    6  # about a parabola they leave 3 degrees of freedom, of which t has a variance
)
MOST_WINDOWS: Final = 60
_HOLE: Final = 1.0 / 6.0  # of a swing, half a period of its third harmonic, without a sample
_LEAST_PASSAGES = 5


@dataclass(frozen=True)
class Windows:
    """Where a record is cut.

    Attributes
    ----------
    start_s
        Of the first window, on the record's clock.
    swings
        Of the reference frequency in each window.
    """

    start_s: float
    reference_rad_s: float
    swings: int
    count: int

    @property
    def length_s(self) -> float:
        """Of one window."""
        return 2.0 * math.pi * self.swings / self.reference_rad_s

    @property
    def centres_s(self) -> FloatArray:
        """Middles of the windows after the start, shape ``(windows,)``."""
        return np.asarray(self.length_s * (np.arange(self.count) + 0.5), np.float64)


def cut_into_windows(
    start_s: float, stop_s: float, period_s: float, sample_rate_hz: float = math.inf
) -> Windows:
    """Return windows of as few whole swings as leave at most 60, each with samples enough."""
    fewest = (
        (stop_s - start_s) / period_s / MOST_WINDOWS,
        _SAMPLES / (sample_rate_hz * period_s),
    )
    swings = max(1, *map(math.ceil, fewest))
    count = int((stop_s - start_s) / (swings * period_s) + 1e-9)
    return Windows(start_s, 2.0 * math.pi / period_s, swings, count)


def swings_of_samples(
    time_s: FloatArray, values: FloatArray, windows: Windows, *, steady: bool = False
) -> FloatArray:
    """Return amplitude (logarithm), phase, mean and third harmonic of each window.

    Parameters
    ----------
    time_s, values
        Shape ``(samples,)``; NaN where a sample is missing.
    steady
        Whether the motion has settled: nothing decays within a window.

    Returns
    -------
    FloatArray
        Shape ``(5, windows)`` in the order of :data:`KINDS`; phase and third harmonic in rad and
        over the first's amplitude. NaN where a window has too few samples, or a hole.
    """
    since = time_s - windows.start_s
    rough = _fit_swings(since, values, windows, windows.reference_rad_s, steady)
    # a second time at the record's own frequency: slopes within a window are then small
    slope = _mean_slope(windows.centres_s, rough[_PERIOD])
    omega_rad_s = windows.reference_rad_s + slope
    swings = _fit_swings(since, values, windows, omega_rad_s, steady)
    swings[_PERIOD] += slope * windows.centres_s
    return swings


def _mean_slope(time_s: FloatArray, phase_rad: FloatArray) -> float:
    good = np.isfinite(phase_rad)
    if good.sum() < 2:
        return 0.0
    return float(np.polyfit(time_s[good], phase_rad[good], 1)[0])


def _fit_swings(
    since_s: FloatArray, values: FloatArray, windows: Windows, omega_rad_s: float, steady: bool
) -> FloatArray:
    swings = np.full((len(KINDS), windows.count), np.nan)
    inverses: dict[bytes, FloatArray] = {}  # windows sampled alike share theirs
    edges = np.searchsorted(since_s, windows.length_s * np.arange(windows.count + 1) - 1e-9)
    apart_s = float(np.median(np.diff(since_s)))
    hole_s = max(_HOLE * windows.length_s / windows.swings, 2.0 * apart_s)
    for at, centre in enumerate(windows.centres_s):
        inside = slice(edges[at], edges[at + 1])
        good = np.isfinite(values[inside])
        t = since_s[inside][good] - centre
        if t.size >= _SAMPLES and _longest_hole(t, windows) < hole_s:
            key = np.round(t * omega_rad_s, 9).tobytes()
            if key not in inverses:
                inverses[key] = np.asarray(
                    np.linalg.pinv(_terms(t, omega_rad_s, steady)), np.float64
                )
            solved = inverses[key] @ values[inside][good]
            swings[:, at] = _swing_values(solved, omega_rad_s * centre)
    good = np.isfinite(swings[_PERIOD])
    swings[_PERIOD, good] = np.unwrap(swings[_PERIOD, good])
    return swings


def _longest_hole(t: FloatArray, windows: Windows) -> float:
    half = 0.5 * windows.length_s
    return float(np.diff(t, prepend=-half, append=half).max())


def _terms(t: FloatArray, omega_rad_s: float, steady: bool) -> FloatArray:
    angle = omega_rad_s * t
    waves = [wave(n * angle) for n in range(1, 6 if steady else 4) for wave in (np.cos, np.sin)]
    slopes = [] if steady else [t * waves[0], t * waves[1]]
    return np.column_stack([np.ones(t.size), *waves, *slopes])


def _swing_values(solved: FloatArray, turned_rad: float) -> FloatArray:
    first = complex(solved[1], -solved[2])
    size = max(abs(first), 1e-300)
    third = complex(solved[5], -solved[6]) * (first.conjugate() / size) ** 3 / size
    phase = np.angle(first * np.exp(-1j * turned_rad))
    return np.array([math.log(size), phase, solved[0], third.real, third.imag])


def swings_of_passages(passages: Passages, windows: Windows, amplitude: float) -> FloatArray:
    """Return the same from light gates: phase from the times, amplitude from the speeds.

    Parameters
    ----------
    amplitude
        In the first window; a gate tells how it falls, and not how large it is.

    Returns
    -------
    FloatArray
        As :func:`swings_of_samples`; mean and third harmonic are NaN.
    """
    swings = np.full((len(KINDS), windows.count), np.nan)
    since = passages.time_s - windows.start_s
    advance = 0.5 * math.pi + math.pi * passages.number - windows.reference_rad_s * since
    for at, centre in enumerate(windows.centres_s):
        inside = np.abs(since - centre) <= 0.5 * windows.length_s
        if inside.sum() < _LEAST_PASSAGES:
            continue
        t = since[inside] - centre
        every_second = np.where(passages.number[inside] % 2 == 0, 1.0, -1.0)
        matrix = np.column_stack([np.ones(t.size), every_second, t])
        rows = np.column_stack([np.log(passages.speed[inside]), advance[inside]])
        solved, *_ = np.linalg.lstsq(matrix, rows, rcond=None)
        swings[[_DECAY, _PERIOD], at] = solved[0]
    finite = np.flatnonzero(np.isfinite(swings[_DECAY]))
    if finite.size:
        swings[_DECAY] += math.log(amplitude) - swings[_DECAY, finite[0]]
        # half-swings that were missed before the first window leave whole turns
        turns = round(float(swings[_PERIOD, finite[0]]) / (2.0 * math.pi))
        swings[_PERIOD] -= 2.0 * math.pi * turns
    return swings


def scatter(swings: FloatArray) -> FloatArray:
    """Return the standard uncertainty of each window's values, shape ``(5, windows)``.

    It is what is left of them after a smooth curve, larger where the amplitude is small, and wider
    where neighbours are alike and, as the deviation of Student's t, where windows are few. NaN
    stays NaN.
    """
    spread = np.full(swings.shape, np.nan)
    for kind, values in enumerate(swings):
        good = np.isfinite(values)
        if good.sum() < FEWEST_WINDOWS:
            continue
        size = np.exp(swings[_DECAY, good] - np.max(swings[_DECAY, good]))
        shape = np.ones(size.size) if kind == _MEAN else 1.0 / size
        spread[kind, good] = shape * _rms_about_smooth(np.flatnonzero(good), values[good], shape)
    return spread


_FLOOR: Final = 2e-6  # what windows and integration leave of an exact record
_DEGREE: Final = 5


def _rms_about_smooth(place: NDArray[np.intp], values: FloatArray, shape: FloatArray) -> float:
    degree = min(_DEGREE, values.size // 3)
    fit = np.polynomial.Legendre.fit(place, values, degree, w=1.0 / shape)
    remainder = (values - fit(place)) / shape
    freedom = values.size - degree - 1
    alike = float(remainder[1:] @ remainder[:-1]) / max(float(remainder @ remainder), 1e-300)
    inflation = min(max((1.0 + alike) / max(1.0 - alike, 0.2), 1.0), 5.0)
    few = freedom / (freedom - 2.0)
    return max(math.sqrt(few * inflation * float(remainder @ remainder) / freedom), _FLOOR)
