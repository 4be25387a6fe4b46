"""From the rig's devices to samples and readings: the same for a run and for its replay."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final

import numpy as np

from analysis.resolver.harmonics import Harmonics
from analysis.resolver.live import LiveResolver, Provisional
from hardware.description.channels import Channel
from hardware.rig import Rig
from hardware.roles import Pulse, Sampled
from pmm.recorder.header import LiveSettings
from pmm.recorder.samples import Piece

PATIENCE_CYCLES: Final = 3


@dataclass(frozen=True)
class Taken:
    """What a cycle brought.

    Attributes
    ----------
    samples
        First SYNC and values, shape ``(channels, n)``, of each stretch without a gap.
    readings
        Those that are final.
    """

    samples: tuple[Piece, ...] = ()
    pulses: tuple[Pulse, ...] = ()
    readings: tuple[Harmonics, ...] = ()


class Assembler:
    """Puts the blocks of several devices together by their SYNC.

    A sample is complete when all devices have delivered it, or have not for three cycles: then it
    is NaN for those.
    """

    def __init__(self, devices: Sequence[Sampled], first: int) -> None:
        self._devices = tuple(one for one in devices if one.channels)
        self._rows: dict[int, list[float]] = {}
        self._waits: dict[int, int] = {}
        self._next = first
        self._width = len(self.channels)

    @property
    def channels(self) -> tuple[Channel, ...]:
        """The channels, in the order of the rows."""
        return tuple(channel for one in self._devices for channel in one.channels)

    @property
    def sources(self) -> dict[str, str]:
        """Channel to the name of its device."""
        return {channel.name: one.name for one in self._devices for channel in one.channels}

    def take(self, newest: int) -> tuple[Piece, ...]:
        """Return what is complete after cycle ``newest``, in stretches without a gap."""
        self._collect()
        ready: list[int] = []
        for number in sorted(self._rows):
            if self._waits[number] and number > newest - PATIENCE_CYCLES:
                break
            ready.append(number)
        return self._pieces(ready)

    def finish(self) -> tuple[Piece, ...]:
        """Return what is left, complete or not."""
        self._collect()
        return self._pieces(sorted(self._rows))

    def _collect(self) -> None:
        row = 0
        for device in self._devices:
            for block in device.take():
                for i, values in enumerate(block.values.T.tolist()):
                    self._put(block.first + i, row, values)
            row += len(device.channels)

    def _put(self, number: int, row: int, values: list[float]) -> None:
        if number < self._next:
            return  # from before the run, or later than anyone waits
        if number not in self._rows:
            self._rows[number] = [math.nan] * self._width
            self._waits[number] = len(self._devices)
        self._rows[number][row : row + len(values)] = values
        self._waits[number] -= 1

    def _pieces(self, ready: list[int]) -> tuple[Piece, ...]:
        if not ready:
            return ()
        self._next = ready[-1] + 1
        cuts = [0, *(i for i in range(1, len(ready)) if ready[i] != ready[i - 1] + 1), len(ready)]
        pieces = []
        for a, b in pairwise(cuts):
            rows = [self._rows.pop(number) for number in ready[a:b]]
            pieces.append((ready[a], np.array(rows).T))
        for number in ready:
            del self._waits[number]
        return tuple(pieces)


class LivePath:
    """Samples, pulses and readings of a rig, cycle by cycle.

    Parameters
    ----------
    first
        SYNC of the first sample that counts; earlier ones are left out.
    """

    def __init__(self, rig: Rig, first: int, settings: LiveSettings) -> None:
        shaft = () if rig.shaft is None else (rig.shaft,)
        self._photocell = rig.photocell
        self._assembler = Assembler((*shaft, *rig.forces), first)
        self._next = first
        rate_hz = rig.configuration.sample_rate_hz
        self._resolver = LiveResolver(
            self.channels,
            rate_hz,
            harmonics=settings.harmonics,
            periods=settings.periods,
            start_s=first / rate_hz,
            latency_s=settings.latency_s,
            angle_offset_rad=settings.angle_offset_rad,
        )
        self._start_s = (first - 1) / rate_hz
        self._last_pulse_s = -math.inf

    @property
    def channels(self) -> tuple[Channel, ...]:
        """The channels, in the order of the samples' rows: the shaft's angle, then the forces."""
        return self._assembler.channels

    @property
    def sources(self) -> dict[str, str]:
        """Channel to the name of its device."""
        return self._assembler.sources

    def step(self, number: int) -> Taken:
        """Take what cycle ``number`` brought; call it after :meth:`hardware.rig.Rig.cycle`."""
        return self._feed(self._assembler.take(number))

    def finish(self) -> Taken:
        """Take what was still waited for, and the readings that only a run's end makes final."""
        taken = self._feed(self._assembler.finish())
        return Taken(taken.samples, taken.pulses, (*taken.readings, *self._resolver.finish()))

    def provisional(self) -> Provisional | None:
        """Return the needles between pulses; ``None`` before the first period."""
        return self._resolver.provisional()

    def _feed(self, samples: tuple[Piece, ...]) -> Taken:
        readings: list[Harmonics] = []
        for first, values in samples:
            if first > self._next:  # the resolver counts samples: what is missing is NaN
                gap = np.full((values.shape[0], first - self._next), np.nan)
                readings += self._resolver.push(gap)
            readings += self._resolver.push(values)
            self._next = first + values.shape[1]
        taken = () if self._photocell is None else self._photocell.take()
        pulses = tuple(one for one in taken if one.time_s > self._start_s)
        for one in pulses:
            if one.time_s > self._last_pulse_s:
                self._last_pulse_s = one.time_s
                readings += self._resolver.pulse(one.time_s)
        return Taken(samples, pulses, tuple(readings))


def as_record(reading: Harmonics) -> dict[str, Any]:
    """Return a reading as the journal keeps it; its numbers come back bit by bit."""
    return {
        "opened_s": float(reading.opened_s),
        "closed_s": float(reading.closed_s),
        "periods": int(reading.periods),
        "channels": list(reading.channel_names),
        "coefficients": reading.coefficients.tolist(),
    }
