"""Power between the harmonics, band by band: how loud it is, and whether one line stands out.

A line where the mains fold to is told apart from any other, by its amplitude: a carriage has none
there, and hum adds to hum.
"""

from collections.abc import Iterator, Mapping
from typing import Final

import numpy as np

from analysis.gap.observe.components import Component, Part
from hardware.description.arrays import BoolArray, FloatArray

Found = Iterator[tuple[Component, float, float]]

MAINS_HZ: Final = (50, 60)
OF_MAINS: Final = (1, 2, 3)  # the double of what is rectified, the triple of what is saturated
TAKEN_OUT: Final = 12  # harmonics whose leakage is taken out of what lies between them
_BESIDE = 1.5  # bins on either side of a line that its own leakage may reach
# Of the noise's power: what lines of the mains leak at most into lines that tell of the noise. Half
# or twice as much moves the edge by a tenth of its distance, some 10 lines from a strong line.
_LEAKS = 1e-3
_FURTHEST = 64  # bins, where a millionth of a millionth of a line leaks
_ABOUT = 51  # lines whose median says how loud it is about one of them
_FEW_LINES = 12
_FEWEST_LINES = 2  # where the mains fold to: at least that many of those that they reach
_SQUARED = 1.94  # bins of noise that a Hann taper's square lets through
# Power of three lines in a row over that of noise at mean, which noise reaches in one of two
# hundred nines: less is no line, however loud the noise of a simulation is beside that of the rig.
_BY_NOISE = 6.0
_UNSTEADY = 0.2  # of the amplitude of hum, by which it changes with what else is switched on
_COUNTED = 0.66  # of the lines under a Hann taper that tell something of their own


def free_of_harmonics(lines_hz: FloatArray, frequency: float, bin_hz: float) -> BoolArray:
    """Tell which lines no harmonic's own leakage reaches.

    Parameters
    ----------
    frequency
        Of the oscillation, in Hz.
    bin_hz
        Distance of the lines.
    """
    nearest = np.round(lines_hz / frequency) * frequency
    return np.asarray(np.abs(lines_hz - nearest) > _BESIDE * bin_hz)


def folded_hz(mains_hz: float, rate_hz: float) -> float:
    """Return at which frequency a line of the mains is seen in samples."""
    return abs(mains_hz - rate_hz * round(mains_hz / rate_hz))


def of_the_mains(lines_hz: FloatArray, rate_hz: float, bin_hz: float) -> dict[int, BoolArray]:
    """Tell by frequency of the mains which lines it reaches, its double and triple among them.

    A line that two of them reach, as both do at 110 samples a second, belongs to the first alone.

    Parameters
    ----------
    bin_hz
        Distance of the lines.
    """
    reached: dict[int, BoolArray] = {}
    left = np.ones(len(lines_hz), dtype=bool)
    for mains_hz in MAINS_HZ:
        seen_hz = np.array([folded_hz(order * mains_hz, rate_hz) for order in OF_MAINS])
        near = np.abs(lines_hz[:, None] - seen_hz) < _BESIDE * bin_hz
        reached[mains_hz] = left & near.any(axis=1)
        left &= ~reached[mains_hz]
    return reached


def between_harmonics(
    name: str,
    values: FloatArray,
    rate_hz: float,
    frequency: float,
    bands: Mapping[int, tuple[float, float]],
) -> Found:
    """Yield how loud each band is between the harmonics, its strongest line, and the mains'.

    Parameters
    ----------
    values
        Samples, the first ``TAKEN_OUT`` harmonics taken out.
    frequency
        Of the oscillation, in Hz.
    bands
        In multiples of it, by number.
    """
    count = len(values)
    taper, bin_hz = np.hanning(count), rate_hz / count
    lines_hz = np.asarray(np.arange(count // 2 + 1) * bin_hz, np.float64)
    power = np.abs(np.fft.rfft(values * taper)) ** 2 / np.sum(taper**2) / len(lines_hz)
    free = free_of_harmonics(lines_hz, frequency, bin_hz)
    mains = of_the_mains(lines_hz, rate_hz, bin_hz)
    reached = np.any([*mains.values()], axis=0)
    leaked = _leaked(np.where(reached, power, 0.0))
    quiet = free & ~reached & (leaked <= _LEAKS * np.median(power))
    for number, (low, high) in bands.items():
        inside = quiet & (lines_hz > low * frequency) & (lines_hz < high * frequency)
        yield from band(name, number, power[inside])
    if np.count_nonzero(quiet) < _FEW_LINES or not power[quiet].any():
        return
    noise = np.interp(lines_hz, lines_hz[quiet], _noise_power(power[quiet]))
    shared = reached & ~free & (lines_hz > (TAKEN_OUT + 0.5) * frequency)
    noise = noise * _high_harmonics(lines_hz / frequency, power / noise, shared)
    for mains_hz, lines in mains.items():
        # Below the oscillation slow noise rises more steeply than its neighbours tell.
        own = lines & (free | shared) & (lines_hz > frequency)
        if np.count_nonzero(own) >= _FEWEST_LINES:
            yield Component(name, Part.MAINS, mains_hz), *_amplitude(power, noise, own)


def _leaked(power: FloatArray) -> FloatArray:
    """Return the most that lines leak into the others under a Hann taper (Harris 1978, table 1).

    Parameters
    ----------
    power
        Of all lines, 0 but for those whose leakage is asked, shape ``(lines,)``.
    """
    from scipy.ndimage import convolve1d

    away = np.abs(np.arange(-_FURTHEST, _FURTHEST + 1, dtype=np.float64))
    away[away < 2.0] = np.inf  # what its neighbours hold belongs to the line
    spread = (np.pi * away * (away**2 - 1.0)) ** -2.0
    return np.asarray(convolve1d(power, spread, mode="constant"))


def _high_harmonics(orders: FloatArray, ratio: FloatArray, shared: BoolArray) -> FloatArray:
    """Return how much louder lines are by high harmonics; 1 where none reaches.

    Mostly there is nothing of a fiftieth harmonic, and a line there is that of the mains; how much
    there is tell the two harmonics on either side, those next to it or the others, whichever are
    louder.

    Parameters
    ----------
    orders
        Frequency of the lines over that of the oscillation, shape ``(lines,)``.
    ratio
        Their power over that of the noise.
    shared
        Those in question, which a high harmonic reaches.
    """
    louder, harmonic, step = np.ones(len(orders)), np.round(orders), orders[1] - orders[0]
    for order in np.unique(harmonic[shared]):
        near = [np.abs(np.abs(orders - order) - away) < _BESIDE * step for away in (1, 2)]
        loudest = max(float(np.mean(ratio[lines])) for lines in near)
        louder[shared & (harmonic == order)] = max(loudest, 1.0)
    return louder


def _amplitude(power: FloatArray, noise: FloatArray, own: BoolArray) -> tuple[float, float]:
    """Return the amplitude of the strongest of some lines, and its uncertainty.

    It is without what noise may make of it, and 0 where that is all. A line is what it and its
    neighbours hold together: under a Hann taper half of its square, wherever between them it lies.
    Far above the noise, which turns about its phasor, its amplitude scatters by the noise's root
    mean square (Rice 1945, section 3.10), over the bandwidth of the taper's square.

    Parameters
    ----------
    power, noise
        Of all lines, shape ``(lines,)``.
    own
        Which of them are looked at.
    """
    held, usual = (
        np.convolve(np.where(own, each, 0.0), np.ones(3), "same") for each in (power, noise)
    )
    above = held - _BY_NOISE * usual
    at = int(np.argmax(np.where(own, above, -np.inf)))
    amplitude = (2.0 * max(float(above[at]), 0.0)) ** 0.5
    return amplitude, float(np.hypot((_SQUARED * noise[at]) ** 0.5, _UNSTEADY * amplitude))


def band(name: str, number: int, power: FloatArray) -> Found:
    """Yield how loud a band of a channel is, and its strongest line; nothing of too few lines.

    Parameters
    ----------
    number
        Of the band.
    power
        Of its lines, shape ``(lines,)``.
    """
    if power.size < _FEW_LINES or not power.any():
        return
    # Noise makes exponentially distributed powers.
    count = _COUNTED * power.size
    middle = float(np.median(power)) / np.log(2.0) + 1e-15
    yield Component(name, Part.BETWEEN, number), float(np.log(middle)), 1.5 / np.sqrt(count)
    # Noise that falls with frequency is loudest at a band's lower edge, and that is no line.
    ratio = power / _noise_power(power)
    highest = float(np.log(count) + np.euler_gamma)  # of as many lines of noise, over their mean
    uncertainty = float(np.hypot(1.28 / highest, 1.5 / np.sqrt(count)))
    yield Component(name, Part.LINE, number), float(np.log(ratio.max() / highest)), uncertainty


def _noise_power(power: FloatArray) -> FloatArray:
    """Return the mean power of the noise about each line, by the median of its neighbours."""
    from scipy.ndimage import median_filter

    width = min(_ABOUT, power.size)
    return np.asarray(median_filter(power, width, mode="reflect") / np.log(2.0) + 1e-15)
