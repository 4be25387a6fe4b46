"""What a browser may do: each action is checked, carried out, logged and answered."""

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, Final, TypeVar

from anyio.to_thread import run_sync
from pydantic import ValidationError
from starlette.requests import Request
from starlette.responses import Response

from hardware.description.errors import PmmError
from pmm.console.audit import CommandRecord, keep, latest
from pmm.console.desk import Holder
from pmm.console.encoding import encode_answer
from pmm.console.hub import Hub
from pmm.console.limits import LARGEST_PLAN, LARGEST_REQUEST, SILENT_S
from pmm.console.loop_side import LoopSide, RefusedError, UnansweredError
from pmm.console.messages import OrderKind, Reply
from pmm.console.plans import Plans
from pmm.console.proposals import PROPOSED, Proposals
from pmm.console.queue_changes import ActionReply, QueueChanges, of_reply
from pmm.console.queue_journal import QueueJournal
from pmm.console.request_body import Requester, body_of, who_asks
from pmm.console.requests import (
    AnswerPosted,
    CommandPosted,
    DecisionPosted,
    GivePosted,
    NotePosted,
    PlanPosted,
    Posted,
    TakePosted,
    validation_message,
)
from pmm.console.security import NotInControlError, VisitorRole
from pmm.console.worker_process import Workers
from pmm.console.worker_tasks import check_plan_text, keep_note
from pmm.run.states import Command

_LOGGED: Final = 400  # bytes of what was posted; plans are kept as files
_SHOWN: Final = 8  # characters of a session
# As JSON, in which a line's end takes two.
_LARGEST: Final[dict[type[Posted], int]] = {PlanPosted: 2 * LARGEST_PLAN}
_ENDED: Final = {True: "withdrawn", False: "refused"}
P = TypeVar("P", bound=Posted)


class PageActions:
    """Carries out what is posted.

    Parameters
    ----------
    folder
        Where commands are logged while there is no campaign.

    Attributes
    ----------
    changes
        What is done to the queue.
    """

    def __init__(
        self,
        hub: Hub,
        loop: LoopSide,
        workers: Workers,
        plans: Plans,
        folder: Path,
        utc: Callable[[], str],
    ) -> None:
        self._hub, self._loop, self._workers, self._plans = hub, loop, workers, plans
        self._folder, self._utc = folder, utc
        self._proposals = Proposals()
        self._late: asyncio.Future[None] | None = None
        self.changes = QueueChanges(
            hub, loop, workers, plans, self._proposals, QueueJournal(folder, plans.rig_path)
        )

    async def command(self, request: Request) -> Response:
        """Hand a command to run control; a quick stop is everybody's right."""
        return await self._do(request, CommandPosted, "command", self._command)

    async def answer(self, request: Request) -> Response:
        """Take the operator's answer to the rig's question, and reply what came of it."""
        return await self._do(request, AnswerPosted, "answer", self._answer)

    async def queue(self, request: Request) -> Response:
        """Queue the posted plan, or keep the wish of whoever may only propose."""
        return await self._alter(request, "queue")

    async def drop(self, request: Request) -> Response:
        """Take a plan out of the queue."""
        return await self._alter(request, "drop")

    async def edit(self, request: Request) -> Response:
        """Change a planned run's settings."""
        return await self._alter(request, "edit")

    async def move(self, request: Request) -> Response:
        """Move a planned run, or a plan that waits."""
        return await self._alter(request, "move")

    async def hold(self, request: Request) -> Response:
        """Hold a planned run, or a plan, or release it."""
        return await self._alter(request, "hold")

    async def approve(self, request: Request) -> Response:
        """Carry out a proposal, as if whoever has control had asked for it."""
        return await self._do(request, DecisionPosted, "approve", self._approve)

    async def refuse(self, request: Request) -> Response:
        """Forget a proposal: refused by whoever has control, or withdrawn by who made it."""
        return await self._do(request, DecisionPosted, "refuse", self._refuse)

    async def note(self, request: Request) -> Response:
        """Keep a line on a run or a campaign; nothing moves, so it needs no control."""
        return await self._do(request, NotePosted, "note", self._note)

    async def take(self, request: Request) -> Response:
        """Give control to the session that asks for it."""
        return await self._do(request, TakePosted, "take control", self._take)

    async def give(self, request: Request) -> Response:
        """Take control back from the session that has it and wants it no more."""
        return await self._do(request, GivePosted, "give control", self._give)

    async def check(self, request: Request) -> Response:
        """Read and check a plan; nothing is changed, so whoever watches may do it."""
        return await self._do(request, PlanPosted, "check", self._check)

    def folder(self, present: int | None = None) -> Path:
        """Return a plan's folder, by default that of the present one, or the one for all."""
        if present is None:
            present = self._hub.last.plan if self._hub.last is not None else 0
        return self.changes.queued.folder(present) or self._folder

    async def _do(
        self,
        request: Request,
        kind: type[P],
        action: str,
        act: Callable[[P, Requester], Awaitable[ActionReply]],
    ) -> Response:
        who = who_asks(request)
        if self._in_control(who):
            self._hub.hear_holder()
        text, present = "", None
        try:
            body = await body_of(request, _LARGEST.get(kind, LARGEST_REQUEST))
            text = body[:_LOGGED].decode("utf-8", "replace")
            reply = await act(kind.model_validate_json(body), who)
            status, answer, present = 200, reply.answer(), reply.present
        except ValidationError as error:
            status, answer = 422, {"error": validation_message(error)}
        except NotInControlError as error:
            status, answer = 403, {"error": str(error)}
        except RefusedError as error:
            status, answer, present = 409, {"error": str(error)}, error.present
            if isinstance(error, UnansweredError):
                error.then(lambda reply: self._log_late(who, action, text, reply))
        except PmmError as error:
            status, answer = 409, {"error": str(error)}
        if action != "check":
            await self.log(who, action, text, answer, self.folder(present), taken=status == 200)
        return Response(encode_answer(answer), status, media_type="application/json")

    async def log(
        self,
        who: Requester,
        action: str,
        text: str,
        answer: dict[str, Any],
        folder: Path | None = None,
        *,
        taken: bool,
    ) -> None:
        """Keep what was asked and what was answered, in the present campaign's folder or that."""
        said = str(answer.get("said", answer.get("error", "")))
        session = who.session[:_SHOWN]
        name, role = who.visitor.name, str(who.visitor.role)
        record = CommandRecord(
            self._utc(), name, role, who.address, session, action, text, taken, said
        )
        self._hub.tell_done(asdict(record))
        try:
            await run_sync(keep, folder or self.folder(), record)
        except OSError as error:
            self.alarm(f"commands are not logged: {error}")

    def _log_late(self, who: Requester, action: str, text: str, reply: Reply) -> None:
        """Keep what came of an order after whoever gave it was told that nobody answers."""
        said, folder = {"said": f"answered late: {reply.text}"}, self.folder(reply.plan)
        log = self.log(who, action, text, said, folder, taken=reply.carried_out)
        self._late = asyncio.ensure_future(log)

    async def log_lapse(self, who: Requester) -> None:
        """Keep whose control has lapsed."""
        said = f"nothing was heard of this session for {SILENT_S:g} s; nobody has control"
        await self.log(who, "control lapses", "", {"said": said}, taken=True)

    def alarm(self, text: str) -> None:
        """Show something that the server has found as an alarm."""
        self._hub.say("alarm", text)

    async def _alter(self, request: Request, action: str) -> Response:
        """Change the queue, or keep the wish where the token is for proposing."""

        async def act(posted: Posted, who: Requester) -> ActionReply:
            if who.visitor.role is VisitorRole.PROPOSE:
                return await self._propose(action, posted, who)
            self._require_control(who)
            return await self.changes.when_written(await self.changes.carry_out(action, posted))

        return await self._do(request, PROPOSED[action], action, act)

    async def _propose(self, action: str, posted: Posted, who: Requester) -> ActionReply:
        """Keep what would be done, once it is checked that it could be."""
        self._proposals.require_room()
        name, picture = await self.changes.try_out(posted)
        proposal = self._proposals.add(action, posted, name, who.visitor, self._utc())
        self.changes.tell_proposals()
        said = f"proposal {proposal.number}, {proposal.text}: whoever has control decides"
        return await self.changes.when_written(ActionReply(said, picture))

    async def _approve(self, posted: DecisionPosted, who: Requester) -> ActionReply:
        self._require_control(who)
        proposal = self._proposals.take(posted.number)
        try:
            reply = await self.changes.carry_out(proposal.action, proposal.posted)
        except UnansweredError as error:  # it may be carried out: it waits on if it was not
            error.then(lambda reply: None if reply.carried_out else self.changes.wait_on(proposal))
            self.changes.tell_proposals()
            raise
        except BaseException:  # it waits on, whatever has happened
            self._proposals.waiting[proposal.number] = proposal
            raise
        self.changes.tell_proposals()
        said = f"{proposal.text}, proposed by {proposal.visitor.name!r}: {reply.text}"
        return await self.changes.when_written(replace(reply, text=said))

    async def _refuse(self, posted: DecisionPosted, who: Requester) -> ActionReply:
        proposal = self._proposals.waiting.get(posted.number)
        is_own = proposal is not None and proposal.visitor is who.visitor
        if not is_own:
            self._require_control(who)
        proposal = self._proposals.take(posted.number)
        self.changes.tell_proposals()
        said = f"{proposal.text}, proposed by {proposal.visitor.name!r}: {_ENDED[is_own]}"
        return await self.changes.when_written(ActionReply(said))

    async def _command(self, posted: CommandPosted, who: Requester) -> ActionReply:
        if posted.command is Command.QUICK_STOP:
            return ActionReply(await self._loop.stop_quickly())
        self._require_control(who)
        return of_reply(await self._loop.order(OrderKind.COMMAND, str(posted.command)))

    async def _answer(self, posted: AnswerPosted, who: Requester) -> ActionReply:
        self._require_control(who)
        return of_reply(await self._loop.order(OrderKind.ANSWER, posted.answer, posted.question))

    async def _check(self, posted: PlanPosted, who: Requester) -> ActionReply:
        worker = self._workers.for_whom(in_control=self._in_control(who))
        picture = await worker.run(check_plan_text, self._plans, posted.name, posted.text)
        return ActionReply("", picture)

    async def _note(self, posted: NotePosted, who: Requester) -> ActionReply:
        who.visitor.require(VisitorRole.PROPOSE)
        worker = self._workers.for_whom(in_control=self._in_control(who))
        plan = self.changes.queued.plan(posted.number)
        await worker.run(keep_note, plan, posted, self._utc())
        about = posted.run or plan.bare.plan.name
        self._hub.say("note", f"{about}: {posted.text} ({posted.author})")
        return ActionReply(f"noted on {about}", present=posted.number)

    async def audit(self, _request: Request) -> Response:
        """Return who did what with the present campaign, from its folder."""
        records = await run_sync(latest, self.folder())
        return Response(encode_answer({"audit": records}), media_type="application/json")

    def _require_control(self, who: Requester) -> None:
        who.visitor.require(VisitorRole.OPERATE)
        self._hub.desk.require(who.session)

    def _in_control(self, who: Requester) -> bool:
        return self._hub.desk.seen_from(who.session) is Holder.YOU

    async def _take(self, posted: TakePosted, who: Requester) -> ActionReply:
        who.visitor.require(VisitorRole.OPERATE)
        self._hub.desk.take_over(who)
        self._hub.follow_control()
        return ActionReply("this browser has control")

    async def _give(self, _posted: GivePosted, who: Requester) -> ActionReply:
        self._hub.desk.give_back(who.session)
        self._hub.follow_control()
        return ActionReply("nobody has control")
