"""The web application: one page, what it loads, what it posts, and the stream of frames."""

import asyncio
import time
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from dataclasses import replace
from datetime import UTC, datetime
from importlib.util import find_spec
from math import ceil
from multiprocessing.connection import Connection
from pathlib import Path
from secrets import token_urlsafe
from typing import Any, Final

from anyio.to_thread import run_sync
from pydantic import ValidationError
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import BaseRoute, Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.websockets import WebSocket

from hardware.description.errors import PmmError
from pmm.console.actions import PageActions
from pmm.console.app_settings import ConsoleSettings
from pmm.console.client import Client
from pmm.console.coefficient_updates import CoefficientUpdates
from pmm.console.hub import Hub
from pmm.console.limits import MOST_STREAMS
from pmm.console.live.process import Publishing
from pmm.console.lockout import Lockout
from pmm.console.loop_side import LoopSide
from pmm.console.messages import Frame, Hello, LoopMessage, Notice, Reply
from pmm.console.openapi import description
from pmm.console.pages import Pages
from pmm.console.plans import Plans
from pmm.console.pump import pump
from pmm.console.quick_stop import QuickStop
from pmm.console.request_body import Requester, TooLargeError, body_of, who_asks
from pmm.console.requests import TokenPosted, validation_message
from pmm.console.security import COOKIE, Guard
from pmm.console.worker_process import SharedAnswer, Workers
from pmm.console.worker_tasks import look_around

PAGE: Final = Path(__file__).parent / "page"
_SESSION_LENGTH: Final = range(16, 65)
_WAIT: Final = "too many wrong tokens came from this address; wait {} s, then try again"
_NOT_TAKEN: Final = 1003  # RFC 6455: data of a kind that is not accepted
_TOO_MANY: Final = 1013  # the registry of RFC 6455: try again later
_FULL: Final = (
    f"{MOST_STREAMS} pages are open, which is the limit; close one. Quick stop works here too"
)


class Console:
    """The parts of a console that is being served."""

    def __init__(
        self,
        settings: ConsoleSettings,
        connection: Connection,
        quick_stop: QuickStop,
        end: Callable[[], None],
    ) -> None:
        self.door = settings.door
        self.hub = Hub(self._replied, self._written, self._lapsed, _utc)
        self.loop = LoopSide(connection, quick_stop, self._take, self._lost)
        self._publishing = Publishing(settings.live) if settings.live.any else None
        self._end = end
        self._lockout = Lockout(time.monotonic)
        plans = Plans(settings.rig_path, settings.rig_hashes, settings.plans, settings.output)
        self.workers = Workers()
        self.actions = PageActions(
            self.hub, self.loop, self.workers, plans, settings.log_folder, _utc
        )
        self._restoring: asyncio.Future[None] | None = None
        self._logging: asyncio.Future[None] | None = None
        figures = self.workers.figures
        self.finished = CoefficientUpdates(self.hub, figures, settings.earlier, settings.reference)
        self.pages = Pages(self.actions.changes.queued.folders, settings.log_folder)
        self._around = SharedAnswer(
            lambda: self.workers.around.run(look_around, plans, self.pages.folders())
        )
        self._pump = asyncio.ensure_future(pump(self.hub))

    def _take(self, message: LoopMessage) -> None:
        """Take what the loop tells, for the browsers and for those who read along."""
        self.hub.take(message)
        if isinstance(message, Hello):
            self._restoring = asyncio.ensure_future(self.actions.changes.restore())
        elif isinstance(message, Frame):
            self.actions.changes.follow_frame(message.number, (message.plan, *message.queue))
        if self._publishing is not None:
            self._publishing.take(message)
            self.hub.tell_live(self._publishing.statuses())

    def _replied(self, reply: Reply) -> None:
        self.loop.replied(reply)

    def _written(self, notice: Notice) -> None:
        if notice.folder is not None:
            self.finished.look_at(notice.folder)

    def _lapsed(self, who: Requester) -> None:
        self._logging = asyncio.ensure_future(self.actions.log_lapse(who))

    def _lost(self) -> None:
        self.hub.lost()
        self._end()

    async def stream(self, socket: WebSocket) -> None:
        """Serve one browser until it goes."""
        session = socket.query_params.get("session", "")
        taken = "adopt" in socket.query_params and session in self.hub.clients
        if len(session) not in _SESSION_LENGTH or taken:
            session = token_urlsafe(24)
        await socket.accept()
        if len(self.hub.clients) >= MOST_STREAMS and not self.hub.is_expected(session):
            await socket.close(_TOO_MANY, _FULL)
            return
        client = Client(replace(who_asks(socket), session=session), socket.send_text, socket.close)
        self.hub.join(client)
        try:
            if (await socket.receive())["type"] == "websocket.receive":
                await socket.close(
                    _NOT_TAKEN, "nothing is taken on this stream; commands are posted"
                )
        finally:
            self.hub.part(client)

    async def log_in(self, request: Request) -> Response:
        """Take the token and give a cookie for it."""
        who = who_asks(request)
        try:
            posted = TokenPosted.model_validate_json(await body_of(request))
        except ValidationError as error:
            return JSONResponse({"error": validation_message(error)}, 422)
        except TooLargeError as error:
            return JSONResponse({"error": str(error)}, 422)
        left_s = ceil(self._lockout.wait_s(who.address))  # nothing is awaited until it is counted
        if left_s:
            return JSONResponse({"error": _WAIT.format(left_s)}, 429, {"retry-after": str(left_s)})
        login = self.door.log_in(posted.token, posted.name.strip())
        if login is None:
            said, shut_out = self._lockout.count_wrong(who.address)
            if shut_out:
                self.actions.alarm(said)
            await self.actions.log(who, "log in", "", {"error": said}, taken=False)
            return JSONResponse({"error": "this is not the token"}, 401)
        cookie, visitor = login
        who = replace(who, visitor=visitor)
        self._lockout.forget_wrong(who.address)
        await self.actions.log(who, "log in", "", {"said": "welcome"}, taken=True)
        answer = JSONResponse({"said": "welcome"})
        answer.set_cookie(
            COOKIE, cookie, httponly=True, samesite="strict", secure=self.door.tls, path="/"
        )
        return answer

    async def offered(self, request: Request) -> Response:
        """Return the names of the plans."""
        return await self._folder_response(lambda names, _: {"names": names})

    async def listed(self, request: Request) -> Response:
        """Return the pages that the campaigns' folders hold."""
        return await self._folder_response(lambda _, folders: {"pages": self.pages.listed(folders)})

    async def _folder_response(
        self, show: Callable[[list[str], dict[Path, list[str]]], dict[str, Any]]
    ) -> Response:
        try:
            return JSONResponse(show(*await self._around.get()))
        except PmmError as error:
            return JSONResponse({"error": str(error)}, 409)

    async def leave(self) -> None:
        """Stop sending, publishing and calculating, and end the workers."""
        self._pump.cancel()
        self.finished.close()
        self.workers.close()
        if self._publishing is not None:
            await run_sync(self._publishing.close)
        await asyncio.sleep(0)


def application(
    settings: ConsoleSettings,
    connection: Connection,
    quick_stop: QuickStop,
    end: Callable[[], None],
) -> Guard:
    """Return the application; it is set up when its event loop runs.

    Parameters
    ----------
    end
        Called when the loop has ended: nothing is left to be shown.
    """

    @asynccontextmanager
    async def lifespan(app: Starlette) -> AsyncIterator[None]:
        console = Console(settings, connection, quick_stop, end)
        app.router.routes.extend(_routes(console))
        try:
            yield
        finally:
            await console.leave()

    return Guard(Starlette(lifespan=lifespan), settings.door)


def _routes(console: Console) -> list[BaseRoute]:
    act = console.actions
    posts = {
        "/api/command": act.command,
        "/api/answer": act.answer,
        "/api/take-control": act.take,
        "/api/give-control": act.give,
        "/api/plans/check": act.check,
        "/api/plans/queue": act.queue,
        "/api/plans/drop": act.drop,
        "/api/plans/edit": act.edit,
        "/api/plans/move": act.move,
        "/api/plans/hold": act.hold,
        "/api/plans/note": act.note,
        "/api/proposals/approve": act.approve,
        "/api/proposals/refuse": act.refuse,
        "/login": console.log_in,
    }
    return [
        Route("/", _file("console.html")),
        Route("/login", _file("login.html")),
        Route("/api/plans", console.offered),
        Route("/api/pages", console.listed),
        Route("/api/audit", act.audit),
        Route("/api/openapi.json", _described),
        Route("/pages/{folder:int}/{name}", console.pages.page),
        *(Route(path, action, methods=["POST"]) for path, action in posts.items()),
        WebSocketRoute("/stream", console.stream),
        Mount("/page", StaticFiles(directory=PAGE)),
        Mount("/charts", StaticFiles(directory=charts_folder())),
    ]


async def _described(_request: Request) -> Response:
    return JSONResponse(description())


def _file(name: str) -> Callable[[Request], Awaitable[Response]]:
    async def served(_request: Request) -> Response:
        return FileResponse(PAGE / name)

    return served


def charts_folder() -> Path:
    """Return where the wheel keeps the charts' JavaScript; it is not imported for that.

    Raises
    ------
    ModuleNotFoundError
        If it is not installed.
    """
    spec = find_spec("uplot")
    if spec is None or spec.origin is None:
        raise ModuleNotFoundError("uplot-python is not installed; install this package anew")
    return Path(spec.origin).parent / "static"


def _utc() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds")
