"""Samples on their way to the screen: tapped beside the recorder, and thinned for the eye."""

from collections.abc import Mapping, Sequence
from itertools import accumulate
from pathlib import Path
from typing import Any, Final

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.flags import Flag
from hardware.rig import Rig
from hardware.roles import Block, Pulse
from pmm.console.messages import Trace
from pmm.recorder.lateness import CycleStatistics
from pmm.recorder.run_recorder import Outcome
from pmm.run.journal import Journal
from pmm.run.sampler import sampled_devices

POINTS: Final = 2000  # of each trace
WINDOW_S: Final = 20.0


def points_a_second(sample_rate_hz: float) -> tuple[int, float]:
    """Return how many samples become a point, and the points per second.

    Where samples are more than points, pairs of points are the lowest and the highest of twice as
    many samples: a spike of one sample stays to be seen.
    """
    samples = max(1, round(sample_rate_hz * WINDOW_S / POINTS))
    return samples, sample_rate_hz / samples


class Traces:
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

    def add_parts(self, number: int, parts: Sequence[tuple[int, Block]]) -> None:
        """Take what devices deliver between runs, each from its row on, as of cycle ``number``.

        Nothing is recorded then: a device that is late by a sample is shown late by a sample.
        """
        count = max(block.values.shape[1] for _, block in parts)
        values = np.full((len(self._rest), count), np.nan)
        for row, block in parts:
            rows, samples = block.values.shape
            values[row : row + rows, count - samples :] = block.values
        self.add(number - count + 1, values)

    def take(self) -> Trace:
        """Return the points that are complete."""
        bucket = self._each if self._each == 1 else 2 * self._each
        whole = self._rest.shape[1] // bucket * bucket
        done, self._rest = self._rest[:, :whole], self._rest[:, whole:]
        first = (self._next or 0) - self._rest.shape[1] - whole
        return Trace(first // self._each, first / self._rate_hz, self._thin(done))

    def _thin(self, samples: FloatArray) -> FloatArray:
        if self._each == 1 or not samples.size:
            return samples
        buckets = samples.reshape(len(samples), -1, 2 * self._each)
        places = np.sort(np.stack((buckets.argmin(axis=2), buckets.argmax(axis=2)), axis=2), axis=2)
        return np.take_along_axis(buckets, places, axis=2).reshape(len(samples), -1)


def show_idle(rig: Rig, traces: Traces) -> None:
    """Let the traces go on between runs, and devices not keep their samples for ever."""
    devices = sampled_devices(rig)
    rows = accumulate((len(one.channels) for one in devices), initial=0)
    taken = [(row, one.take()) for row, one in zip(rows, devices, strict=False)]
    parts = [(row, block) for row, blocks in taken for block in blocks]
    if parts:
        traces.add_parts(rig.number, parts)


class TappedJournal:
    """A recorder that lets the traces see the samples it is given."""

    def __init__(self, journal: Journal, traces: Traces) -> None:
        self._journal, self._traces = journal, traces

    @property
    def begun(self) -> bool:
        """Whether there is something to keep."""
        return self._journal.begun

    def opened(self, *, wait: bool) -> bool:
        """Tell whether the recorder is open."""
        return self._journal.opened(wait=wait)

    def samples(self, first_sync: int, values: FloatArray) -> None:
        """Keep consecutive samples, and show them."""
        self._journal.samples(first_sync, values)
        self._traces.add(first_sync, values)

    def pulse(self, pulse: Pulse) -> None:
        """Keep a pulse."""
        self._journal.pulse(pulse)

    def event(self, cycle: int, time_s: float, kind: str, text: str) -> None:
        """Keep what happened."""
        self._journal.event(cycle, time_s, kind, text)

    def harmonic(self, reading: Mapping[str, Any]) -> None:
        """Keep a final reading."""
        self._journal.harmonic(reading)

    def cycle_statistics(self, lateness_s: float) -> None:
        """Keep how late a cycle began."""
        self._journal.cycle_statistics(lateness_s)

    def statistics(self) -> CycleStatistics:
        """Return how late the cycles were."""
        return self._journal.statistics()

    def tick(self, now_s: float) -> None:
        """Flush what is due."""
        self._journal.tick(now_s)

    def close(self, outcome: Outcome, flags: Sequence[Flag]) -> Path:
        """Complete the run."""
        return self._journal.close(outcome, flags)
