"""The photocell on a small microcontroller that stamps its pulses and sends them by serial line."""

from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from hardware.driver import Driver, Services
from hardware.errors import (
    HardwareError,
    PhotocellDeadError,
    PhotocellExtraError,
    PhotocellMissedError,
)
from hardware.lines import TICK_MODULUS, LineKind, SerialLine, Unwrapped
from hardware.roles import Cycle, Pulse, Role
from hardware.serial_instrument import SerialInstrument
from hardware.serial_port import PortSettings

_MARKS: Final = 240
_ENOUGH: Final = 3
_JUMP_S: Final = 1.0
"""So far from where the fit has it, a line shows that the device began to count anew. A line is
under way for a cycle and its transmission; half might be a server that stalls, twice lets a pulse
be two seconds off."""


class ClockFit:
    """Turns a device's time into the rig's.

    A mark arrives late by the transmission and by up to one cycle, never early. So the slope comes
    from all recent marks by least squares, and the line is then lowered onto the least delayed one.
    Until there are enough marks the clocks are taken to run equally fast.
    """

    def __init__(self) -> None:
        self._device: deque[float] = deque(maxlen=_MARKS)
        self._rig: deque[float] = deque(maxlen=_MARKS)
        self._slope = 1.0
        self._offset_s = 0.0

    @property
    def marks(self) -> list[tuple[float, float]]:
        """The marks that count now: the device's time and the rig's time when it had arrived."""
        return list(zip(self._device, self._rig, strict=True))

    def add(self, device_s: float, arrived_s: float) -> None:
        """Take a mark: the device's time in it, and the rig's time when it had arrived."""
        self._device.append(device_s)
        self._rig.append(arrived_s)
        device, rig = np.array(self._device), np.array(self._rig)
        if len(device) >= _ENOUGH and device[-1] > device[0]:
            off = device - device.mean()
            self._slope = float(off @ (rig - rig.mean()) / (off @ off))
        self._offset_s = float(np.min(rig - self._slope * device))

    def is_of(self, device_s: float, arrived_s: float) -> bool:
        """Whether a mark can be of the clock of those before it; the first one is."""
        return not self._rig or abs(arrived_s - self.rig_time_s(device_s)) <= _JUMP_S

    def rig_time_s(self, device_s: float) -> float:
        """Return the rig's time for a time of the device."""
        return self._slope * device_s + self._offset_s


_MISSED_PERIODS, _DEAD_PERIODS, _EXTRA_PERIODS = 1.5, 3.5, 0.5


@dataclass(frozen=True)
class TimestamperSettings:
    """Settings of a serial timestamper.

    Attributes
    ----------
    silent_s
        It sends a mark every second or more often; after so long without a line it is silent.
    """

    port: PortSettings
    silent_s: float = 3.0


class SerialPhotocell(SerialInstrument):
    """A :class:`hardware.roles.Photocell` that knows the time of each pulse to a microsecond.

    Attributes
    ----------
    fit
        Drift of its clock against the bus.
    """

    def __init__(self, name: str, settings: TimestamperSettings, services: Services) -> None:
        super().__init__(name, settings, services, (LineKind.PULSE, LineKind.TIME))
        self._begin()
        self._pulses: list[Pulse] = []
        self._period_s: float | None = None

    def _begin(self) -> None:
        """Know nothing of the device's clock and counts: it may have begun anew."""
        self.fit = ClockFit()
        self._ticks = Unwrapped(TICK_MODULUS)
        self._count: int | None = None
        self._at_s: float | None = None  # of the last pulse, in the rig's time
        self._waiting_s: float | None = None  # since when the first pulse is due

    def expect(self, frequency_hz: float | None) -> None:
        """Say how fast the shaft turns; ``None``: it is idle, a lost port is opened again."""
        self._period_s = 1.0 / frequency_hz if frequency_hz else None
        self._at_s = self._waiting_s = None
        self._told.clear()

    def tick(self, cycle: Cycle) -> None:
        """Take the lines of the cycle.

        Raises
        ------
        PhotocellMissedError, PhotocellExtraError, PhotocellDeadError
            As the pulses show; ``expect`` says how many belong.
        UnpluggedError, SilentPortError, LineError
            As the line does.
        """
        self._begin_where_lost()
        if self._period_s is None:
            self._port.recover(cycle.time_s)
        self._read(cycle)

    def take(self) -> tuple[Pulse, ...]:
        """Return the pulses since the last call."""
        taken, self._pulses = tuple(self._pulses), []
        return taken

    def carried(self) -> dict[str, Any]:
        """Return counts and the marks of the clocks; see :mod:`hardware.carry_over`."""
        return {"ticks": self._ticks.value, "count": self._count, "marks": self.fit.marks}

    def carry_on(self, carried: Mapping[str, Any]) -> None:
        """Go on from there."""
        self._ticks.value, self._count = carried["ticks"], carried["count"]
        for device_s, arrived_s in carried["marks"]:
            self.fit.add(device_s, arrived_s)

    def reconnect(self) -> None:
        """Open a lost port again; raises as :meth:`reset_fault`."""
        self._begin_where_lost()
        super().reconnect()

    def reset_fault(self) -> None:
        """Open a lost port again and begin anew.

        Raises
        ------
        PortOpenError
            If the port is still not there.
        """
        self._begin_where_lost()
        super().reset_fault()
        self._at_s = self._waiting_s = self._count = None

    def _begin_where_lost(self) -> None:
        if not self._port.is_open:
            self._begin()

    def _take(self, line: SerialLine, cycle: Cycle) -> None:
        device_s = self._ticks.take(line.ticks_us) * 1e-6
        is_new = not self.fit.is_of(device_s, cycle.time_s)
        if is_new:
            self._begin()
            device_s = self._ticks.take(line.ticks_us) * 1e-6
        self.fit.add(device_s, cycle.time_s)
        before, self._count = self._count, int(line.value)
        if line.kind is LineKind.PULSE:
            at_s, since = self.fit.rig_time_s(device_s), self._at_s
            self._at_s = at_s
            self._pulses.append(Pulse(self._count, at_s))
            self._compare(since, at_s)
            before = None if before is None else before + 1
        if is_new and self._period_s is not None:
            raise PhotocellMissedError(
                self.name, "its clock jumped: it began anew, and pulses may be missing"
            )
        lost = 0 if before is None else self._count - before
        if lost:
            raise PhotocellMissedError(
                self.name, f"{lost} pulses were counted but their lines did not arrive"
            )

    def _compare(self, since_s: float | None, at_s: float) -> None:
        if since_s is None or self._period_s is None:
            return
        periods = (at_s - since_s) / self._period_s
        is_told = PhotocellMissedError in self._told
        self._told -= {PhotocellMissedError, PhotocellDeadError}
        if periods < _EXTRA_PERIODS:
            raise PhotocellExtraError(
                self.name, f"two pulses {periods:.3f} periods apart (limit {_EXTRA_PERIODS})"
            )
        if periods > _MISSED_PERIODS and not is_told:
            raise PhotocellMissedError(
                self.name, f"{periods:.3f} periods between pulses (limit {_MISSED_PERIODS})"
            )

    def _missing_faults(self, now_s: float) -> Iterator[HardwareError]:
        """Yield which pulses are missing by now."""
        if self._period_s is None:
            return
        if self._at_s is None and self._waiting_s is None:
            self._waiting_s = now_s  # no pulse yet: the first may come at once, or a period later
        since_s = self._waiting_s if self._at_s is None else self._at_s
        periods = 0.0 if since_s is None else (now_s - since_s) / self._period_s
        for kind, limit_periods in (
            (PhotocellDeadError, _DEAD_PERIODS),
            (PhotocellMissedError, _MISSED_PERIODS),
        ):
            if periods > limit_periods and kind not in self._told:
                self._told |= {kind, PhotocellMissedError}
                message = f"no pulse for {periods:.2f} periods (limit {limit_periods})"
                yield kind(self.name, message)


DRIVER = Driver(Role.PHOTOCELL, TimestamperSettings, SerialPhotocell)
