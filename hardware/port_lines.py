"""What makes whole lines of the bytes that a port reads."""

from typing import Final, Protocol

from hardware.errors import LineError

_LONGEST_LINE: Final = 256


class Splitter(Protocol):
    """Makes whole lines of the bytes that arrive."""

    def sent(self, data: bytes) -> None:
        """Take what was written."""
        ...

    def split(self, data: bytes) -> list[bytes]:
        """Take what has arrived, if anything; return the lines that it completes."""
        ...


class LineSplitter:
    """Lines that end with a line feed, which is taken off."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._rest = b""

    def sent(self, data: bytes) -> None:
        """What was written does not matter."""

    def split(self, data: bytes) -> list[bytes]:
        """Return the lines; empty ones are left out.

        Raises
        ------
        LineError
            If so much arrived without a line feed that it cannot be a line.
        """
        *lines, self._rest = (self._rest + data).split(b"\n")
        if len(self._rest) > _LONGEST_LINE:
            start, self._rest = self._rest[:32], b""
            raise LineError(self._name, f"no line feed after {_LONGEST_LINE} bytes ({start!r} ...)")
        return [line for line in lines if line.strip()]
