"""Spikes: one to three samples that neither their neighbours nor the rest of the record explain.

What a record does by itself is measured by its curvature, the second difference of its samples:
noise, steep waves, corners, steps and impacts all show there. A spike is taken out by the cubic
through the samples beside it, and is one where that makes the curvature around it less than an
eighth, where it is eight times that of all in the record that is no such pulse, and where it does
not come again and again as what moves does. A step, a corner or a ring remains beside the cubic; a
photocell's pulse and an impact at each reversal come again. The rest of the record is the limit, so
that the noise need not be known: of white Gaussian noise one sample in a million is 4.9 standard
deviations, and it takes about 45 to be a spike.

``docs/decisions/0019-spikes.md`` has what was measured.
"""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from analysis.recording import Samples
from hardware.description.arrays import FloatArray, IntArray

LONGEST_SPIKE: Final = 3  # samples: more is an event, not a sample gone wrong
STANDS_OUT: Final = 8.0  # times the curvature of the rest; the cubic leaves 1/5.5 of a step's
CALM: Final = 8  # samples on either side over which the cubic must have made it calm
MOST_OF_A_CHANNEL: Final = 0.005  # of its samples; more pulses than that are what it measures
MOST: Final = 100  # spikes in a channel
SAME_INTERVAL: Final = 1.05  # times: intervals nearer to each other are alike
FEWEST_LEVELS: Final = 16  # fewer: a switch, or a display of a few digits

_CHUNK: Final = 32  # samples of which only the greatest curvature is kept
_BLOCK: Final = 1024 * _CHUNK  # samples read at a time
AROUND: Final = CALM + LONGEST_SPIKE + 2  # samples of a window to either side of a curvature
_NEAREST_END: Final = 4  # samples that a spike is at least away from the record's ends


@dataclass(frozen=True, eq=False)
class Spike:
    """Samples ``start`` to ``stop`` (exclusive) that are no measurement.

    Attributes
    ----------
    size
        How far the worst of them lies from the cubic, with its sign, in the channel's unit.
    curvature
        The largest second difference at it.
    replacement
        The cubic's values, shape ``(stop - start,)``.
    """

    start: int
    stop: int
    size: float
    curvature: float
    replacement: FloatArray

    def moved(self, samples: int) -> "Spike":
        """Return the spike as counted from a sample so many earlier."""
        return replace(self, start=self.start + samples, stop=self.stop + samples)


@dataclass(frozen=True)
class Pulses:
    """What stands out of a channel, and how much the rest of it bends.

    Attributes
    ----------
    candidates
        Short pulses in calm surroundings, in order of time; all bend more than the rest.
    rest
        The largest second difference of all else; infinite where there are more pulses than spikes
        could be.
    """

    candidates: tuple[Spike, ...]
    rest: float

    def spikes(self) -> tuple[Spike, ...]:
        """Return the pulses that are spikes: those that stand out, and do not recur as motion."""
        tall = [pulse for pulse in self.candidates if pulse.curvature > STANDS_OUT * self.rest]
        return tuple(pulse for pulse in tall if not _recur(self._pulses_like(pulse)))

    def _pulses_like(self, spike: Spike) -> FloatArray:
        """Return the places of all pulses that bend an eighth as much or more."""
        starts = [
            pulse.start
            for pulse in self.candidates
            if pulse.curvature * STANDS_OUT >= spike.curvature
        ]
        return np.array(starts, dtype=np.float64)


def find_spikes(samples: Samples) -> tuple[tuple[Spike, ...], ...]:
    """Find the spikes of each channel; what is long is read a stretch at a time.

    Missing samples are passed over. Spikes nearer to each other than 8 samples, or nearer to an end
    of the record than 4, are not found.
    """
    if samples.shape[1] <= _BLOCK:
        samples = samples[:, 0 : samples.shape[1]]  # read once
    with np.errstate(over="ignore", invalid="ignore"):  # of numbers near the largest
        curvature = _curvature(samples)
        return tuple(_spikes_of(samples, row, largest) for row, largest in enumerate(curvature))


def most_of(count: int) -> int:
    """Return how many spikes so many samples of a channel may have."""
    return min(MOST, max(1, int(MOST_OF_A_CHANNEL * count)))


def find_pulses(
    samples: Samples, row: int, curvature: FloatArray, most: int, until: int | None = None
) -> Pulses:
    """Walk down from where a channel bends most until what bends is no pulse.

    Parameters
    ----------
    curvature
        The largest second differences of each 32 samples, shape ``(chunks,)``; changed in place.
    most
        Pulses beyond which none is a spike.
    until
        Sample from which on nothing is sought: what lies there is seen as surroundings alone.
        ``None`` for the whole.
    """
    count = samples.shape[1]
    until = count if until is None else until
    pulses: list[Spike] = []
    while curvature.size:
        chunk = int(np.argmax(curvature))
        place, values, bend = _window(samples, row, chunk, pulses, until)
        if bend < curvature[chunk]:
            curvature[chunk] = bend  # what was taken out stood here too
            continue
        pulse = _pulse(place, values, count) if 0.0 < bend < np.inf else None
        if pulse is None or any(_touch(pulse, earlier) for earlier in pulses):
            return Pulses(tuple(sorted(pulses, key=lambda item: item.start)), bend)
        pulses.append(pulse)
        if len(pulses) > most:
            return Pulses((), np.inf)
    return Pulses((), 0.0)


def _spikes_of(samples: Samples, row: int, curvature: FloatArray) -> tuple[Spike, ...]:
    spikes = find_pulses(samples, row, curvature, most_of(samples.shape[1])).spikes()
    return () if spikes and switches(samples, row) else spikes


def _curvature(samples: Samples) -> FloatArray:
    """Return the largest second difference of each 32 samples, shape ``(channels, chunks)``."""
    channels, count = samples.shape
    chunks_curvature = [
        curvature_of_chunks(samples[:, start : min(start + _BLOCK + 2, count)])
        for start in range(0, max(count - 2, 0), _BLOCK)
    ]
    return np.concatenate([np.zeros((channels, 0)), *chunks_curvature], axis=1)


def curvature_of_chunks(values: FloatArray) -> FloatArray:
    """Return the largest second difference of each 32 of some samples; see :func:`find_pulses`.

    Parameters
    ----------
    values
        Shape ``(channels, samples)``; over missing samples goes a straight line.
    """
    chunks = -(-(values.shape[1] - 2) // _CHUNK)
    largest = np.empty((len(values), max(chunks, 0)))
    for row, channel in zip(largest, values, strict=True):
        bend = np.zeros(row.size * _CHUNK)
        _second_difference(_without_holes(channel), bend[: channel.size - 2])
        bend.reshape(-1, _CHUNK).max(axis=1, out=row)
    return largest


def _second_difference(values: FloatArray, into: FloatArray) -> None:
    steps = np.diff(values)
    np.subtract(steps[1:], steps[:-1], out=into)
    np.abs(into, out=into)


def _without_holes(values: FloatArray) -> FloatArray:
    if np.isfinite(values.sum()):
        return values
    good = np.flatnonzero(np.isfinite(values))
    if not good.size:
        return np.zeros_like(values)
    return np.interp(np.arange(values.size), good, values[good])


def _window(
    samples: Samples, row: int, chunk: int, spikes: list[Spike], until: int
) -> tuple[IntArray, FloatArray, float]:
    """Return the good samples around where a chunk bends most: their numbers and values, the bend.

    What has been found already is taken out.
    """
    first = max(0, chunk * _CHUNK - 2 * AROUND)
    stop = min(samples.shape[1], (chunk + 1) * _CHUNK + 2 * AROUND)
    values = np.array(samples[row : row + 1, first:stop][0])
    for spike in spikes:
        within = slice(max(spike.start - first, 0), max(spike.stop - first, 0))
        values[within] = spike.replacement[max(first - spike.start, 0) :][: values[within].size]
    good = np.flatnonzero(np.isfinite(values))
    place, values = good + first, values[good]
    bend = np.abs(np.diff(values, n=2))
    last = min((chunk + 1) * _CHUNK, until - 1)
    in_chunk = (place[1:-1] > chunk * _CHUNK) & (place[1:-1] <= last)
    if not in_chunk.any():
        return place, values, 0.0
    at = 1 + int(np.argmax(np.where(in_chunk, bend, -1.0)))
    window = slice(max(0, at - AROUND), at + AROUND + 1)
    return place[window], values[window], float(bend[at - 1])


def _pulse(place: IntArray, values: FloatArray, count: int) -> Spike | None:
    """Return the pulse in a window, if one to three samples are all that bends there.

    Of those that calm the window the shortest is taken that does it about as well as any.
    """
    bends = np.abs(np.diff(values, n=2))
    at, bend = 1 + int(np.argmax(bends)), float(bends.max())
    beyond = np.abs(np.arange(1, values.size - 1) - at) > LONGEST_SPIKE + 1
    if bends[beyond].max(initial=0.0) * STANDS_OUT > bend:
        return None  # no cubic reaches that far
    trials = []
    for length in range(1, LONGEST_SPIKE + 1):
        weights = cubic(length)
        for start in range(max(at - length, 2), min(at + 2, values.size - length - 1)):
            if place[start + length - 1] - place[start] != length - 1:
                continue  # one side of a gap, not both
            without = values.copy()
            neighbours = [start - 2, start - 1, start + length, start + length + 1]
            without[start : start + length] = weights @ values[neighbours]
            bend_left = float(np.abs(np.diff(without, n=2)).max())
            trials.append((bend_left, length, start, without))
    best = min((bend_left for bend_left, *_ in trials), default=np.inf)
    if not bend > STANDS_OUT * best:
        return None
    _, length, start, without = next(trial for trial in trials if trial[0] <= 2.0 * best)
    inside = slice(start, start + length)
    height = values[inside] - without[inside]
    first, last = int(place[start]), int(place[start + length - 1]) + 1
    if first < _NEAREST_END or last > count - _NEAREST_END:
        return None
    pulse_place = place[start - 2 : start + length + 2]
    unbroken = int(pulse_place[-1] - pulse_place[0]) == pulse_place.size - 1
    instead = without[inside].copy() if unbroken else np.full(length, np.nan)
    size = float(height[np.argmax(np.abs(height))])
    return Spike(first, last, size, bend, instead)


def cubic(length: int) -> FloatArray:
    """Lagrange weights, shape ``(length, 4)``, of the two samples before and after a run."""
    nodes = np.array([-2.0, -1.0, length, length + 1.0])
    places = np.arange(length, dtype=np.float64)
    weights = np.ones((length, 4))
    for k in range(4):
        for node in np.delete(nodes, k):
            weights[:, k] *= (places - node) / (nodes[k] - node)
    return weights


def _touch(spike: Spike, neighbour: Spike) -> bool:
    """Whether a pulse stands on what another's cubic rests on: then both are one longer event."""
    return spike.start - 2 < neighbour.stop + 2 and neighbour.start - 2 < spike.stop + 2


def _recur(times: FloatArray) -> bool:
    """Whether most pulses follow each other, or the one before the last, at like intervals."""
    intervals = np.diff(times)
    for lag in (1, 2):
        ratio = intervals[lag:] / intervals[:-lag]
        steady = (ratio < SAME_INTERVAL) & (ratio > 1.0 / SAME_INTERVAL)
        if 2 * np.count_nonzero(steady) > steady.size:
            return True
    return False


def switches(samples: Samples, row: int) -> bool:
    """Whether a channel has so few values that it is a switch, or a display of a few digits."""
    count = samples.shape[1]
    levels: FloatArray = np.zeros(0)
    for start in range(0, count, _BLOCK):
        values = samples[row : row + 1, start : min(start + _BLOCK, count)][0]
        levels = np.unique(np.concatenate((levels, values[np.isfinite(values)])))
        if levels.size >= FEWEST_LEVELS:
            return False
    return True
