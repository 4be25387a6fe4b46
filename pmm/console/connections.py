"""Connections that ask, limited in number and in time; and the pages' streams.

Under a flood the oldest give way, never the newest: a quick stop is sent at once, on a connection
that is new or has just been used.
"""

import asyncio
from typing import Any, Final

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

from pmm.console.limits import MOST_CONNECTIONS, MOST_HALF_SENT, REQUEST_S, SLOW_S, YOUNG_S

_COMING: Final = (h11.IDLE, h11.SEND_BODY)  # states of whoever has not sent the whole request
_LATE: Final = f"the request was not complete after {REQUEST_S:g} s; send it again"
_CROWDED: Final = (
    f"more than {MOST_HALF_SENT} requests are half sent, and this is the oldest; send it again"
)


class Crowd:
    """The connections of one server, each until it ends or becomes a page's stream."""

    def __init__(self) -> None:
        self._open: dict[Connection, None] = {}  # the one that was heard of longest ago is first
        self._half: dict[Connection, asyncio.TimerHandle] = {}  # the oldest is first

    def note_arrival(self, connection: "Connection", *, complete: bool) -> None:
        """Note that something came, and whether that completed the request."""
        self._open.pop(connection, None)
        self._open[connection] = None
        if complete:
            self._stop_timer(connection)
        elif connection not in self._half:
            self._half[connection] = connection.loop.call_later(REQUEST_S, connection.refuse, _LATE)
        while len(self._half) > MOST_HALF_SENT and self._is_old(next(iter(self._half))):
            next(iter(self._half)).refuse(_CROWDED)
        if len(self._open) > MOST_CONNECTIONS:
            next(iter(self._open)).give_way()

    def forget(self, connection: "Connection") -> None:
        """Forget a connection that ended, or became a page's stream."""
        self._open.pop(connection, None)
        self._stop_timer(connection)

    def _is_old(self, connection: "Connection") -> bool:
        """Whether one had the time to send: many pages may come at once, each on its own."""
        return self._half[connection].when() - connection.loop.time() < REQUEST_S - YOUNG_S

    def _stop_timer(self, connection: "Connection") -> None:
        timer = self._half.pop(connection, None)
        if timer is not None:
            timer.cancel()


class Connection(H11Protocol):
    """uvicorn's connection, with a limit of time for each request.

    It is there from the moment it is accepted: a TLS handshake is a part of the first request.
    """

    def __init__(self, crowd: Crowd, *arguments: Any, **named: Any) -> None:
        super().__init__(*arguments, **named)
        self._crowd = crowd
        self._accepting = asyncio.current_task()  # of the event loop; it goes on to the handshake
        if self._accepting is not None:
            self._accepting.add_done_callback(self._accepted)
        crowd.note_arrival(self, complete=False)

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Begin; nothing is sent yet, which is half a request too."""
        super().connection_made(transport)
        self._crowd.note_arrival(self, complete=False)

    def data_received(self, data: bytes) -> None:
        """Take bytes of a request, and tell the crowd whether it is whole."""
        super().data_received(data)
        if self.transport.is_closing() or self.transport.get_protocol() is not self:
            self._crowd.forget(self)
        else:
            self._crowd.note_arrival(self, complete=self.conn.their_state not in _COMING)

    def on_response_complete(self) -> None:
        """Go on with a request that came behind the one that is answered now."""
        super().on_response_complete()
        half = self.conn.their_state is h11.SEND_BODY or bool(self.conn.trailing_data[0])
        if half and not self.transport.is_closing():
            self._crowd.note_arrival(self, complete=self.conn.their_state not in _COMING)

    def connection_lost(self, exc: Exception | None) -> None:
        """Leave the crowd; the browser or the network closed the connection."""
        self._crowd.forget(self)
        super().connection_lost(exc)

    def refuse(self, why: str) -> None:
        """End with a sentence, where an answer has not begun."""
        if self.transport is None:
            self.give_way()
            return
        self._crowd.forget(self)
        if self.cycle is None or not self.cycle.response_started or self.cycle.response_complete:
            body = why.encode()
            self.transport.write(
                b"HTTP/1.1 408 Request Timeout\r\nconnection: close\r\n"
                b"content-type: text/plain; charset=utf-8\r\ncontent-length: %d\r\n\r\n%b"
                % (len(body), body)
            )
        self.transport.close()
        if self.transport.get_write_buffer_size():  # it does not read either
            self.transport.abort()

    def give_way(self) -> None:
        """Close the connection at once, so that another has its place."""
        self._crowd.forget(self)
        if self.transport is not None:
            self.transport.abort()
        elif self._accepting is not None:
            self._accepting.cancel()

    def _accepted(self, _: object) -> None:
        """End where no connection came of it: a handshake that failed."""
        if self.transport is None:
            self._crowd.forget(self)


class PageStream(WebSocketsSansIOProtocol):
    """uvicorn's stream, which ends where nothing is taken for long: it would be kept for ever."""

    _full: asyncio.TimerHandle | None = None

    def pause_writing(self) -> None:
        """Note that the page takes nothing."""
        super().pause_writing()
        self._full = self.loop.call_later(SLOW_S, self.transport.abort)

    def resume_writing(self) -> None:
        """Note that it takes something again."""
        super().resume_writing()
        self._stop_timer()

    def connection_lost(self, exc: Exception | None) -> None:
        """Give its place up; the browser or the network closed the connection."""
        self._stop_timer()
        super().connection_lost(exc)

    def _stop_timer(self) -> None:
        if self._full is not None:
            self._full.cancel()
            self._full = None
