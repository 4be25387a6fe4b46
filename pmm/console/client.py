"""One browser, seen from the server: what waits for it is bounded, and frames are dropped."""

import asyncio
from collections import deque
from collections.abc import Callable
from typing import Final

WAITING: Final = 8  # messages: a third of a second


class Client:
    """What waits to be sent to a browser.

    A browser that does not keep up gets nothing more until it has room again, and then a snapshot
    of everything instead of what it missed.

    Parameters
    ----------
    snapshot
        Makes that snapshot for this session.

    Attributes
    ----------
    replaced
        Whether the same session was opened elsewhere, which ends this one.
    dropped
        Messages that were not sent.
    """

    def __init__(self, session: str, snapshot: Callable[[str], str]) -> None:
        self.session, self.replaced, self.dropped = session, False, 0
        self._snapshot = snapshot
        self._waiting: deque[str] = deque()
        self._behind = True
        self._wake = asyncio.Event()

    def offer(self, text: str) -> None:
        """Add a message, or fall behind."""
        if self._behind:
            self.dropped += 1
        elif len(self._waiting) >= WAITING:
            self.dropped += len(self._waiting) + 1
            self._waiting.clear()
            self._behind = True
        else:
            self._waiting.append(text)
        self._wake.set()

    def replace(self) -> None:
        """End this one: its session was opened elsewhere."""
        self.replaced = True
        self._wake.set()

    async def next(self) -> str:
        """Wait for the next message."""
        while not (self._waiting or self._behind or self.replaced):
            self._wake.clear()
            await self._wake.wait()
        if self._behind:
            self._behind = False
            return self._snapshot(self.session)
        return self._waiting.popleft() if self._waiting else ""
