"""Long traces in few points: the lowest and the highest sample of each stretch."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from analysis.recording import Recording
from hardware.description.arrays import FloatArray, IntArray

_READ_SAMPLES = 200_000  # of all channels at a time


@dataclass(frozen=True)
class Trace:
    """Points to draw.

    Attributes
    ----------
    time_s, values
        Shapes ``(points,)`` and ``(channels, points)``.
    thinned
        Whether the points are the lowest and the highest of each stretch, in turns.
    """

    time_s: FloatArray
    values: FloatArray
    thinned: bool = False


def zigzag(time_s: FloatArray, values: FloatArray, bins: int) -> Trace:
    """Return a trace in at most ``2 * bins`` points that touches every extreme.

    Parameters
    ----------
    time_s, values
        Shapes ``(samples,)`` and ``(channels, samples)``. Handed through where they are few; NaN
        only where a whole stretch is missing.
    """
    if len(time_s) <= 2 * bins:
        return Trace(time_s, values)
    edges = _edges(len(time_s), bins)
    ends_s = time_s[edges[:-1]], time_s[edges[1:] - 1]
    return Trace(_middles(*ends_s), _extremes(values, edges[:-1]), True)


def tops(x: FloatArray, values: FloatArray, bins: int) -> tuple[FloatArray, FloatArray]:
    """Return the highest point of each stretch of one curve, and where it lies.

    Parameters
    ----------
    x, values
        Shape ``(points,)`` each; handed through where they are no more than ``bins``.
    """
    if len(x) <= bins:
        return x, values
    edges = _edges(len(x), bins)
    indices = np.array([a + int(np.argmax(values[a:b])) for a, b in pairwise(edges)])
    return x[indices], values[indices]


def overview(recording: Recording, bins: int) -> Trace:
    """Return a whole recording in at most ``2 * bins`` points, read in blocks."""
    if recording.sample_count <= 2 * bins:
        return Trace(recording.time_s(), recording.samples[:, 0 : recording.sample_count])
    edges = _edges(recording.sample_count, bins)
    parts = [
        _extremes(recording.samples[:, some[0] : some[-1]], some[:-1] - some[0])
        for some in _blocks(edges)
    ]
    firsts, lasts = edges[:-1].tolist(), (edges[1:] - 1).tolist()
    ends_s = [np.concatenate([recording.time_s(k, k + 1) for k in at]) for at in (firsts, lasts)]
    return Trace(_middles(*ends_s), np.concatenate(parts, axis=1), True)


def _edges(count: int, bins: int) -> IntArray:
    return np.asarray(np.linspace(0, count, bins + 1), dtype=np.int64)


def _middles(first_s: FloatArray, last_s: FloatArray) -> FloatArray:
    """Times of the two points of each bin: both at its middle."""
    return np.repeat((first_s + last_s) / 2.0, 2)


def _blocks(edges: IntArray) -> Iterator[IntArray]:
    """Whole bins, as many as are read at a time; consecutive blocks share an edge."""
    each = max(1, int(_READ_SAMPLES * (len(edges) - 1) / edges[-1]))
    for first in range(0, len(edges) - 1, each):
        yield edges[first : first + each + 1]


def _extremes(values: FloatArray, starts: IntArray) -> FloatArray:
    """Lowest and highest value from each start to the next, one after the other."""
    pairs = np.stack(
        (
            np.fmin.reduceat(values, starts, axis=1),
            np.fmax.reduceat(values, starts, axis=1),
        ),
        axis=-1,
    )
    return np.asarray(pairs.reshape(len(values), -1), dtype=np.float64)
