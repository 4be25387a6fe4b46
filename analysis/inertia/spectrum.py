"""Starting values from the spectrum: where the oscillations of a record lie."""

from dataclasses import dataclass

import numpy as np

from hardware.description.arrays import FloatArray


@dataclass(frozen=True)
class Spectrum:
    """Amplitude spectrum of a record under a Hann taper.

    Attributes
    ----------
    frequency_hz, amplitude
        Shape ``(bins,)``; amplitude of a sine at that frequency, in the record's unit.
    """

    frequency_hz: FloatArray
    amplitude: FloatArray

    def peak_hz(self, above_hz: float = 0.0) -> float:
        """Return the highest peak's frequency, interpolated between bins."""
        start = max(int(np.searchsorted(self.frequency_hz, above_hz)), 1)
        k = start + int(np.argmax(self.amplitude[start:]))
        if not 0 < k < self.amplitude.size - 1:
            return float(self.frequency_hz[k])
        left, middle, right = np.log(np.maximum(self.amplitude[k - 1 : k + 2], 1e-300))
        bend = left - 2.0 * middle + right
        shift = 0.5 * (left - right) / bend if bend < 0.0 else 0.0
        return float(self.frequency_hz[k] + shift * self.frequency_hz[1])


def spectrum(values: FloatArray, sample_rate_hz: float, *, tapered: bool = True) -> Spectrum:
    """Return the amplitude spectrum; missing samples count as the mean.

    Parameters
    ----------
    values
        Evenly spaced, shape ``(samples,)``; NaN where missing.
    """
    good = np.isfinite(values)
    centred = np.where(good, values - np.mean(values[good]), 0.0)
    taper = np.hanning(values.size + 2)[1:-1] if tapered else np.ones(values.size)
    size = 1 << int(np.ceil(np.log2(2 * values.size)))
    raw = np.asarray(np.abs(np.fft.rfft(centred * taper, size)) * 2.0 / taper[good].sum())
    return Spectrum(
        np.fft.rfftfreq(size, 1.0 / sample_rate_hz).astype(np.float64), raw.astype(np.float64)
    )
