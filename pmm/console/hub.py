"""What the server knows of the rig, and its handing on to all browsers."""

from collections import deque
from collections.abc import Callable
from typing import Any, Final

import numpy as np

from pmm.console.client import Client
from pmm.console.desk import Desk
from pmm.console.encoding import (
    encode,
    frame_picture,
    hello_picture,
    needles_picture,
    notice_picture,
    outcome_picture,
    trace_picture,
)
from pmm.console.messages import (
    WRITTEN,
    FloatArray,
    Frame,
    Hello,
    Needles,
    Notice,
    Reply,
    Told,
    Trace,
)
from pmm.console.traces import POINTS

_NOTICES: Final = 200


class Hub:
    """Takes what the loop tells, keeps what a browser needs to begin, and hands frames on.

    Parameters
    ----------
    replied
        Takes the replies to orders.
    written
        Told when a campaign's file holds one more run.
    utc
        Date and time in ISO 8601.
    """

    def __init__(
        self,
        replied: Callable[[Reply], None],
        written: Callable[[Notice], None],
        utc: Callable[[], str],
    ) -> None:
        self.hello: Hello | None = None
        self.plans: dict[str, Any] = {}
        self.desk = Desk()
        self.clients: dict[str, Client] = {}
        self.finished: list[dict[str, Any]] = []
        self.figures: dict[str, Any] = {}
        self.last: Frame | None = None
        self.connected = False
        self._replied, self._written, self._utc = replied, written, utc
        self._notices: deque[dict[str, Any]] = deque(maxlen=_NOTICES)
        self._count, self._began = 0, utc()
        self._needles: Needles | None = None
        self._ring: FloatArray = np.empty((0, 0))
        self._ring_first, self._ring_start_s = 0, 0.0

    def take(self, message: Told) -> None:
        """Take what the loop tells."""
        if isinstance(message, Frame):
            self._frame(message)
        elif isinstance(message, Notice):
            self._notice(message)
        elif isinstance(message, Reply):
            self._replied(message)
        else:
            self.hello, self.connected = message, True
            self._ring = np.empty((len(message.channels), 0))

    def lost(self) -> None:
        """Say that the loop has ended."""
        self.connected = False
        self.broadcast({"type": "lost"})

    def broadcast(self, message: dict[str, Any]) -> None:
        """Send a message to all browsers."""
        text = encode(message)
        for one in self.clients.values():
            one.offer(text)

    def join(self, session: str) -> Client:
        """Let a browser come; an older page of the same session ends."""
        before = self.clients.get(session)
        if before is not None:
            before.replace()
        client = self.clients[session] = Client(session, self.snapshot)
        self.desk.arrive(session)
        self.tell_desk()
        return client

    def part(self, client: Client) -> None:
        """Let a browser go."""
        if self.clients.get(client.session) is client:
            del self.clients[client.session]
            self.tell_desk()

    def tell_desk(self) -> None:
        """Say to everybody who has control."""
        for session, client in self.clients.items():
            client.offer(encode(self._desk(session)))

    def snapshot(self, session: str) -> str:
        """Return everything that a page needs to begin, or to go on after a gap."""
        trace = Trace(self._ring_first, self._ring_start_s, self._ring)
        return encode(
            {
                "type": "snapshot",
                "session": session,
                "began": self._began,
                "connected": self.connected,
                "hello": None if self.hello is None else hello_picture(self.hello),
                "frame": None if self.last is None else frame_picture(self.last),
                "needles": needles_picture(self._needles),
                "trace": trace_picture(trace),
                "notices": list(self._notices),
                "plans": self.plans,
                "finished": self.finished,
                "figures": self.figures,
                "desk": self._desk(session),
            }
        )

    def add_notice(self, notice: Notice) -> None:
        """Keep and hand on what happened."""
        self._count += 1
        picture = notice_picture(notice, self._count, self._utc())
        self._notices.append(picture)
        self.broadcast(picture)

    def _desk(self, session: str) -> dict[str, Any]:
        return {
            "type": "desk",
            "holder": str(self.desk.seen_from(session)),
            "browsers": len(self.clients),
        }

    def _frame(self, frame: Frame) -> None:
        self.last = frame
        self._needles = frame.needles or self._needles
        self._keep(frame.trace)
        if self.clients:
            self.broadcast(frame_picture(frame))

    def _keep(self, trace: Trace) -> None:
        """Keep the newest points; after a hole that is longer than the window nothing is old."""
        if not trace.values.size:
            return
        next_number = self._ring_first + self._ring.shape[1]
        hole = min(max(trace.first - next_number, 0), POINTS) if self._ring.size else 0
        gap = np.full((len(trace.values), hole), np.nan)
        ring = np.hstack((self._ring, gap, trace.values))[:, -POINTS:]
        count = trace.values.shape[1]
        rate_hz = self.hello.trace_rate_hz if self.hello is not None else 1.0
        self._ring = ring
        self._ring_first = trace.first + count - ring.shape[1]
        self._ring_start_s = trace.start_s + (count - ring.shape[1]) / rate_hz

    def _notice(self, notice: Notice) -> None:
        if notice.kind == WRITTEN:
            self._written(notice)
            return
        self.add_notice(notice)
        if notice.outcome is not None:
            self._needles = notice.needles or self._needles
            folder = str(notice.folder or "")
            entry = outcome_picture(notice.outcome, notice.needles, folder, self._utc())
            self.finished.append(entry)
            self.broadcast({"type": "finished", "entry": entry})
