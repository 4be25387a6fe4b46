"""A pseudo-terminal: a serial port that another process, or pyserial in this one, can open."""

import os
import tty

_CHUNK = 65536


class PseudoTerminal:
    """The far end of a serial line; :attr:`path` is the near end's device."""

    def __init__(self) -> None:
        self._far, self._near = os.openpty()
        tty.setraw(self._near)
        os.set_blocking(self._far, False)
        self.path = os.ttyname(self._near)

    def fileno(self) -> int:
        """Return the file descriptor, for ``select``."""
        return self._far

    def read(self) -> bytes:
        """Return what has come, without waiting."""
        try:
            return os.read(self._far, _CHUNK)
        except BlockingIOError:
            return b""

    def write(self, data: bytes | bytearray) -> int:
        """Write what fits without waiting; return how many bytes that was."""
        try:
            return os.write(self._far, data)
        except BlockingIOError:
            return 0

    def close(self) -> None:
        """Hang up; may be called twice."""
        for end in (self._far, self._near):
            if end >= 0:
                os.close(end)
        self._far = self._near = -1
