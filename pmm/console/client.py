"""One browser, seen from the server: what waits for it is bounded, and pictures never wait."""

import asyncio
from collections import deque
from collections.abc import Awaitable, Callable
from contextlib import suppress
from typing import Final

from starlette.websockets import WebSocketDisconnect

from pmm.console.request_body import Requester

REPLACED: Final = 4001  # of RFC 6455's private codes; the page knows it
WAITING: Final = 64  # messages that are no pictures: alarms, states, plans, runs that ended


class Client:
    """What a browser has, and what waits to be sent to it.

    Pictures do not wait: when it has taken what was sent, it gets the latest one. Where too many
    messages wait, it gets a snapshot of everything in their place.

    Parameters
    ----------
    send
        Sends a text; it waits for as long as the browser does not take any.
    close
        Ends the stream, with a code and a reason.

    Attributes
    ----------
    behind
        Whether it needs a snapshot.
    frame, piece
        Numbers of the latest frame it has, and of the first piece of traces that it lacks.
    desk
        What it was told of who has control.
    dropped
        Messages that were not sent.
    """

    def __init__(
        self,
        who: Requester,
        send: Callable[[str], Awaitable[None]],
        close: Callable[[int, str], Awaitable[None]],
    ) -> None:
        self.who, self._send, self._close = who, send, close
        self.behind, self.dropped = True, 0
        self.frame = self.piece = 0
        self.desk = ""
        self._waiting: deque[str] = deque()
        self._sending: asyncio.Future[None] | None = None

    @property
    def session(self) -> str:
        """Whose it is."""
        return self.who.session

    @property
    def busy(self) -> bool:
        """Whether it has not taken yet what was sent last."""
        return self._sending is not None and not self._sending.done()

    @property
    def _waits(self) -> bool:
        return self.behind or bool(self._waiting)

    def offer(self, text: str) -> None:
        """Add a message, or fall behind."""
        if self.behind:
            self.dropped += 1
        elif len(self._waiting) >= WAITING:
            self.dropped += len(self._waiting) + 1
            self.fall_behind()
        else:
            self._waiting.append(text)

    def fall_behind(self) -> None:
        """Forget what waits: a snapshot comes in its place."""
        self._waiting.clear()
        self.behind = True

    def take(self) -> list[str]:
        """Return the messages that wait; they wait no more."""
        texts = list(self._waiting)
        self._waiting.clear()
        return texts

    def begin(self, texts: list[str], taken: Callable[[], None]) -> None:
        """Begin to send; ``taken`` is called where something waits when these are taken."""

        def sent(_: object) -> None:
            if self._waits:
                taken()

        self._sending = asyncio.ensure_future(self._send_all(texts))
        self._sending.add_done_callback(sent)

    def replace(self) -> None:
        """End this one: its session was opened elsewhere."""
        self.stop()
        self._sending = asyncio.ensure_future(self._end())

    def stop(self) -> None:
        """Send nothing more to this browser; what is being sent is cancelled."""
        if self._sending is not None:
            self._sending.cancel()

    async def _end(self) -> None:
        with suppress(WebSocketDisconnect, RuntimeError, OSError):
            await self._close(REPLACED, "this session was opened in another window")

    async def _send_all(self, texts: list[str]) -> None:
        with suppress(WebSocketDisconnect, RuntimeError, OSError):  # it has gone
            for text in texts:
                await self._send(text)
