"""The server's end of the pipe to the loop."""

import asyncio
import threading
from collections.abc import Callable
from multiprocessing.connection import Connection

from anyio.to_thread import run_sync

from hardware.description.errors import PmmError
from pmm.console.messages import LoopMessage, LoopOrder, OrderKind, Reply
from pmm.console.queued_plan import PackedPlan
from pmm.console.quick_stop import PATIENCE_S, QuickStop


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
        """Give an order; return what the loop says.

        Raises
        ------
        RefusedError
            If it is refused, or the loop does not answer.
        """
        self._count += 1
        order = LoopOrder(self._count, kind, text, question, plan, self._quick_stop.pressed)
        future: asyncio.Future[Reply] = self._loop.create_future()
        self._open[order.number] = future
        try:
            async with self._sending:
                await run_sync(self._connection.send, order)
            reply = await asyncio.wait_for(future, PATIENCE_S)
        except (OSError, TimeoutError) as error:
            raise RefusedError("the control loop does not answer; look at the rig") from error
        finally:
            self._open.pop(order.number, None)
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
        """Hand a reply of the loop to whoever waits for it."""
        future = self._open.get(reply.number)
        if future is not None and not future.done():
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
