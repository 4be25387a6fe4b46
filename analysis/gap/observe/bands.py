"""Power between the harmonics, band by band: how loud it is, and whether one line stands out."""

from collections.abc import Iterator

import numpy as np

from analysis.gap.observe.components import Component, Part
from hardware.description.arrays import BoolArray, FloatArray

Found = Iterator[tuple[Component, float, float]]

_BESIDE = 1.5  # bins on either side of a harmonic that its own leakage may reach
_ABOUT = 51  # lines whose median says how loud it is about one of them
_FEW_LINES = 12
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
    highest = expected_highest(power.size)
    # Noise that falls with frequency is loudest at a band's lower edge, and that is no line.
    strongest = float(np.log((power / _noise_power(power)).max() / highest))
    yield (
        Component(name, Part.LINE, number),
        strongest,
        float(np.hypot(1.28 / highest, 1.5 / np.sqrt(count))),
    )


def expected_highest(lines: float) -> float:
    """Return the expected power of the strongest of some lines of noise, over their mean."""
    return float(np.log(_COUNTED * lines) + np.euler_gamma)


def _noise_power(power: FloatArray) -> FloatArray:
    """Return the mean power of the noise about each line, by the median of its neighbours."""
    from scipy.ndimage import median_filter

    width = min(_ABOUT, power.size)
    return np.asarray(median_filter(power, width, mode="reflect") / np.log(2.0) + 1e-15)
