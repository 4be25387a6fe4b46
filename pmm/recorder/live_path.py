"""From the rig's devices to samples, pulses and readings: one path for run, replay and console."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from analysis.resolver.harmonics import Harmonics
from analysis.resolver.live_resolver import LiveResolver
from analysis.resolver.weights import REACH
from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel
from hardware.rig import Rig
from hardware.roles import Pulse, SampleBlock, Sampled
from pmm.recorder.header import LiveSettings

PATIENCE_CYCLES: Final = 4
"""For how many cycles a device's sample is waited for; then it is NaN.

An amplifier gives up a frame that is missing after 2 cycles: at half of this nothing is to spare.
At twice, what is recorded last before a device falls silent is shown, and flushed, 4 cycles later.
"""

HOLD_CYCLES: Final = REACH + 2 * PATIENCE_CYCLES + 4
"""For how many cycles a run goes on behind its gate, for the samples beyond the gate's edge."""


@dataclass(frozen=True)
class CycleSamples:
    """What a cycle brought.

    Attributes
    ----------
    first
        SYNC of the first sample.
    values
        Shape ``(channels, n)``: consecutive samples, NaN where nothing came.
    pulses
        Of the photocell.
    """

    first: int
    values: FloatArray
    pulses: tuple[Pulse, ...]


def joined_samples(taken: Sequence[CycleSamples], channels: int) -> FloatArray:
    """Return the samples of consecutive cycles, shape ``(channels, n)``."""
    return np.concatenate([np.empty((channels, 0)), *(cycle.values for cycle in taken)], axis=1)


@dataclass
class _Source:
    """A device, the rows of its channels, and its blocks, by SYNC, that are not used up."""

    device: Sampled
    rows: slice
    last: int
    offset: int | None = None  # SYNC of its sample number 0: for a device that counts its own
    waiting: list[SampleBlock] = field(default_factory=list)

    def listen(self, number: int) -> None:
        """Take what has come by cycle ``number``."""
        for piece in (taken := self.device.take()):
            if self.offset is None:
                off = number - _last_number(taken[-1])
                self.offset = 0 if abs(off) <= PATIENCE_CYCLES else off
            block = SampleBlock(piece.first + self.offset, piece.values)
            self.waiting.append(block)
            self.last = _last_number(block)

    def write(self, first: int, values: FloatArray) -> None:
        """Write what lies in samples from ``first`` on, and keep what lies beyond."""
        end = first + values.shape[1]
        for block in self.waiting:
            a, b = max(block.first, first), min(_last_number(block) + 1, end)
            if a < b:
                part = block.values[:, a - block.first : b - block.first]
                values[self.rows, a - first : b - first] = part
        self.waiting = [block for block in self.waiting if _last_number(block) >= end]


class LivePath:
    """Samples and pulses of a rig, cycle by cycle: shaft's angle, forces, carriage's speed.

    A sample is complete when all devices have delivered it, or have not for
    :data:`PATIENCE_CYCLES`. So it depends on nothing but the cycles in which its parts came, and a
    replay that begins at the same SYNC gives the same bits. What came before is left out.

    Attributes
    ----------
    channels
        In the order of the rows.
    next
        SYNC of the next sample to be handed out.
    """

    def __init__(self, rig: Rig) -> None:
        self._rig = rig
        self.channels = header_channels(rig)
        self.next = rig.number + 1
        self._sources: list[_Source] = []
        row = 0
        for sampled_device in sampled_devices(rig):
            self._sources.append(
                _Source(sampled_device, slice(row, row + len(sampled_device.channels)), rig.number)
            )
            row += len(sampled_device.channels)
            sampled_device.take()
        self._pulses()

    def step(self) -> CycleSamples:
        """Take what the rig's cycle brought; call it once after each."""
        number = self._rig.number
        for source in self._sources:
            source.listen(number)
        complete = min((source.last for source in self._sources), default=number)
        stop = max(number - PATIENCE_CYCLES, min(complete, number))
        first, self.next = self.next, max(stop + 1, self.next)
        values = np.full((len(self.channels), self.next - first), math.nan)
        for source in self._sources:
            source.write(first, values)
        return CycleSamples(first, values, self._pulses())

    def _pulses(self) -> tuple[Pulse, ...]:
        return () if self._rig.photocell is None else self._rig.photocell.take()


class GateResolver:
    """A live resolver from the arming of a gate on.

    Parameters
    ----------
    first
        SYNC of its first sample.
    """

    def __init__(
        self,
        channels: Sequence[Channel],
        sample_rate_hz: float,
        settings: LiveSettings,
        first: int,
    ) -> None:
        self.start_s = first / sample_rate_hz
        self._usable_from_s = self.start_s + REACH / sample_rate_hz + settings.latency_s
        self.resolver = LiveResolver(
            channels,
            sample_rate_hz,
            harmonics=settings.harmonics,
            periods=settings.periods,
            start_s=self.start_s,
            latency_s=settings.latency_s,
            angle_offset_rad=settings.angle_offset_rad,
        )
        self._next = first

    def takes(self, pulse: Pulse) -> bool:
        """Tell whether a pulse counts: the samples around it have to be there."""
        return pulse.time_s >= self._usable_from_s

    def push(self, taken: CycleSamples) -> list[Harmonics]:
        """Take a cycle's samples; return the readings that they made final."""
        values = taken.values[:, max(0, self._next - taken.first) :]
        self._next += values.shape[1]
        return self.resolver.push(values) if values.shape[1] else []


def sampled_devices(rig: Rig) -> tuple[Sampled, ...]:
    """Return the devices whose samples are recorded: shaft, force channels and carriage."""
    shaft = (rig.shaft,) if rig.shaft is not None and rig.shaft.channels else ()
    carriage = (rig.carriage,) if rig.carriage is not None and rig.carriage.channels else ()
    return (*shaft, *rig.forces, *carriage)


def header_channels(rig: Rig) -> tuple[Channel, ...]:
    """Return the recorded channels in the order of their samples' rows."""
    return tuple(c for sampled_device in sampled_devices(rig) for c in sampled_device.channels)


def as_record(reading: Harmonics) -> dict[str, Any]:
    """Return a reading as the journal keeps it; its numbers come back bit by bit."""
    return {
        "opened_s": float(reading.opened_s),
        "closed_s": float(reading.closed_s),
        "periods": int(reading.periods),
        "channels": list(reading.channel_names),
        "coefficients": reading.coefficients.tolist(),
    }


def _last_number(block: SampleBlock) -> int:
    return block.first + int(block.values.shape[1]) - 1
