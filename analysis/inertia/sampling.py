"""Whether a record has an oscillation in it at all, and enough samples of it."""

import numpy as np

from analysis.inertia.spectrum import Spectrum, spectrum
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError

FEWEST_SAMPLES_A_PERIOD = 5.0
ALIASED_SHARE = 0.1
LINE_OVER_MEDIAN = 8.0  # the highest of ten thousand lines of white noise is 3.7


def rough_period(where: str, values: FloatArray, sample_rate_hz: float) -> float:
    """Return the period of the strongest oscillation.

    Raises
    ------
    DataError
        If no line stands out of the spectrum, or the record is sampled too slowly for the one
        that does (aliasing).
    """
    lines = spectrum(values, sample_rate_hz)
    top, usual = float(lines.amplitude[1:].max()), float(np.median(lines.amplitude))
    if not top > LINE_OVER_MEDIAN * usual:
        raise DataError(
            f"{where}: the strongest line is {top / max(usual, 1e-300):.2g} times the median one "
            f"(at least {LINE_OVER_MEDIAN:g}); nothing swings: choose another channel, or release "
            "from further out"
        )
    period = 1.0 / lines.peak_hz(1.5 * sample_rate_hz / values.size)
    check_sampling(where, lines, sample_rate_hz, period)
    return period


def check_sampling(where: str, lines: Spectrum, sample_rate_hz: float, period_s: float) -> None:
    """Refuse a record that is, or may be, sampled too slowly.

    Raises
    ------
    DataError
        Under five samples a period, or with a tenth of the strongest line at half the rate.
    """
    samples = period_s * sample_rate_hz
    top = lines.frequency_hz > 0.45 * sample_rate_hz
    share = float(lines.amplitude[top].max() / lines.amplitude[1:].max())
    if samples < FEWEST_SAMPLES_A_PERIOD or share > ALIASED_SHARE:
        raise DataError(
            f"{where}: {samples:.2g} samples a period of {period_s:.3g} s (at least "
            f"{FEWEST_SAMPLES_A_PERIOD:g}), and {100 * share:.0f} % of the strongest line stands "
            f"at half the sample rate (limit {100 * ALIASED_SHARE:g} %): aliasing; a faster motion "
            f"looks slow at {sample_rate_hz:g} Hz: sample faster"
        )
