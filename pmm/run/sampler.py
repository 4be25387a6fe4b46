"""Samples of several devices put together: consecutive SYNC numbers, NaN where nothing came."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel
from hardware.rig import Rig
from hardware.roles import Block, Sampled

PATIENCE_CYCLES = 4  # how long a sample of a device is waited for


@dataclass
class _Source:
    """A device, the rows of its channels, its own numbering, and what is not written yet."""

    device: Sampled
    rows: slice
    offset: int | None = None
    waiting: list[Block] = field(default_factory=list)


class Sampler:
    """Takes the samples of devices that share the rig's rate.

    Parameters
    ----------
    devices
        In the order of their channels.
    first
        Number of the first sample that is wanted.

    Attributes
    ----------
    channels
        Of all devices.
    next
        Number of the next sample to be handed out.
    lost, late
        Samples that never came; samples that came after their place had been handed out.
    """

    def __init__(self, devices: Sequence[Sampled], first: int) -> None:
        self.channels: tuple[Channel, ...] = tuple(c for one in devices for c in one.channels)
        self.next = first
        self.lost = self.late = 0
        self._sources: list[_Source] = []
        row = 0
        for device in devices:
            count = len(device.channels)
            self._sources.append(_Source(device, slice(row, row + count)))
            row += count

    def skip(self, number: int) -> None:
        """Throw away what has come, and go on with sample ``number``."""
        for one in self._sources:
            one.device.take()
            one.waiting.clear()
        self.next = number

    def collect(self, number: int, *, final: bool = False) -> FloatArray:
        """Return the samples from :attr:`next` on that are complete in cycle ``number``.

        Shape ``(channels, samples)``; ``final`` waits for nothing any more.
        """
        for source in self._sources:
            self._take(source, number)
        stop = number if final else max(number - PATIENCE_CYCLES, self._complete(number))
        count = max(stop - self.next + 1, 0)
        values = np.full((len(self.channels), count), math.nan)
        for source in self._sources:
            source.waiting = [
                one for one in source.waiting if not self._place(source, one, values, stop)
            ]
        self.next += count
        if values.size and np.isnan(values).any():
            self.lost += int(np.isnan(values).any(axis=0).sum())
        return values

    def _take(self, source: _Source, number: int) -> None:
        taken = source.device.take()
        if taken and source.offset is None:
            last = taken[-1].first + taken[-1].values.shape[1] - 1
            on_sync = abs(number - last) <= PATIENCE_CYCLES
            source.offset = 0 if on_sync else number - last
        for block in taken:
            before = self.next - block.first - (source.offset or 0)
            self.late += min(max(before, 0), block.values.shape[1])
        source.waiting += taken

    def _complete(self, number: int) -> int:
        """Return the number up to which every device has delivered."""
        ends = [
            source.waiting[-1].first + source.waiting[-1].values.shape[1] - 1 + source.offset
            if source.waiting and source.offset is not None
            else self.next - 1
            for source in self._sources
        ]
        return min([number, *ends])

    def _place(self, source: _Source, block: Block, values: FloatArray, stop: int) -> bool:
        """Write what lies up to ``stop``; tell whether the block is used up."""
        first = block.first + (source.offset or 0)
        end = first + block.values.shape[1]
        start, until = max(first, self.next), min(end, stop + 1)
        if until > start:
            values[source.rows, start - self.next : until - self.next] = block.values[
                :, start - first : until - first
            ]
        return bool(end <= stop + 1)


def sampled_devices(rig: Rig) -> tuple[Sampled, ...]:
    """Return the devices whose samples a run records: shaft and force channels."""
    shaft = (rig.shaft,) if rig.shaft is not None and rig.shaft.channels else ()
    return (*shaft, *rig.forces)


def header_channels(rig: Rig) -> tuple[Channel, ...]:
    """Return the channels of a run in the order of its samples."""
    return tuple(c for one in sampled_devices(rig) for c in one.channels)
