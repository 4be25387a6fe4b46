"""pyserial's handler of ``double://name``: what a talker says is there at once."""

from typing import ClassVar

import serial


class Line:
    """A serial line in memory; ``error`` is what the next access raises."""

    by_name: ClassVar[dict[str, "Line"]] = {}

    def __init__(self) -> None:
        self.waiting = bytearray()
        self.written = bytearray()
        self.there = True
        self.fail_on: dict[str, OSError] = {}

    def check(self, what: str) -> None:
        if what in self.fail_on:
            raise self.fail_on[what]


class Serial(serial.SerialBase):
    """A port at the near end of such a line."""

    def open(self) -> None:
        self.line = Line.by_name[self.portstr.removeprefix("double://")]
        if not self.line.there:
            raise serial.SerialException(f"no such device: {self.portstr}")
        self.is_open = True

    def close(self) -> None:
        self.is_open = False

    def _reconfigure_port(self) -> None:
        pass

    @property
    def in_waiting(self) -> int:
        self.line.check("in_waiting")
        return len(self.line.waiting)

    def read(self, size: int = 1) -> bytes:
        self.line.check("read")
        taken = bytes(self.line.waiting[:size])
        del self.line.waiting[:size]
        return taken

    def write(self, data: bytes) -> int:
        self.line.check("write")
        self.line.written += data
        return len(data)
