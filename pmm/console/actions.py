"""What a browser may do: each action is checked, carried out, logged and answered."""

from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, TypeVar

from anyio.to_thread import run_sync
from pydantic import ValidationError
from starlette.requests import Request
from starlette.responses import JSONResponse

from hardware.description.errors import PmmError
from pmm.console.command_log import CommandRecord, keep
from pmm.console.desk import NotInControlError
from pmm.console.hub import Hub
from pmm.console.loop_side import LoopSide
from pmm.console.messages import Notice, OrderKind
from pmm.console.plans import CheckedPlan, Plans, plan_picture
from pmm.console.requests import (
    AnswerPosted,
    CommandPosted,
    DropPosted,
    PlanPosted,
    Posted,
    TakePosted,
)
from pmm.run.states import Command

SESSION: Final = "x-pmm-session"
_LARGEST_BODY: Final = (1 << 20) + (1 << 16)
_LOGGED: Final = 400  # bytes of what was posted; plans are kept as files
_SHOWN: Final = 8  # characters of a session
P = TypeVar("P", bound=Posted)


@dataclass(frozen=True)
class Who:
    """Who asks."""

    session: str
    address: str


class TooLargeError(PmmError):
    """A request that is larger than any plan."""


class Actions:
    """Carries out what is posted.

    Parameters
    ----------
    folder
        Where commands are logged while there is no campaign.
    """

    def __init__(
        self, hub: Hub, loop: LoopSide, plans: Plans, folder: Path, utc: Callable[[], str]
    ) -> None:
        self._hub, self._loop, self._plans = hub, loop, plans
        self._folder, self._utc = folder, utc
        self._queued: dict[int, CheckedPlan] = {}

    async def command(self, request: Request) -> JSONResponse:
        """Hand a command to run control; a quick stop is everybody's right."""
        return await self._do(request, CommandPosted, "command", self._command)

    async def answer(self, request: Request) -> JSONResponse:
        """Answer the rig's question."""
        return await self._do(request, AnswerPosted, "answer", self._answer)

    async def queue(self, request: Request) -> JSONResponse:
        """Queue a plan."""
        return await self._do(request, PlanPosted, "queue", self._queue)

    async def drop(self, request: Request) -> JSONResponse:
        """Take a plan out of the queue."""
        return await self._do(request, DropPosted, "drop", self._drop)

    async def take(self, request: Request) -> JSONResponse:
        """Take control."""
        return await self._do(request, TakePosted, "take control", self._take)

    async def check(self, request: Request) -> JSONResponse:
        """Read and check a plan; nothing is changed, so whoever watches may do it."""
        return await self._do(request, PlanPosted, "check", self._check)

    def folder(self) -> Path:
        """Return the folder of the present campaign, or the one for all."""
        present = self._hub.last.plan if self._hub.last is not None else 0
        found = self._queued.get(present)
        return self._folder if found is None else found.waiting.folder

    def folders(self) -> list[Path]:
        """Return the folders of all campaigns that were queued."""
        return [one.waiting.folder for one in self._queued.values()]

    def queued(self, number: int) -> CheckedPlan | None:
        """Return a plan that was queued."""
        return self._queued.get(number)

    async def _do(
        self,
        request: Request,
        kind: type[P],
        action: str,
        act: Callable[[P, Who], Awaitable[dict[str, Any]]],
    ) -> JSONResponse:
        address = request.client.host if request.client is not None else "?"
        who = Who(request.headers.get(SESSION, ""), address)
        given = ""
        try:
            body = await body_of(request)
            given = body[:_LOGGED].decode("utf-8", "replace")
            found = await act(kind.model_validate_json(body), who)
            status = 200
        except ValidationError as error:
            status, found = 422, {"error": _said(error)}
        except NotInControlError as error:
            status, found = 403, {"error": str(error)}
        except PmmError as error:
            status, found = 409, {"error": str(error)}
        await self._log(who, action, given, found, taken=status == 200)
        return JSONResponse(found, status)

    async def _log(
        self, who: Who, action: str, given: str, found: dict[str, Any], *, taken: bool
    ) -> None:
        if action == "check":
            return
        said = str(found.get("said", found.get("error", "")))
        session = who.session[:_SHOWN]
        record = CommandRecord(self._utc(), who.address, session, action, given, taken, said)
        try:
            await run_sync(keep, self.folder(), record)
        except OSError as error:
            time_s = self._hub.last.status.time_s if self._hub.last is not None else 0.0
            text = f"commands are not logged: {error}"
            self._hub.add_notice(Notice("alarm", time_s, text))

    async def _command(self, posted: CommandPosted, who: Who) -> dict[str, Any]:
        if posted.command is not Command.QUICK_STOP:
            self._hub.desk.require(who.session)
        return {"said": await self._loop.order(OrderKind.COMMAND, str(posted.command))}

    async def _answer(self, posted: AnswerPosted, who: Who) -> dict[str, Any]:
        self._hub.desk.require(who.session)
        said = await self._loop.order(OrderKind.ANSWER, posted.answer, posted.question)
        return {"said": said}

    async def _check(self, posted: PlanPosted, who: Who) -> dict[str, Any]:
        found = await run_sync(self._plans.check, posted.name, posted.text)
        return {"plan": plan_picture(found)}

    async def _queue(self, posted: PlanPosted, who: Who) -> dict[str, Any]:
        self._hub.desk.require(who.session)
        found = await run_sync(self._plans.queue, posted.name, posted.text)
        number = found.waiting.number
        self._queued[number] = found
        try:
            said = await self._loop.order(OrderKind.QUEUE, plan=found.waiting)
        except PmmError:
            del self._queued[number]
            raise
        self._tell_plans()
        return {"said": said, "plan": plan_picture(found)}

    async def _drop(self, posted: DropPosted, who: Who) -> dict[str, Any]:
        self._hub.desk.require(who.session)
        return {"said": await self._loop.order(OrderKind.DROP, str(posted.number))}

    async def _take(self, posted: TakePosted, who: Who) -> dict[str, Any]:
        self._hub.desk.take_over(who.session)
        self._hub.tell_desk()
        return {"said": "this browser has control"}

    def _tell_plans(self) -> None:
        plans = {str(n): plan_picture(one) for n, one in self._queued.items()}
        self._hub.plans = plans
        self._hub.broadcast({"type": "plans", "plans": plans})


async def body_of(request: Request) -> bytes:
    """Read a body that is not larger than any plan.

    Raises
    ------
    TooLargeError
        If it is.
    """
    body = bytearray()
    async for part in request.stream():
        body += part
        if len(body) > _LARGEST_BODY:
            raise TooLargeError(f"the request is larger than {_LARGEST_BODY} bytes")
    return bytes(body)


def _said(error: ValidationError) -> str:
    return "; ".join(
        f"{'.'.join(map(str, one['loc'])) or 'body'}: {one['msg']}"
        for one in error.errors(include_url=False, include_input=False)
    )
