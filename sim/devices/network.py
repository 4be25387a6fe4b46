"""The simulated side of a CAN bus: dispatches what a controller sends, collects the answers."""

from typing import TYPE_CHECKING

import can
import canopen

if TYPE_CHECKING:
    from collections import deque
    from collections.abc import Callable

SYNC, HEARTBEAT = 0x080, 0x700


class Wire(canopen.Network):
    """A network without threads and clocks; canopen's nodes hang on it for SDO, NMT and EMCY.

    SYNC, process data and heartbeats take a short way past canopen, because they come in every
    cycle.

    Attributes
    ----------
    outlets
        Where frames go, one queue for each bus that is plugged in.
    guarded
        What tells each node's state to whoever asks for it by remote frame.
    time_s
        Simulated time, the time stamp of the frames.
    number
        Ticks so far.
    synchronous
        Whether the present tick came with a SYNC.
    hearing
        Called with the node id of each heartbeat that a controller sends.
    """

    def __init__(self) -> None:
        super().__init__()
        self.outlets: list[deque[can.Message]] = []
        self.rpdos: dict[int, Callable[[bytes | bytearray], None]] = {}
        self.guarded: dict[int, Callable[[], int]] = {}
        self.on_sync: Callable[[], None] = _do_nothing
        self.hearing: list[Callable[[int], None]] = []
        self.time_s = 0.0
        self.number = 0
        self.synchronous = False

    def take(self, frame: can.Message) -> None:
        """Take a frame from a controller; what the nodes answer lies in the outlets then."""
        identifier = frame.arbitration_id
        if frame.is_error_frame or frame.is_extended_id:
            return
        if frame.is_remote_frame:
            self._guard(identifier)
        elif identifier == SYNC:
            self.on_sync()
        elif (rpdo := self.rpdos.get(identifier)) is not None:
            rpdo(frame.data)
        elif identifier & 0x780 == HEARTBEAT:
            for hear in self.hearing:
                hear(identifier & 0x7F)
        else:
            self.notify(identifier, frame.data, self.time_s)

    def _guard(self, identifier: int) -> None:
        """Answer the question for a node's state (node guarding)."""
        answer = self.guarded.get(identifier & 0x7F) if identifier & 0x780 == HEARTBEAT else None
        if answer is not None:
            self.emit(identifier, bytes((answer(),)))

    def emit(self, identifier: int, data: bytes) -> None:
        """Send a frame of a node."""
        frame = can.Message(
            timestamp=self.time_s, arbitration_id=identifier, is_extended_id=False, data=data
        )
        for outlet in self.outlets:
            outlet.append(frame)

    def put(self, frame: can.Message) -> None:
        """Put a frame, an error frame for example, on the bus."""
        for outlet in self.outlets:
            outlet.append(frame)

    def send_message(self, can_id: int, data: bytes, remote: bool = False) -> None:
        """Send what canopen's nodes say."""
        self.emit(can_id, bytes(data))

    def send_periodic(self, *_: object, **__: object) -> "_Unused":  # type: ignore[override]
        """Take the heartbeat's timer from canopen: the nodes count ticks instead."""
        return _Unused()


class _Unused:
    """Stands where canopen keeps a periodic task."""

    def update(self, data: bytes) -> None:
        """Nothing to update."""

    def stop(self) -> None:
        """Nothing to stop."""


def _do_nothing() -> None:
    return
