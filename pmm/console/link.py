"""Between the loop and the web server: the loop's side never waits, whatever the server does."""

import queue
import threading
from collections import deque
from dataclasses import replace
from multiprocessing.connection import Connection
from typing import Final

from pmm.console.messages import Frame, LoopOrder, PackedPlan, Told, unpack

_POLL_S: Final = 0.2
_FRAMES: Final = 25  # one second's; older ones are dropped


class Link:
    """The loop's end of the pipe to the server.

    Two threads move the messages; the loop itself only touches queues.

    Attributes
    ----------
    dropped
        Frames that the server did not fetch in time.
    """

    def __init__(self, connection: Connection) -> None:
        self.dropped = 0
        self._connection = connection
        self._frames: deque[Frame] = deque(maxlen=_FRAMES)
        self._others: deque[Told] = deque()
        self._orders: queue.SimpleQueue[LoopOrder] = queue.SimpleQueue()
        self._wake = threading.Event()
        self._closed = threading.Event()
        self._threads = [
            threading.Thread(target=one, name=f"console {name}", daemon=True)
            for name, one in (("sender", self._send), ("receiver", self._receive))
        ]
        for thread in self._threads:
            thread.start()

    @property
    def lost(self) -> bool:
        """Whether the server is gone."""
        return self._closed.is_set()

    def frame(self, frame: Frame) -> None:
        """Hand a frame on; the oldest one is dropped where the server is too slow."""
        self.dropped += len(self._frames) == _FRAMES
        self._frames.append(frame)
        self._wake.set()

    def tell(self, message: Told) -> None:
        """Hand on what must not be dropped; without a server there is nobody to hand it to."""
        if self.lost:
            return
        self._others.append(message)
        self._wake.set()

    def orders(self) -> list[LoopOrder]:
        """Return what has come since the last call."""
        found = []
        while True:
            try:
                found.append(self._orders.get_nowait())
            except queue.Empty:
                return found

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
                    order = self._connection.recv()
                    if isinstance(order.plan, PackedPlan):
                        order = replace(order, plan=unpack(order.plan))
                    self._orders.put(order)
        except (OSError, EOFError):
            self._closed.set()
            self._wake.set()
