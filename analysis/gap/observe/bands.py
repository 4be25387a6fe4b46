"""Power between the harmonics, band by band: how loud it is, and whether one line stands out.

A line where the mains fold to is told apart from any other: a carriage has none there.
"""

from collections.abc import Iterator, Mapping
from typing import Final

import numpy as np

from analysis.gap.observe.components import Component, Part
from hardware.description.arrays import BoolArray, FloatArray

Found = Iterator[tuple[Component, float, float]]

MAINS_HZ: Final = (50, 60)
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
