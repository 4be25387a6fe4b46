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
    """Lines with an ending, which is taken off.

    Parameters
    ----------
    name
        Of the port, for messages.
    remedy
        What to check where no ending comes.
    """

    def __init__(self, name: str, ending: bytes = b"\n", remedy: str = "") -> None:
        self._name, self._ending, self._remedy = name, ending, remedy
        self._rest = b""

    def sent(self, data: bytes) -> None:
        """What was written does not matter."""

    def forget(self) -> None:
        """Forget what has arrived of a line that has no ending yet."""
        self._rest = b""

    def split(self, data: bytes) -> list[bytes]:
        """Return the lines; empty ones are left out.

        Raises
        ------
        LineError
            If so much arrived without an ending that it cannot be a line.
        """
        *lines, self._rest = (self._rest + data).split(self._ending)
        if len(self._rest) > _LONGEST_LINE:
            start, self._rest = self._rest[:32], b""
            missing = f"no line ending {self._ending!r} after {_LONGEST_LINE} bytes ({start!r} ...)"
            raise LineError(self._name, missing + self._remedy)
        return [line for line in lines if line.strip()]
