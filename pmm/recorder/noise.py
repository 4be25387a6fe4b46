"""The noise of each channel, from a record in which nothing moves."""

import numpy as np

from hardware.description.arrays import FloatArray


def white_noise_rms(samples: FloatArray) -> FloatArray:
    """Return the standard deviation of each channel's white noise.

    From the differences of neighbouring samples, which are blind to a zero that wanders and to
    waves that are long against a sample; missing samples are passed over.

    Parameters
    ----------
    samples
        Shape ``(channels, n)``.

    Returns
    -------
    numpy.ndarray
        Shape ``(channels,)``; NaN where a channel has no two samples in a row.
    """
    steps = np.diff(samples, axis=1) ** 2
    known = np.isfinite(steps)
    count = known.sum(axis=1)
    total = np.where(known, steps, 0.0).sum(axis=1)
    found = np.full(len(samples), np.nan)
    np.divide(total, 2.0 * count, out=found, where=count > 0)
    return np.asarray(np.sqrt(found))
