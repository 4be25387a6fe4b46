"""What a browser may do: each action is checked, carried out, logged and answered."""

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final, TypeVar

from anyio.to_thread import run_sync
from pydantic import ValidationError
from starlette.requests import Request
from starlette.responses import Response

from hardware.description.errors import PmmError
from pmm.console.audit import CommandRecord, keep, latest
from pmm.console.desk import NotInControlError
from pmm.console.encoding import encode_answer
from pmm.console.hub import Hub
from pmm.console.limits import LARGEST_PLAN, LARGEST_REQUEST
from pmm.console.loop_side import LoopSide
from pmm.console.messages import OrderKind
from pmm.console.plans import Plans
from pmm.console.requests import (
    AnswerPosted,
    CommandPosted,
    DropPosted,
    EditPosted,
    HoldPosted,
    MovePosted,
    NotePosted,
    PlanPosted,
    Posted,
    RunPosted,
    TakePosted,
)
from pmm.console.security import VISITOR, Visitor
from pmm.console.worker_process import Workers
from pmm.console.worker_tasks import Queued, changed_plan, check_plan_text, keep_note, ready_plan
from pmm.run.states import Command

SESSION: Final = "x-pmm-session"
_LOGGED: Final = 400  # bytes of what was posted; plans are kept as files
_SHOWN: Final = 8  # characters of a session
# As JSON, in which a line's end takes two.
_LARGEST: Final[dict[type[Posted], int]] = {PlanPosted: 2 * LARGEST_PLAN}
P = TypeVar("P", bound=Posted)


@dataclass(frozen=True)
class Who:
    """Who asks."""

    session: str
    address: str
    visitor: Visitor


def who_asks(request: Request) -> Who:
    """Return who sends a request."""
    address = request.client.host if request.client is not None else "?"
    return Who(request.headers.get(SESSION, ""), address, request.scope[VISITOR])


class TooLargeError(PmmError):
    """A request that is larger than any of its kind."""


class PageActions:
    """Carries out what is posted.

    Parameters
    ----------
    folder
        Where commands are logged while there is no campaign.
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
        self._queued, self._changing = Queued(), asyncio.Lock()

    async def command(self, request: Request) -> Response:
        """Hand a command to run control; a quick stop is everybody's right."""
        return await self._do(request, CommandPosted, "command", self._command)

    async def answer(self, request: Request) -> Response:
        """Answer the rig's question."""
        return await self._do(request, AnswerPosted, "answer", self._answer)

    async def queue(self, request: Request) -> Response:
        """Queue a plan."""
        return await self._do(request, PlanPosted, "queue", self._queue)

    async def drop(self, request: Request) -> Response:
        """Take a plan out of the queue."""
        return await self._do(request, DropPosted, "drop", self._drop)

    async def edit(self, request: Request) -> Response:
        """Change a planned run's settings."""
        return await self._do(request, EditPosted, "edit", self._change)

    async def move(self, request: Request) -> Response:
        """Move a planned run, or a plan that waits."""
        return await self._do(request, MovePosted, "move", self._move)

    async def hold(self, request: Request) -> Response:
        """Hold a planned run, or a plan, or release it."""
        return await self._do(request, HoldPosted, "hold", self._change)

    async def note(self, request: Request) -> Response:
        """Keep a line on a run or a campaign; nothing moves, so it needs no control."""
        return await self._do(request, NotePosted, "note", self._note)

    async def take(self, request: Request) -> Response:
        """Take control."""
        return await self._do(request, TakePosted, "take control", self._take)

    async def check(self, request: Request) -> Response:
        """Read and check a plan; nothing is changed, so whoever watches may do it."""
        return await self._do(request, PlanPosted, "check", self._check)

    def folder(self) -> Path:
        """Return the folder of the present campaign, or the one for all."""
        present = self._hub.last.plan if self._hub.last is not None else 0
        return self._queued.folder(present) or self._folder

    def folders(self) -> list[Path]:
        """Return the folders of all campaigns that were queued."""
        return self._queued.folders()

    async def _do(
        self,
        request: Request,
        kind: type[P],
        action: str,
        act: Callable[[P, Who], Awaitable[dict[str, Any]]],
    ) -> Response:
        who = who_asks(request)
        given, folder = "", self.folder()
        try:
            body = await body_of(request, _LARGEST.get(kind, LARGEST_REQUEST))
            given = body[:_LOGGED].decode("utf-8", "replace")
            found = await act(kind.model_validate_json(body), who)
            status = 200
        except ValidationError as error:
            status, found = 422, {"error": _said(error)}
        except NotInControlError as error:
            status, found = 403, {"error": str(error)}
        except PmmError as error:
            status, found = 409, {"error": str(error)}
        if action != "check":
            await self.log(who, action, given, found, folder, taken=status == 200)
        return Response(encode_answer(found), status, media_type="application/json")

    async def log(
        self,
        who: Who,
        action: str,
        given: str,
        found: dict[str, Any],
        folder: Path | None = None,
        *,
        taken: bool,
    ) -> None:
        """Keep what was asked and what was answered, in the present campaign's folder or that."""
        said = str(found.get("said", found.get("error", "")))
        session = who.session[:_SHOWN]
        name, role = who.visitor.name, str(who.visitor.role)
        record = CommandRecord(
            self._utc(), name, role, who.address, session, action, given, taken, said
        )
        self._hub.tell_done(asdict(record))
        try:
            await run_sync(keep, folder or self.folder(), record)
        except OSError as error:
            self.alarm(f"commands are not logged: {error}")

    def alarm(self, text: str) -> None:
        """Show something that the server has found as an alarm."""
        self._hub.say("alarm", text)

    async def _command(self, posted: CommandPosted, who: Who) -> dict[str, Any]:
        if posted.command is Command.QUICK_STOP:
            return {"said": await self._loop.stop_quickly()}
        self._require_control(who)
        return {"said": await self._loop.order(OrderKind.COMMAND, str(posted.command))}

    async def _answer(self, posted: AnswerPosted, who: Who) -> dict[str, Any]:
        self._require_control(who)
        said = await self._loop.order(OrderKind.ANSWER, posted.answer, posted.question)
        return {"said": said}

    async def _check(self, posted: PlanPosted, who: Who) -> dict[str, Any]:
        worker = self._workers.for_whom(in_control=self._hub.desk.holder == who.session)
        found = await worker.run(check_plan_text, self._plans, posted.name, posted.text)
        return {"plan": found}

    async def _queue(self, posted: PlanPosted, who: Who) -> dict[str, Any]:
        self._require_control(who)
        worker = self._workers.for_whom(in_control=True)
        found = await worker.run(ready_plan, self._plans, posted.name, posted.text)
        number = self._queued.add(found)
        try:
            said = await self._loop.order(OrderKind.QUEUE, plan=self._queued.plan(number))
        except PmmError:
            self._queued.drop(number)
            raise
        self._tell_plans()
        return {"said": said, "plan": found.picture}

    async def _drop(self, posted: DropPosted, who: Who) -> dict[str, Any]:
        self._require_control(who)
        said = await self._loop.order(OrderKind.DROP, str(posted.number))
        self._queued.drop(posted.number)
        self._tell_plans()
        return {"said": said}

    async def _move(self, posted: MovePosted, who: Who) -> dict[str, Any]:
        if posted.run:
            return await self._change(posted, who)
        self._require_control(who)
        return {"said": await self._loop.order(OrderKind.MOVE, f"{posted.number} {posted.by}")}

    async def _change(self, posted: RunPosted, who: Who) -> dict[str, Any]:
        self._require_control(who)
        worker = self._workers.for_whom(in_control=True)
        async with self._changing:  # each change begins with what the one before has made
            before = self._queued.plan(posted.number)
            found = await worker.run(changed_plan, self._plans, before, posted)
            said = await self._loop.order(OrderKind.CHANGE, plan=found.packed)
            self._queued.change(found)
        self._tell_plans()
        return {"said": said, "plan": found.picture}

    async def _note(self, posted: NotePosted, who: Who) -> dict[str, Any]:
        who.visitor.require_operator()
        worker = self._workers.for_whom(in_control=self._hub.desk.holder == who.session)
        plan = self._queued.plan(posted.number)
        await worker.run(keep_note, plan, posted, self._utc())
        about = posted.run or plan.plan.name
        self._hub.say("note", f"{about}: {posted.text} ({posted.author})")
        return {"said": f"noted on {about}"}

    async def audit(self, _request: Request) -> Response:
        """Return who did what with the present campaign, from its folder."""
        found = await run_sync(latest, self.folder())
        return Response(encode_answer({"audit": found}), media_type="application/json")

    def _require_control(self, who: Who) -> None:
        who.visitor.require_operator()
        self._hub.desk.require(who.session)

    async def _take(self, posted: TakePosted, who: Who) -> dict[str, Any]:
        who.visitor.require_operator()
        self._hub.desk.take_over(who.session)
        self._hub.news.set()
        return {"said": "this browser has control"}

    def _tell_plans(self) -> None:
        last = self._hub.last
        if last is not None:
            self._queued.at_hand((last.plan, *last.queue))
        self._hub.tell_plans(encode_answer(self._queued.pictures()))


async def body_of(request: Request, largest: int = LARGEST_REQUEST) -> bytes:
    """Read a body that is not larger than so many bytes.

    Raises
    ------
    TooLargeError
        If it is.
    """
    body = bytearray()
    async for part in request.stream():
        body += part
        if len(body) > largest:
            raise TooLargeError(f"the request is larger than {largest} bytes")
    return bytes(body)


def _said(error: ValidationError) -> str:
    return "; ".join(
        f"{'.'.join(map(str, one['loc'])) or 'body'}: {one['msg']}"
        for one in error.errors(include_url=False, include_input=False)
    )
