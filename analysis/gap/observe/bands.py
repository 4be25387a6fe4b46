"""Power between the harmonics, band by band: how loud it is, and whether one line stands out.

A line where the mains fold to is told apart from any other: a carriage has none there.
"""

import math
from collections.abc import Iterator, Mapping
from typing import Final

import numpy as np

from analysis.gap.observe.components import Component, Part
from hardware.description.arrays import BoolArray, FloatArray

Found = Iterator[tuple[Component, float, float]]

MAINS_HZ: Final = (50, 60)
TAKEN_OUT: Final = 12  # harmonics whose leakage is taken out of what lies between them
_BESIDE = 1.5  # bins on either side of a line that its own leakage may reach
_ABOUT = 51  # lines whose median says how loud it is about one of them
_FEW_LINES = 12
_FEWEST_LINES = 2  # where the mains fold to: at least that many of the three that they reach
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


def of_the_mains(
    lines_hz: FloatArray, rate_hz: float, bin_hz: float, band_hz: tuple[float, float]
) -> dict[int, BoolArray]:
    """Tell by frequency of the mains that folds into a band which of its lines it reaches.

    A line that two of them reach, as both do at 110 samples a second, belongs to the first alone.

    Parameters
    ----------
    bin_hz
        Distance of the lines.
    """
    reached: dict[int, BoolArray] = {}
    left = np.ones(len(lines_hz), dtype=bool)
    for mains_hz in MAINS_HZ:
        at_hz = folded_hz(mains_hz, rate_hz)
        if band_hz[0] < at_hz < band_hz[1]:
            reached[mains_hz] = left & (np.abs(lines_hz - at_hz) < _BESIDE * bin_hz)
            left &= ~reached[mains_hz]
    return reached


def between_harmonics(
    name: str,
    values: FloatArray,
    rate_hz: float,
    frequency: float,
    bands: Mapping[int, tuple[float, float]],
) -> Found:
    """Yield how loud each band is between the harmonics, and its strongest lines.

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
    beyond = lines_hz > (TAKEN_OUT + 0.5) * frequency
    for number, (low, high) in bands.items():
        edges_hz = low * frequency, high * frequency
        within = (lines_hz > edges_hz[0]) & (lines_hz < edges_hz[1])
        within[0] = False
        mains = of_the_mains(lines_hz, rate_hz, bin_hz, edges_hz)
        shared = within & beyond & ~free & np.any([np.zeros_like(free), *mains.values()], axis=0)
        told = _beside_harmonics(lines_hz / frequency, power, within & free, shared)
        inside = within & (free | shared)
        near = {mains_hz: lines[inside] for mains_hz, lines in mains.items()}
        yield from band(name, number, told[inside], near)


def _beside_harmonics(
    orders: FloatArray, power: FloatArray, free: BoolArray, shared: BoolArray
) -> FloatArray:
    """Return the power of lines that share their place with a high harmonic, less its part in it.

    Mostly there is nothing of a fiftieth harmonic, and a line there is that of the mains; how much
    there is tell the two harmonics on either side, those next to it or the others, over the noise.

    Parameters
    ----------
    orders
        Frequency of the lines over that of the oscillation, shape ``(lines,)``.
    free
        Which of them no harmonic reaches.
    shared
        Those in question.
    """
    told, harmonic, step = power.copy(), np.round(orders), orders[1] - orders[0]
    noise = float(np.median(power[free])) / np.log(2.0) + 1e-15 if free.any() else math.inf
    for order in np.unique(harmonic[shared]):
        loudest = noise
        for away in (1, 2):  # there may be odd ones alone
            near = np.abs(np.abs(orders - order) - away) < _BESIDE * step
            loudest = max(loudest, float(np.mean(power[near])))
        told[shared & (harmonic == order)] /= loudest / noise
    return told


def band(
    name: str, number: int, power: FloatArray, mains: Mapping[int, BoolArray] | None = None
) -> Found:
    """Yield how loud a band of a channel is, and its strongest lines; nothing of too few lines.

    Parameters
    ----------
    number
        Of the band.
    power
        Of its lines, shape ``(lines,)``.
    mains
        By frequency of the mains, which of them it reaches; those have a component of their own.
    """
    if power.size < _FEW_LINES or not power.any():
        return
    # Noise makes exponentially distributed powers.
    count = _COUNTED * power.size
    middle = float(np.median(power)) / np.log(2.0) + 1e-15
    yield Component(name, Part.BETWEEN, number), float(np.log(middle)), 1.5 / np.sqrt(count)
    # Noise that falls with frequency is loudest at a band's lower edge, and that is no line.
    ratio, near = power / _noise_power(power), mains or {}
    others = ~np.any([np.zeros(power.size, dtype=bool), *near.values()], axis=0)
    for component, lines in (
        (Component(name, Part.LINE, number), others),
        *((Component(name, Part.MAINS, mains_hz), lines) for mains_hz, lines in near.items()),
    ):
        if (among := int(np.count_nonzero(lines))) >= _FEWEST_LINES:
            highest = expected_highest(among)
            uncertainty = float(np.hypot(1.28 / highest, 1.5 / np.sqrt(count)))
            yield component, float(np.log(ratio[lines].max() / highest)), uncertainty


def expected_highest(lines: float) -> float:
    """Return the expected power of the strongest of some lines of noise, over their mean."""
    return float(np.log(_COUNTED * lines) + np.euler_gamma)


def _noise_power(power: FloatArray) -> FloatArray:
    """Return the mean power of the noise about each line, by the median of its neighbours."""
    from scipy.ndimage import median_filter

    width = min(_ABOUT, power.size)
    return np.asarray(median_filter(power, width, mode="reflect") / np.log(2.0) + 1e-15)
