"""The server's end of the pipe to the loop."""

import asyncio
import threading
import time
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import Final

from anyio.to_thread import run_sync

from hardware.description.errors import PmmError
from pmm.console.messages import LoopMessage, LoopOrder, OrderKind, Reply
from pmm.console.queued_plan import PackedPlan
from pmm.console.quick_stop import PATIENCE_S, QuickStop

_ANSWER_S: Final = 1.0  # 100 cycles: for the answer to what was begun at the last moment


class RefusedError(PmmError):
    """The loop does not carry out an order; the message says why.

    Attributes
    ----------
    present
        Number of the plan that is under way then; ``None`` where the loop does not say.
    """

    def __init__(self, text: str, present: int | None = None) -> None:
        super().__init__(text)
        self.present = present


class UnansweredError(RefusedError):
    """The loop does not answer an order: it has begun it and is not done, or leaves it undone.

    Parameters
    ----------
    later
        Has the reply once it comes after all.
    """

    def __init__(self, later: asyncio.Future[Reply]) -> None:
        super().__init__(
            "the control loop does not answer; look at the rig. It has begun this, or leaves it "
            "undone; what came of it is logged once it is known"
        )
        self._later = later

    def then(self, settle: Callable[[Reply], object]) -> None:
        """Have the reply taken in the event loop, if it comes."""
        self._later.add_done_callback(lambda later: settle(later.result()))


class LoopSide:
    """Sends orders and waits for their replies; hands everything else on.

    Parameters
    ----------
    quick_stop
        Its own way, beside the pipe.
    take
        Called in the event loop with every message that is no reply.
    lost
        Called in the event loop when the other side has ended.
    """

    def __init__(
        self,
        connection: Connection,
        quick_stop: QuickStop,
        take: Callable[[LoopMessage], None],
        lost: Callable[[], None],
    ) -> None:
        self._quick_stop = quick_stop
        self._connection, self._take, self._lost = connection, take, lost
        self._open: dict[int, asyncio.Future[Reply]] = {}
        self._count = 0
        self._sending = asyncio.Lock()
        self._loop = asyncio.get_running_loop()
        self._thread = threading.Thread(target=self._receive, name="console loop", daemon=True)
        self._thread.start()

    async def order(
        self, kind: OrderKind, text: str = "", question: str = "", plan: PackedPlan | None = None
    ) -> Reply:
        """Give an order, to be begun within 5 s; return what the loop says.

        Raises
        ------
        RefusedError
            If it is refused, or the loop is gone.
        UnansweredError
            If the loop does not answer: whether it is carried out is known with the reply alone.
        """
        self._count += 1
        until_s = time.monotonic() + PATIENCE_S
        stops = self._quick_stop.pressed
        order = LoopOrder(self._count, kind, text, question, plan, stops, until_s)
        future: asyncio.Future[Reply] = self._loop.create_future()
        self._open[order.number] = future
        try:
            async with self._sending:
                await run_sync(self._connection.send, order)
        except OSError as error:
            del self._open[order.number]
            raise RefusedError("the control loop is gone; look at the rig") from error
        await asyncio.wait((future,), timeout=until_s + _ANSWER_S - time.monotonic())
        if not future.done():
            raise UnansweredError(future)
        reply = future.result()
        if not reply.carried_out:
            raise RefusedError(reply.text, reply.plan)
        return reply

    async def stop_quickly(self) -> str:
        """Stop at once; return when the loop has taken it.

        Raises
        ------
        NotStoppedError
            If it has not.
        """
        await self._quick_stop.wait_taken(self._quick_stop.press())
        return "quick stop taken"

    def replied(self, reply: Reply) -> None:
        """Hand a reply of the loop to whoever waits for it, or waited."""
        future = self._open.pop(reply.number, None)
        if future is not None:
            future.set_result(reply)

    def _receive(self) -> None:
        try:
            while True:
                message = self._connection.recv()
                self._loop.call_soon_threadsafe(self._take, message)
        except (OSError, EOFError):
            pass
        try:
            self._loop.call_soon_threadsafe(self._lost)
        except RuntimeError:  # the event loop has ended first
            return
