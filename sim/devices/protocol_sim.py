"""pyserial's handler of ``sim://rig/part``: what a simulated device says is there at once.

On a rig with a bus, time is SYNC. Where no bus is open, the port that was opened first brings
the time: each look whether something is there is a sample. A rig looks once a cycle.
"""

from typing import TYPE_CHECKING

import serial

from sim.devices.registry import give_back, take

if TYPE_CHECKING:
    from typing_extensions import Buffer

    from sim.devices.serial_devices import SerialCable


class Serial(serial.SerialBase):
    """A port at the near end of a simulated device's cable; reading never waits."""

    def open(self) -> None:
        """Open the port.

        Raises
        ------
        SerialException
            If there is no such rig or part, or its plug is out.
        """
        self._rig, _, part = str(self.portstr).removeprefix("sim://").rpartition("/")
        try:
            self._world = take(self._rig)
        except ValueError as error:
            raise serial.SerialException(str(error)) from error
        talkers = self._world.talkers
        if part not in talkers or not talkers[part].cable.plugged:
            give_back(self._rig)
            names = ", ".join(name for name, talker in talkers.items() if talker.cable.plugged)
            raise serial.SerialException(
                f"{self._rig} has no serial device {part!r}; plugged in: {names or 'none'}"
            )
        self._cable: SerialCable = talkers[part].cable
        self._world.lookers.append(self)
        self.is_open = True

    def close(self) -> None:
        """Close the port."""
        if self.is_open:
            self._world.lookers.remove(self)
            give_back(self._rig)
        self.is_open = False

    @property
    def in_waiting(self) -> int:
        """Bytes that are there."""
        world = self._world
        if not world.wire.outlets and world.lookers[0] is self:
            world.tick()
        self._plugged()
        return len(self._cable.waiting)

    def read(self, size: int = 1) -> bytes:
        """Return what is there, at most ``size`` bytes."""
        self._plugged()
        taken = bytes(self._cable.waiting[:size])
        del self._cable.waiting[:size]
        return taken

    def write(self, b: "Buffer", /) -> int:
        """Write to the device."""
        self._plugged()
        data = bytes(b)
        self._cable.heard += data
        return len(data)

    def _reconfigure_port(self) -> None:
        """A cable in memory has no settings."""

    def _plugged(self) -> None:
        if not self._cable.plugged:
            raise serial.SerialException("device disconnected")
