"""What the devices of a rig read now, as rows for a table."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from hardware.cia402 import state_of
from hardware.errors import HardwareError, Reaction
from hardware.rig import Rig
from hardware.roles import PositionAxis, Powered, Sampled, Shaft


@dataclass(frozen=True)
class DeviceRow:
    """One value of a device.

    Attributes
    ----------
    value
        A number in ``unit``, or a word; NaN for a number that is not known.
    """

    device: str
    what: str
    value: float | str
    unit: str = ""


class Live:
    """Runs a rig's cycles and keeps what its devices last said."""

    def __init__(self, rig: Rig) -> None:
        self.rig = rig
        self.said: list[str] = []  # faults, oldest first
        self._latest: dict[str, tuple[float, ...]] = {}
        self._pulses = 0
        self._pulse_s = math.nan

    def run(self, seconds: float) -> None:
        """Let cycles pass.

        Raises
        ------
        HardwareError
            If the bus is lost; other faults are kept in :attr:`said`.
        """
        for _ in range(max(1, round(seconds * self.rig.configuration.sample_rate_hz))):
            try:
                self.rig.cycle()
            except HardwareError as error:
                if error.reaction is Reaction.END_RUN:
                    raise
                self.said.append(str(error))
        self._take()

    def rows(self) -> tuple[DeviceRow, ...]:
        """Return a row for each device, with its latest reading."""
        return tuple(self._rows())

    def _take(self) -> None:
        """Keep the mean of what each channel has read since the last time."""
        rig = self.rig
        for device in (rig.shaft, rig.inclinometer, *rig.forces, rig.carriage):
            blocks = device.take() if device is not None else ()
            if device is None or not blocks:
                continue
            values = np.concatenate([block.values for block in blocks], axis=1)
            # An angle that grows is told by its last sample, a noisy force by its mean.
            last = values[:, -1] if device is rig.shaft else np.mean(values, axis=1)
            self._latest[device.name] = tuple(float(value) for value in last)
        for pulse in rig.photocell.take() if rig.photocell is not None else ():
            self._pulses += 1
            self._pulse_s = pulse.time_s

    def _rows(self) -> Iterator[DeviceRow]:
        rig = self.rig
        if rig.shaft is not None:
            yield from _shaft(rig.shaft)
            yield from self._channels(rig.shaft)
        for axis in rig.axes():
            yield from _axis(axis)
        if rig.carriage is not None:
            yield _state(rig.carriage)
            yield from self._channels(rig.carriage)
        for device in (*rig.forces, *((rig.inclinometer,) if rig.inclinometer else ())):
            yield from self._channels(device)
        if rig.photocell is not None:
            yield DeviceRow(rig.photocell.name, "pulses", float(self._pulses))
            yield DeviceRow(rig.photocell.name, "last pulse", self._pulse_s, "s")
        if rig.master is not None:
            yield DeviceRow("bus", "error frames", float(rig.master.error_frames.total))

    def _channels(self, device: Sampled) -> Iterator[DeviceRow]:
        unknown = (math.nan,) * len(device.channels)
        values = self._latest.get(device.name, unknown)
        for channel, value in zip(device.channels, values, strict=True):
            yield DeviceRow(device.name, channel.name, value, channel.unit)


def _state(device: Powered) -> DeviceRow:
    """Return a drive's own state; of another device, whether it has power."""
    drive = getattr(device, "drive", None)
    if drive is None:
        return DeviceRow(device.name, "state", "enabled" if device.enabled else "disabled")
    return DeviceRow(
        device.name, "state", state_of(int(drive.status)).name.lower().replace("_", " ")
    )


def _shaft(shaft: Shaft) -> Iterator[DeviceRow]:
    yield _state(shaft)
    yield DeviceRow(shaft.name, "frequency", shaft.measured_frequency_hz, "Hz")


def _axis(axis: PositionAxis) -> Iterator[DeviceRow]:
    yield _state(axis)
    reading = axis.reading
    yield DeviceRow(axis.name, "homed", "yes" if axis.homed else "no")
    yield DeviceRow(
        axis.name, "position", math.nan if reading is None else reading.value, axis.unit
    )
