"""What carries live values out: it takes each tick at once, and counts what it could not carry."""

import asyncio
from abc import ABC, abstractmethod
from collections import deque
from dataclasses import dataclass
from threading import Lock
from typing import Final

from hardware.description.errors import PmmError
from pmm.console.live.values import Tick

AGAIN_S: Final = 2.0  # between two attempts to open
_LOOK_S: Final = 0.02  # half of a tick


class NotCarriedError(PmmError):
    """Live values do not reach whoever reads them; the message says why and what to do."""


@dataclass(frozen=True)
class OutletStatus:
    """How an outlet is.

    Attributes
    ----------
    carried, dropped
        Ticks since the console was started.
    trouble
        Why it is not connected, and what to do; empty if it is, or nothing is known yet.
    """

    name: str
    connected: bool
    carried: int
    dropped: int
    trouble: str = ""


class Outlet(ABC):
    """Carries ticks out in their order.

    One thread offers, the event loop carries. What waits is bounded: the oldest is dropped.

    Parameters
    ----------
    most
        Ticks that may wait.
    """

    name: str

    def __init__(self, most: int) -> None:
        self._most = most
        self._waiting: deque[Tick] = deque()
        self._lock = Lock()
        self._last = self._carried = self._dropped = 0
        self._connected, self._trouble = False, ""

    def offer(self, tick: Tick) -> None:
        """Take a tick; numbers between the last and this one count as dropped."""
        with self._lock:
            if self._last:
                self._dropped += max(tick.number - self._last - 1, 0)
            self._last = tick.number
            self._waiting.append(tick)
            self._drop_oldest()

    def status(self) -> OutletStatus:
        """Return whether it is connected, its counts of ticks, and its last trouble."""
        with self._lock:
            return OutletStatus(
                self.name, self._connected, self._carried, self._dropped, self._trouble
            )

    async def run(self) -> None:
        """Carry until it is cancelled; open again after each failure."""
        while True:
            try:
                await self._carry()
            except NotCarriedError as error:
                self._connected, self._trouble = False, str(error)
            await asyncio.sleep(AGAIN_S)

    @abstractmethod
    async def _carry(self) -> None:
        """Open, then take and carry for ever.

        Raises
        ------
        NotCarriedError
            If it cannot.
        """

    def _note_connected(self) -> None:
        """Note that it is connected."""
        self._connected, self._trouble = True, ""

    async def _next_tick(self) -> Tick:
        """Wait for a tick, and take the oldest."""
        while not self._waiting:
            await asyncio.sleep(_LOOK_S)
        with self._lock:
            return self._waiting.popleft()

    def _count_carried(self) -> None:
        """Count a tick that was carried."""
        with self._lock:
            self._carried += 1

    def _put_back(self, ticks: list[Tick]) -> None:
        """Let ticks that were not carried wait again, before all others."""
        with self._lock:
            self._waiting.extendleft(reversed(ticks))
            self._drop_oldest()

    def _drop_oldest(self) -> None:
        while len(self._waiting) > self._most:
            self._waiting.popleft()
            self._dropped += 1
