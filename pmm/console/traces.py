"""Samples on their way to the screen, thinned for the eye."""

from typing import Final

import numpy as np

from hardware.description.arrays import FloatArray
from pmm.console.messages import SignalTrace

POINTS: Final = 2000  # of each trace
WINDOW_S: Final = 20.0


def points_a_second(sample_rate_hz: float) -> tuple[int, float]:
    """Return how many samples become a point, and the points per second.

    Where samples are more than points, pairs of points are the lowest and the highest of twice as
    many samples: a spike of one sample stays to be seen.
    """
    samples = max(1, round(sample_rate_hz * WINDOW_S / POINTS))
    return samples, sample_rate_hz / samples


class TraceBuffer:
    """Collects samples between two frames.

    Parameters
    ----------
    channels
        How many.
    """

    def __init__(self, channels: int, sample_rate_hz: float) -> None:
        self._each, _ = points_a_second(sample_rate_hz)
        self._rate_hz = sample_rate_hz
        self._rest = np.empty((channels, 0))
        self._next: int | None = None

    def add(self, first: int, values: FloatArray) -> None:
        """Take consecutive samples, shape ``(channels, n)``; a gap is filled with NaN."""
        if self._next is not None and first > self._next:
            missing = min(first - self._next, POINTS * self._each)
            self._rest = np.hstack((self._rest, np.full((len(values), missing), np.nan)))
        elif self._next is not None and first < self._next:
            values = values[:, self._next - first :]
        self._rest = np.hstack((self._rest, values))
        self._next = max(first + values.shape[1], self._next or 0)

    def take(self) -> SignalTrace:
        """Return the points that are complete."""
        bucket = self._each if self._each == 1 else 2 * self._each
        count = self._rest.shape[1] // bucket * bucket
        samples, self._rest = self._rest[:, :count], self._rest[:, count:]
        first = (self._next or 0) - self._rest.shape[1] - count
        return SignalTrace(first // self._each, first / self._rate_hz, self._thin(samples))

    def _thin(self, samples: FloatArray) -> FloatArray:
        if self._each == 1 or not samples.size:
            return samples
        buckets = samples.reshape(len(samples), -1, 2 * self._each)
        places = np.sort(np.stack((buckets.argmin(axis=2), buckets.argmax(axis=2)), axis=2), axis=2)
        return np.take_along_axis(buckets, places, axis=2).reshape(len(samples), -1)
