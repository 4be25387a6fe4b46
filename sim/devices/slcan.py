"""The adapter's end of CAN on a serial line (Lawicel's protocol), on a pseudo-terminal.

The controller opens it with python-can's ``slcan``, as it would open a real adapter.
"""

from collections import deque
from typing import Final

import can

from sim.devices.terminal import PseudoTerminal

_OK: Final = b"\r"
_SENT: Final = b"z\r"
_REFUSED: Final = b"\a"
_OPENING, _CLOSING = b"OL", b"C"
_SETTINGS: Final = b"SsYMmZ"
_ANSWERS: Final = {b"V": b"V1013\r", b"N": b"Nsim1\r", b"F": b"F00\r"}


class SlcanAdapter:
    """An adapter that carries standard frames, with data or remote."""

    def __init__(self) -> None:
        self._terminal = PseudoTerminal()
        self._rest = b""
        self._frames: deque[can.Message] = deque()
        self._open = False
        self.path = self._terminal.path

    def fileno(self) -> int:
        """Return the file descriptor, for ``select``."""
        return self._terminal.fileno()

    def recv(self, timeout: float | None = None) -> can.Message | None:
        """Return the next frame that the controller has sent, or ``None``; never waits."""
        *commands, self._rest = (self._rest + self._terminal.read()).split(b"\r")
        for command in commands:
            self._terminal.write(self._obey(command.strip()))
        return self._frames.popleft() if self._frames else None

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Send a frame to the controller, if it has opened the channel."""
        if self._open and not msg.is_error_frame:
            data = bytes(msg.data).hex().upper()
            text = f"t{msg.arbitration_id:03X}{msg.dlc}{data}\r"
            self._terminal.write(text.encode("ascii"))

    def shutdown(self) -> None:
        """Hang up."""
        self._terminal.close()

    def _obey(self, command: bytes) -> bytes:
        """Do what a command says; return the answer."""
        kind = command[:1]
        if not kind:
            return b""
        if kind in _OPENING or kind in _CLOSING:
            self._open = kind in _OPENING
            return _OK
        if kind in b"tr":
            return self._take(command)
        return _OK if kind in _SETTINGS else _ANSWERS.get(kind, _REFUSED)

    def _take(self, command: bytes) -> bytes:
        try:
            identifier, length = int(command[1:4], 16), int(command[4:5])
            data = bytes.fromhex(command[5:].decode("ascii"))
        except ValueError:
            return _REFUSED
        remote = command[:1] == b"r"
        if not self._open or len(data) != (0 if remote else length) or length > 8:
            return _REFUSED
        self._frames.append(
            can.Message(
                arbitration_id=identifier,
                data=None if remote else data,
                dlc=length,
                is_remote_frame=remote,
                is_extended_id=False,
            )
        )
        return _SENT
