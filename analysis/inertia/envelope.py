"""How large an oscillation is along its record, and how loud the noise on it."""

import numpy as np

from hardware.description.arrays import FloatArray

_RELEASED = 0.9  # of the largest amplitude
_AS_FAR = 6.0  # times the noise: samples that differ by less may be equal
_SEEN = 0.5  # of a period's samples; a quarter of them may lie where the motion passes zero


def end_amplitudes(envelope: FloatArray, first: int, last: int, size: int) -> tuple[float, float]:
    """Return the envelope half a period (``size // 2`` samples) within either end."""
    ends = np.clip([first + size // 2, last - size // 2], 0, envelope.size - 1)
    return float(envelope[ends[0]]), float(envelope[ends[1]])


def noise_of(values: FloatArray, stamps_s: FloatArray | None) -> float:
    """Return the noise from third differences, of which a slow oscillation has none."""
    if stamps_s is None:
        third = np.diff(values, 3) / np.sqrt(20.0)
    else:
        good = np.isfinite(values)
        third = _third_differences(stamps_s[good], values[good])
    third = third[np.isfinite(third)]
    return float(1.4826 * np.median(np.abs(third))) if third.size else 0.0


def _third_differences(stamps_s: FloatArray, values: FloatArray) -> FloatArray:
    """Return what four successive samples have beside a parabola, of the noise's own size.

    Of those half that lie nearest to each other, where the oscillation itself leaves least.
    """
    count = max(values.size - 3, 0)
    times = np.stack([stamps_s[k : k + count] for k in range(4)])
    intervals = times[:, np.newaxis] - times + np.eye(4)[:, :, np.newaxis]
    share = 1.0 / intervals.prod(axis=1)
    size = np.sqrt((share**2).sum(axis=0))
    third = (share * [values[k : k + count] for k in range(4)]).sum(axis=0) / size
    return np.asarray(third[size >= np.median(size)] if count else third)


def envelope_of(values: FloatArray, size: int) -> FloatArray:
    """Return the amplitude over the period around each sample, gaps left out."""
    good = np.isfinite(values)
    filled = np.where(good, values - np.nanmean(values[good]), 0.0)
    window = np.ones(min(size, values.size))
    count = np.maximum(np.convolve(good.astype(np.float64), window, "same"), 1.0)
    mean = np.convolve(filled, window, "same") / count
    square = np.convolve(filled**2, window, "same") / count
    envelope = np.sqrt(2.0 * np.maximum(square - mean**2, 0.0))
    envelope[np.convolve(good.astype(np.float64), window, "same") < _SEEN * window.size] = np.nan
    return np.asarray(envelope)


def release(values: FloatArray, envelope: FloatArray, size: int, top: float, noise: float) -> int:
    """Return the sample after the largest swing: where the body hangs free.

    A body that is held before stands as far out as it ever comes: of all samples that the noise
    does not tell from the largest, the last is the one at which it was let go.
    """
    high = np.flatnonzero(np.nan_to_num(envelope) >= _RELEASED * top)
    if high[0] <= size // 2 + 1:  # it swings from the record's beginning on, if nobody holds it
        moves = np.abs(values[:size] - values[0]) > _AS_FAR * noise
        return max(int(np.argmax(moves)) - 1, 0)
    begin = max(int(high[0]) - size, 0)
    out = np.nan_to_num(np.abs(values[begin : high[0] + size] - float(np.nanmean(values))))
    peak = begin + int(np.flatnonzero(out >= out.max() - _AS_FAR * noise)[-1])
    return int(min(peak + size // 2, values.size - 1))
