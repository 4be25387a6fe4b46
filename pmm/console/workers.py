"""The server's workers: one for who has control, one for all who watch, two for the rest."""

import asyncio
from collections.abc import Awaitable, Callable
from typing import Final, Generic, TypeVar

from pmm.console.limits import CHECK_MEMORY, CHECK_S, MOST_CHECKS
from pmm.console.worker_process import WorkerProcess, WorkLimits

T = TypeVar("T")
_CHECKS: Final = WorkLimits(CHECK_S, CHECK_MEMORY, MOST_CHECKS)
# Recordings are read there: they may be as large as the machine takes, and nobody but us asks.
_FIGURES: Final = WorkLimits(3600.0, 0, 1)


class Workers:
    """Processes beside the server; none is started before it is needed."""

    def __init__(self) -> None:
        self._control = WorkerProcess("checking plans", _CHECKS)
        self._watchers = WorkerProcess("checking plans of those who watch", _CHECKS)
        self.around = WorkerProcess("looking through the folders", _CHECKS)
        self.figures = WorkerProcess("coefficients", _FIGURES)

    def for_whom(self, *, in_control: bool) -> WorkerProcess:
        """Return who checks plans: nobody who watches holds up who has control."""
        return self._control if in_control else self._watchers

    def close(self) -> None:
        """End all."""
        for one in (self._control, self._watchers, self.around, self.figures):
            one.close()


class Shared(Generic[T]):
    """One answer for all who ask while another is worked out: every page asks when a run ends."""

    def __init__(self, ask: Callable[[], Awaitable[T]]) -> None:
        self._ask = ask
        self._present: asyncio.Future[T] | None = None
        self._next: asyncio.Future[T] | None = None

    async def get(self) -> T:
        """Return an answer that was begun after this question."""
        if self._next is None:
            self._next = asyncio.ensure_future(self._after(self._present))
        return await asyncio.shield(self._next)

    async def _after(self, before: "asyncio.Future[T] | None") -> T:
        if before is not None:
            await asyncio.wait([before])
        self._present, self._next = self._next, None
        return await self._ask()
