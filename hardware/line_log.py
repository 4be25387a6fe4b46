"""Serial lines for a raw log, and a log that is read again in place of a port."""

from collections import deque
from collections.abc import Callable, Iterable, Sequence
from typing import TypeAlias

from hardware.serial_port import Port, Ports, PortSettings

LineObserver: TypeAlias = Callable[[int, str, bytes], None]
"""Takes the number of the cycle, the device's name and the line without its line feed."""


def heard_ports(
    ports: Ports, observers: Sequence[LineObserver], number: Callable[[], int]
) -> Ports:
    """Return what opens ports whose lines are told to observers, with the cycle's number."""

    def hear(device: str, line: bytes) -> None:
        for observe in observers:
            observe(number(), device, line)

    def opened(name: str, settings: PortSettings) -> Port:
        port = ports(name, settings)
        return HeardPort(port, hear, name) if observers else port

    return opened


class HeardPort:
    """A :class:`hardware.serial_port.Port` whose lines are told to somebody else too."""

    def __init__(self, port: Port, hear: Callable[[str, bytes], None], name: str) -> None:
        self._port = port
        self._hear = hear
        self._name = name

    @property
    def is_open(self) -> bool:
        """Whether the port is open, as far as is known."""
        return self._port.is_open

    def open(self) -> None:
        """Open the port if it is not."""
        self._port.open()

    def lines(self) -> list[bytes]:
        """Return the whole lines that have arrived, and tell them."""
        lines = self._port.lines()
        for line in lines:
            self._hear(self._name, line)
        return lines

    def write(self, data: bytes) -> None:
        """Write."""
        self._port.write(data)

    def recover(self, now_s: float) -> bool:
        """Try to open a lost port again."""
        return self._port.recover(now_s)

    def close(self) -> None:
        """Close the port."""
        self._port.close()


class LoggedPort:
    """A :class:`hardware.serial_port.Port` that says again what a log holds.

    Parameters
    ----------
    lines
        Cycle and line, in order.
    now
        Returns the number of the present cycle.
    """

    is_open = True

    def __init__(self, lines: Iterable[tuple[int, bytes]], now: Callable[[], int]) -> None:
        self._lines = deque(lines)
        self._now = now

    def open(self) -> None:
        """Nothing to open."""

    def lines(self) -> list[bytes]:
        """Return the lines up to the present cycle."""
        due = []
        while self._lines and self._lines[0][0] <= self._now():
            due.append(self._lines.popleft()[1])
        return due

    def write(self, data: bytes) -> None:
        """Nobody listens."""

    def recover(self, now_s: float) -> bool:
        """Tell that the port is open: a log is never unplugged."""
        return True

    def close(self) -> None:
        """Nothing to close."""
