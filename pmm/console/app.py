"""The web application: one page, what it loads, what it posts, and the stream of frames."""

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from datetime import UTC, datetime
from importlib.util import find_spec
from multiprocessing.connection import Connection
from pathlib import Path
from secrets import token_urlsafe
from typing import Final

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import BaseRoute, Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.websockets import WebSocket, WebSocketDisconnect

from pmm.console.actions import Actions, body_of
from pmm.console.app_settings import Settings
from pmm.console.client import Client
from pmm.console.finished import Finished
from pmm.console.hub import Hub
from pmm.console.loop_side import LoopSide
from pmm.console.messages import Notice, Reply
from pmm.console.pages import Pages
from pmm.console.plans import Plans
from pmm.console.requests import TokenPosted
from pmm.console.security import COOKIE, Guard

PAGE: Final = Path(__file__).parent / "page"
_SESSION_LENGTH: Final = range(16, 65)
_WRONG_TOKEN_S: Final = 0.5


class Console:
    """The parts of a console that is being served."""

    def __init__(self, settings: Settings, connection: Connection, end: Callable[[], None]) -> None:
        self.door = settings.door
        self.hub = Hub(self._replied, self._written, _utc)
        self.loop = LoopSide(connection, self.hub.take, self._lost)
        self._end = end
        plans = Plans(settings.rig_path, settings.plans, settings.output)
        self.plans = plans
        self.actions = Actions(self.hub, self.loop, plans, settings.log_folder, _utc)
        self.finished = Finished(self.hub, settings.earlier, settings.reference)
        self.pages = Pages(self.actions.folders, settings.log_folder)

    def _replied(self, reply: Reply) -> None:
        self.loop.replied(reply)

    def _written(self, notice: Notice) -> None:
        if notice.folder is not None:
            self.finished.look_at(notice.folder)

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
        client = self.hub.join(session)
        sender = asyncio.ensure_future(_send(socket, client))
        try:
            while True:
                await socket.receive_text()
        except WebSocketDisconnect:
            pass
        finally:
            sender.cancel()
            self.hub.part(client)

    async def log_in(self, request: Request) -> Response:
        """Take the token and give a cookie for it."""
        try:
            posted = TokenPosted.model_validate_json(await body_of(request))
        except ValueError:
            return JSONResponse({"error": "no token"}, 422)
        cookie = self.door.log_in(posted.token)
        if cookie is None:
            await asyncio.sleep(_WRONG_TOKEN_S)
            return JSONResponse({"error": "this is not the token"}, 401)
        answer = JSONResponse({"said": "welcome"})
        answer.set_cookie(
            COOKIE, cookie, httponly=True, samesite="strict", secure=self.door.tls, path="/"
        )
        return answer

    async def offered(self, request: Request) -> Response:
        """Return the names of the plans."""
        return JSONResponse({"names": await asyncio.to_thread(self.plans.names)})

    async def listed(self, request: Request) -> Response:
        """Return the pages that the campaigns' folders hold."""
        return JSONResponse({"pages": await asyncio.to_thread(self.pages.listed)})

    async def leave(self) -> None:
        """Let go of what was started."""
        self.finished.close()
        await asyncio.sleep(0)


def application(settings: Settings, connection: Connection, end: Callable[[], None]) -> Guard:
    """Return the application; it is set up when its event loop runs.

    Parameters
    ----------
    end
        Called when the loop has ended: nothing is left to be shown.
    """

    @asynccontextmanager
    async def lifespan(app: Starlette) -> AsyncIterator[None]:
        console = Console(settings, connection, end)
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
        "/api/plans/check": act.check,
        "/api/plans/queue": act.queue,
        "/api/plans/drop": act.drop,
        "/login": console.log_in,
    }
    return [
        Route("/", _file("console.html")),
        Route("/login", _file("login.html")),
        Route("/api/plans", console.offered),
        Route("/api/pages", console.listed),
        Route("/pages/{folder:int}/{name}", console.pages.page),
        *(Route(path, action, methods=["POST"]) for path, action in posts.items()),
        WebSocketRoute("/stream", console.stream),
        Mount("/page", StaticFiles(directory=PAGE)),
        Mount("/charts", StaticFiles(directory=charts_folder())),
    ]


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


async def _send(socket: WebSocket, client: Client) -> None:
    while True:
        text = await client.next()
        if client.replaced:
            await socket.close(4001, "this session was opened in another window")
            return
        await socket.send_text(text)


def _utc() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds")
