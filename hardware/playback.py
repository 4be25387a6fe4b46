"""A bus that plays a raw log: ``interface = "pmm-playback"``, ``channel = "run/bus.blf"``.

Every SYNC that is sent releases what the log holds between its SYNC and the next one; whatever else
is sent goes nowhere. Importing this module makes the interface known to python-can.
"""

from collections import deque
from pathlib import Path
from typing import TYPE_CHECKING, Final

import can
from can.interfaces import BACKENDS

from hardware.raw_log_reading import read_frames

if TYPE_CHECKING:
    from collections.abc import Generator

INTERFACE: Final = "pmm-playback"
_SYNC: Final = 0x080
BACKENDS.setdefault(INTERFACE, (__name__, "PlaybackBus"))


class PlaybackBus(can.BusABC):
    """A bus over a log.

    Attributes
    ----------
    private
        Whether no other process can be on it.
    at_end
        Whether the whole log has been played.

    Parameters
    ----------
    channel
        Path of the log.

    Raises
    ------
    OSError
        If there is no such file.
    """

    private = True

    def __init__(self, channel: str, **_options: object) -> None:
        Path(channel).stat()
        super().__init__(channel)
        self.channel_info = f"raw log {channel}"
        self.at_end = False
        self._log: Generator[can.Message, None, None] = read_frames(Path(channel))
        self._due: deque[can.Message] = deque()
        self._next_sync: can.Message | None = None
        self._release()
        self._due.clear()  # what came before the first SYNC belongs to no cycle

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Take a frame. A SYNC whose counter the log's next one does not bear releases nothing."""
        sync = self._next_sync
        if msg.arbitration_id != _SYNC or sync is None or bytes(msg.data) != bytes(sync.data):
            return
        self._release()

    def recv(self, timeout: float | None = None) -> can.Message | None:
        """Return the next frame of the cycle, or ``None``; never waits."""
        return self._due.popleft() if self._due else None

    def shutdown(self) -> None:
        """Close the log."""
        self._log.close()
        super().shutdown()

    def _release(self) -> None:
        """Make the received frames up to the log's next SYNC available."""
        for frame in self._log:
            if frame.is_rx:
                self._due.append(frame)
            elif frame.arbitration_id == _SYNC and not frame.is_error_frame:
                self._next_sync = frame
                return
        self._next_sync, self.at_end = None, True
