"""From the loop to the web server, and from there on: who tells never waits for who listens."""

import queue
import threading
from collections import deque
from dataclasses import replace
from multiprocessing.connection import Connection
from typing import Any, Final, Generic, TypeVar

from pmm.console.messages import Frame, LoopMessage, LoopOrder
from pmm.console.queued_plan import PackedPlan, unpack

_POLL_S: Final = 0.2
_FRAMES: Final = 25  # one second's; older ones are dropped
T = TypeVar("T")


class Link(Generic[T]):
    """The teller's end of a pipe: the loop's to the server, the server's to live values.

    Two threads move the messages; who tells only touches queues. What comes back is of type ``T``.

    Parameters
    ----------
    most_frames
        That wait to be fetched.

    Attributes
    ----------
    dropped
        Frames that were not fetched in time.
    """

    def __init__(self, connection: Connection, most_frames: int = _FRAMES) -> None:
        self.dropped = 0
        self._most_frames = most_frames
        self._connection = connection
        self._frames: deque[Frame] = deque(maxlen=most_frames)
        self._others: deque[LoopMessage] = deque()
        self._orders: queue.SimpleQueue[T] = queue.SimpleQueue()
        self._wake = threading.Event()
        self._closed = threading.Event()
        self._threads = [
            threading.Thread(target=target, name=f"console {name}", daemon=True)
            for name, target in (("sender", self._send), ("receiver", self._receive))
        ]
        for thread in self._threads:
            thread.start()

    @property
    def waiting(self) -> int:
        """Frames that wait to be fetched."""
        return len(self._frames)

    @property
    def lost(self) -> bool:
        """Whether the other side is gone."""
        return self._closed.is_set()

    def frame(self, frame: Frame) -> None:
        """Hand a frame on; the oldest one is dropped where the other side is too slow."""
        self.dropped += len(self._frames) == self._most_frames
        self._frames.append(frame)
        self._wake.set()

    def tell(self, message: LoopMessage) -> None:
        """Hand on what must not be dropped; without another side there is nobody to hand it to."""
        if self.lost:
            return
        self._others.append(message)
        self._wake.set()

    def orders(self) -> list[T]:
        """Return what has come since the last call."""
        orders = []
        while True:
            try:
                orders.append(self._orders.get_nowait())
            except queue.Empty:
                return orders

    def close(self) -> None:
        """Send what is left and let go of the pipe."""
        self._closed.set()
        self._wake.set()
        self._threads[0].join()
        self._connection.close()
        self._threads[1].join()

    def _send(self) -> None:
        try:
            while not self._closed.is_set():
                self._wake.wait()
                self._wake.clear()
                self._send_all()
            self._send_all()
        except OSError:
            self._closed.set()

    def _send_all(self) -> None:
        while self._others or self._frames:
            waiting = self._others or self._frames
            self._connection.send(waiting.popleft())

    def _receive(self) -> None:
        try:
            while not self._closed.is_set():
                if self._connection.poll(_POLL_S):
                    self._orders.put(_unpacked_order(self._connection.recv()))
        except (OSError, EOFError):
            self._closed.set()
            self._wake.set()


def _unpacked_order(message: Any) -> Any:
    """Return an order with its plan unpacked; in the thread, for the loop does not wait for it."""
    if isinstance(message, LoopOrder) and isinstance(message.plan, PackedPlan):
        return replace(message, plan=unpack(message.plan))
    return message
