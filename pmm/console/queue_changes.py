"""What is done to the queue: checked by a worker, carried out by the loop, kept on the disk.

Whoever changed something waits with the answer until it is on the disk.
"""

import asyncio
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from anyio.to_thread import run_sync

from hardware.description.errors import PmmError
from pmm.console.encoding import EncodedText, encode_answer
from pmm.console.hub import Hub
from pmm.console.loop_side import LoopSide
from pmm.console.messages import OrderKind, Reply
from pmm.console.plans import Plans
from pmm.console.proposals import Proposals
from pmm.console.queue_journal import KeptPlan, KeptQueue, QueueJournal
from pmm.console.requests import DropPosted, HoldPosted, MovePosted, PlanPosted, Posted, RunPosted
from pmm.console.worker_process import Workers
from pmm.console.worker_tasks import (
    QueuedPlans,
    ReadyPlan,
    changed_plan,
    possible_plan,
    ready_plan,
    restored_plan,
)

if TYPE_CHECKING:
    from collections.abc import Awaitable


@dataclass(frozen=True)
class ActionReply:
    """What came of a request.

    Attributes
    ----------
    text, plan
        The answer; empty or ``None`` where there is nothing to say.
    present
        Number of the plan to which it belongs; ``None`` where the loop was not asked.
    number
        Of the plan that was queued; ``None`` where none was.
    """

    text: str
    plan: EncodedText | None = None
    present: int | None = None
    number: int | None = None

    def answer(self) -> dict[str, Any]:
        """Return the fields that the page gets, without those that say nothing."""
        parts = {"said": self.text or None, "number": self.number, "plan": self.plan}
        return {key: value for key, value in parts.items() if value is not None}


def of_reply(reply: Reply, plan: EncodedText | None = None) -> ActionReply:
    """Return what came of an order to the loop."""
    return ActionReply(reply.text, plan, reply.plan)


class QueueChanges:
    """Carries out changes of the queue, one after the other where they build on each other.

    Attributes
    ----------
    queued
        The plans at hand.
    """

    def __init__(
        self,
        hub: Hub,
        loop: LoopSide,
        workers: Workers,
        plans: Plans,
        proposals: Proposals,
        journal: QueueJournal,
    ) -> None:
        self._hub, self._loop, self._workers, self._plans = hub, loop, workers, plans
        self._proposals = proposals
        self._keeper = QueueKeeper(journal, self._queue_state, lambda text: hub.say("alarm", text))
        self._changing, self._order = asyncio.Lock(), tuple[int, ...]()
        self._frame, self._told = 0, asyncio.Event()
        self.queued = QueuedPlans()
        self._acts: dict[str, Callable[[Any], Awaitable[ActionReply]]] = {
            "queue": self._queue,
            "drop": self._drop,
            "edit": self._change,
            "move": self._move,
            "hold": self._change,
        }

    async def carry_out(self, action: str, posted: Posted) -> ActionReply:
        """Do one of :data:`~pmm.console.proposals.PROPOSED`.

        Raises
        ------
        PmmError
            If the rig, the plan or the loop does not allow it.
        """
        return await self._acts[action](posted)

    async def try_out(self, posted: Posted) -> tuple[str, EncodedText]:
        """Return the plan's name and its picture as it would be; raises as carrying out does."""
        worker = self._workers.for_whom(in_control=False)
        if isinstance(posted, PlanPosted):
            ready = await worker.run(possible_plan, self._plans, posted.name, posted.text)
            return ready.packed.bare.plan.name, ready.picture
        number: int = getattr(posted, "number", 0)
        plan = self.queued.plan(number)
        picture = self.queued.pictures()[str(number)]
        if isinstance(posted, RunPosted) and (posted.run or isinstance(posted, HoldPosted)):
            picture = (await worker.run(changed_plan, self._plans, plan, posted)).picture
        return plan.bare.plan.name, picture

    async def _queue(self, posted: PlanPosted) -> ActionReply:
        worker = self._workers.for_whom(in_control=True)
        async with self._changing:
            frame = self._frame
            ready = await worker.run(ready_plan, self._plans, posted.name, posted.text)
            reply = await self._add(ready, frame)
            number = self.queued.count
        self._tell_plans()
        return replace(of_reply(reply, ready.picture), number=number)

    async def _add(
        self, ready: ReadyPlan, frame: int, changes: tuple[RunPosted, ...] = ()
    ) -> Reply:
        """Queue a plan whose folder was looked at after a frame."""
        number = self.queued.add(ready, changes)
        try:
            plan = self.queued.plan(number)
            return await self._loop.order(OrderKind.QUEUE, str(frame), plan=plan)
        except PmmError:
            self.queued.drop(number)
            raise

    async def _drop(self, posted: DropPosted) -> ActionReply:
        reply = await self._loop.order(OrderKind.DROP, str(posted.number))
        self.queued.drop(posted.number)
        self._tell_plans()
        return of_reply(reply)

    async def _move(self, posted: MovePosted) -> ActionReply:
        if posted.run:
            return await self._change(posted)
        reply = await self._loop.order(OrderKind.MOVE, f"{posted.number} {posted.by}")
        while self._frame < reply.frame:  # only frames tell the order
            self._told.clear()
            await self._told.wait()
        return of_reply(reply)

    async def _change(self, posted: RunPosted) -> ActionReply:
        worker = self._workers.for_whom(in_control=True)
        async with self._changing:  # each change begins with what the one before has made
            before = self.queued.plan(posted.number)
            ready = await worker.run(changed_plan, self._plans, before, posted)
            reply = await self._loop.order(OrderKind.CHANGE, plan=ready.packed)
            self.queued.change(ready, posted)
        self._tell_plans()
        return of_reply(reply, ready.picture)

    def follow_frame(self, frame: int, numbers: tuple[int, ...]) -> None:
        """Take the order of the queue as the latest frame tells it."""
        self._frame = frame
        self._told.set()
        if numbers != self._order:
            self._order = numbers
            self.queued.at_hand(numbers)
            self._keeper.note_change()

    async def restore(self) -> None:
        """Queue again what was in the queue when the console before ended; nothing moves by it."""
        async with self._changing:
            try:
                queue = self._keeper.read()
            except PmmError as error:
                self._hub.say("alarm", str(error))
                queue = KeptQueue()
            numbers = {plan.number: await self._queue_again(plan) for plan in queue.plans}
            self._proposals.restore(queue.proposals, numbers)
            self._tell_plans()
            self.tell_proposals()
            self._keeper.begin()

    async def _queue_again(self, plan: KeptPlan) -> int:
        """Queue a plan again; return its number now, 0 if nothing of it is left to be made."""
        worker, frame = self._workers.for_whom(in_control=True), self._frame
        try:
            ready = await worker.run(restored_plan, self._plans, plan)
            if ready is None:
                return 0
            await self._add(ready, frame, plan.changes)
        except PmmError as error:
            self._hub.say("alarm", f"{plan.name} is not in the queue again: {error}")
            return 0
        return self.queued.count

    async def when_written(self, reply: ActionReply) -> ActionReply:
        """Return an answer once what it says is on the disk; the answer says where it is not."""
        async with self._changing:  # what was kept before is known by then
            trouble = await self._keeper.wait_written()
        return replace(reply, text=f"{reply.text}; {trouble}") if trouble else reply

    def tell_proposals(self) -> None:
        """Tell what is proposed, and keep it."""
        self._hub.tell_proposals(self._proposals.pictures())
        self._keeper.note_change()

    def _tell_plans(self) -> None:
        last = self._hub.last
        if last is not None:
            self.queued.at_hand((last.plan, *last.queue))
        self._hub.tell_plans(encode_answer(self.queued.pictures()))
        self._keeper.note_change()

    def _queue_state(self) -> KeptQueue:
        return KeptQueue(self.queued.kept_plans(), tuple(self._proposals.waiting.values()))


class QueueKeeper:
    """Keeps the journal up to date from :meth:`begin` on: before it, what is kept is not all known.

    Parameters
    ----------
    state
        Returns what is to be kept.
    alarm
        Told why it cannot be written.
    """

    def __init__(
        self, journal: QueueJournal, state: Callable[[], KeptQueue], alarm: Callable[[str], None]
    ) -> None:
        self._journal, self._state, self._alarm = journal, state, alarm
        self._begun = self._again = False
        self._task: asyncio.Task[None] | None = None
        self._trouble = ""

    def read(self) -> KeptQueue:
        """Return what is kept; raises ConfigurationError as the journal does."""
        return self._journal.read()

    def begin(self) -> None:
        """Keep the present state, and each that follows."""
        self._begun = True
        self.note_change()

    def note_change(self) -> None:
        """Note that there is something to keep."""
        self._again = self._begun
        if self._begun and (self._task is None or self._task.done()):
            self._task = asyncio.get_running_loop().create_task(self._write())

    async def wait_written(self) -> str:
        """Wait until what was changed so far is on the disk; return why it is not, if it is not."""
        if self._task is not None:
            await asyncio.wait([self._task])
        return self._trouble

    async def _write(self) -> None:
        while self._again:
            self._again, self._trouble = False, ""
            try:
                await run_sync(self._journal.write, self._state())
            except OSError as error:
                self._trouble = f"the queue is not kept: {error}"
                self._alarm(self._trouble)
