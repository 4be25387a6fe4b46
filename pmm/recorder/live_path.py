"""From the rig's devices to samples and readings: the same for a run and for its replay."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, Final

import numpy as np

from analysis.resolver.harmonics import Harmonics
from analysis.resolver.live import LiveResolver
from hardware.description.arrays import FloatArray
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


class Gatherer:
    """Samples and pulses of a rig, cycle by cycle: the shaft's angle, then the forces.

    Parameters
    ----------
    first
        SYNC of the first sample that counts; earlier ones, and the pulses so far, are left out.
    """

    def __init__(self, rig: Rig, first: int) -> None:
        shaft = () if rig.shaft is None else (rig.shaft,)
        assembler = Assembler((*shaft, *rig.forces), first)
        self.channels, self.sources = assembler.channels, assembler.sources
        self._assembler, self._photocell = assembler, rig.photocell
        self._pulses()

    def step(self, number: int) -> Taken:
        """Take what cycle ``number`` brought; call it after :meth:`hardware.rig.Rig.cycle`."""
        return Taken(self._assembler.take(number), self._pulses())

    def finish(self) -> Taken:
        """Take what was still waited for."""
        return Taken(self._assembler.finish(), self._pulses())

    def _pulses(self) -> tuple[Pulse, ...]:
        return () if self._photocell is None else self._photocell.take()


class Feed:
    """A live resolver that is fed from a SYNC on, what is missing as NaN.

    Parameters
    ----------
    first
        SYNC of the resolver's first sample.
    pulses_from_s
        Earlier pulses do not count.
    """

    def __init__(
        self,
        channels: Sequence[Channel],
        sample_rate_hz: float,
        settings: LiveSettings,
        first: int,
        pulses_from_s: float,
    ) -> None:
        self.resolver = LiveResolver(
            channels,
            sample_rate_hz,
            harmonics=settings.harmonics,
            periods=settings.periods,
            start_s=first / sample_rate_hz,
            latency_s=settings.latency_s,
            angle_offset_rad=settings.angle_offset_rad,
        )
        self._next = first
        self._after_s = pulses_from_s

    def take(self, taken: Taken) -> list[Harmonics]:
        """Take what a cycle brought; return the readings that it made final."""
        readings: list[Harmonics] = []
        for first, values in taken.samples:
            readings += self._push(first, values)
        for one in taken.pulses:
            if one.time_s >= self._after_s:
                self._after_s = math.nextafter(one.time_s, math.inf)
                readings += self.resolver.pulse(one.time_s)
        return readings

    def _push(self, first: int, values: FloatArray) -> list[Harmonics]:
        values, first = values[:, max(0, self._next - first) :], max(first, self._next)
        if not values.shape[1]:
            return []
        missing = np.full((values.shape[0], first - self._next), np.nan)
        self._next = first + values.shape[1]
        return self.resolver.push(np.concatenate([missing, values], axis=1))


class LivePath:
    """Samples, pulses and readings of a rig, cycle by cycle; see :class:`Gatherer`."""

    def __init__(self, rig: Rig, first: int, settings: LiveSettings) -> None:
        self._gatherer = Gatherer(rig, first)
        self.channels, self.sources = self._gatherer.channels, self._gatherer.sources
        rate_hz = rig.configuration.sample_rate_hz
        self._feed = Feed(self.channels, rate_hz, settings, first, first / rate_hz)

    def step(self, number: int) -> Taken:
        """Take what cycle ``number`` brought, and the readings it made final."""
        taken = self._gatherer.step(number)
        return replace(taken, readings=tuple(self._feed.take(taken)))

    def finish(self) -> Taken:
        """Take what was still waited for, and the readings that only a run's end makes final."""
        taken = self._gatherer.finish()
        readings = (*self._feed.take(taken), *self._feed.resolver.finish())
        return replace(taken, readings=readings)


def as_record(reading: Harmonics) -> dict[str, Any]:
    """Return a reading as the journal keeps it; its numbers come back bit by bit."""
    return {
        "opened_s": float(reading.opened_s),
        "closed_s": float(reading.closed_s),
        "periods": int(reading.periods),
        "channels": list(reading.channel_names),
        "coefficients": reading.coefficients.tolist(),
    }
