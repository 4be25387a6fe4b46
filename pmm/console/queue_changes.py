"""What is done to the queue: checked by a worker, carried out by the loop, kept on the disk.

Whoever changed something waits with the answer until it is on the disk.
"""

import asyncio
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from hardware.description.errors import PmmError
from pmm.console.encoding import EncodedText, encode_answer
from pmm.console.hub import Hub
from pmm.console.loop_side import LoopSide, UnansweredError
from pmm.console.messages import OrderKind, Reply
from pmm.console.plans import Plans
from pmm.console.proposals import Proposals, ProposedChange
from pmm.console.queue_journal import KeptPlan, KeptQueue, QueueJournal
from pmm.console.queue_keeper import QueueKeeper
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
    from collections.abc import Awaitable, Callable


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
        except UnansweredError as error:  # the loop may have it
            error.then(lambda reply: None if reply.carried_out else self._forget(number))
            raise
        except PmmError:
            self.queued.drop(number)
            raise

    def _forget(self, number: int) -> None:
        self.queued.drop(number)
        self._tell_plans()

    async def _drop(self, posted: DropPosted) -> ActionReply:
        reply = await self._loop.order(OrderKind.DROP, str(posted.number))
        self._forget(posted.number)
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
            try:
                reply = await self._loop.order(OrderKind.CHANGE, plan=ready.packed)
            except UnansweredError as error:
                error.then(
                    lambda reply: self._keep_change(ready, posted) if reply.carried_out else None
                )
                raise
            self._keep_change(ready, posted)
        return of_reply(reply, ready.picture)

    def _keep_change(self, ready: ReadyPlan, posted: RunPosted) -> None:
        self.queued.change(ready, posted)
        self._tell_plans()

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

    def wait_on(self, proposal: ProposedChange) -> None:
        """Have a proposal wait again that was approved and, as is known by now, not carried out."""
        self._proposals.waiting[proposal.number] = proposal
        self.tell_proposals()

    def _tell_plans(self) -> None:
        last = self._hub.last
        if last is not None:
            self.queued.at_hand((last.plan, *last.queue))
        self._hub.tell_plans(encode_answer(self.queued.pictures()))
        self._keeper.note_change()

    def _queue_state(self) -> KeptQueue:
        return KeptQueue(self.queued.kept_plans(), tuple(self._proposals.waiting.values()))
