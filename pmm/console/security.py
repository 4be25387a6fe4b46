"""Who may talk to the console: hosts, origins, token. Pure ASGI, in front of everything else."""

import hmac
import secrets
from collections.abc import Awaitable, Callable, MutableMapping
from contextlib import suppress
from dataclasses import dataclass, field
from enum import StrEnum
from http.cookies import CookieError, SimpleCookie
from typing import Any, Final

from starlette.requests import ClientDisconnect

from hardware.description.errors import PmmError

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]
App = Callable[[Scope, Receive, Send], Awaitable[None]]

LOCAL: Final = ("127.0.0.1", "::1", "localhost")
COOKIE: Final = "pmm-console"
_OPEN: Final = ("/login", "/page/")  # what a browser without a token may load
_HEADERS: Final = (
    (
        b"content-security-policy",
        b"default-src 'self'; object-src 'none'; base-uri 'none'; frame-ancestors 'none'; "
        b"form-action 'self'",
    ),
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"same-origin"),
    (b"cross-origin-resource-policy", b"same-origin"),
    (b"cache-control", b"no-store"),
)


class NotInControlError(PmmError):
    """A session that only watches wants to act."""


class VisitorRole(StrEnum):
    """What a token lets its holder do."""

    WATCH = "watch"  # and stop quickly, as everybody may
    PROPOSE = "propose"  # changes of the queue besides, which whoever has control approves
    OPERATE = "operate"  # and take control


_MAY: Final = {VisitorRole.WATCH: "watching", VisitorRole.PROPOSE: "proposing"}


@dataclass(frozen=True)
class Visitor:
    """Who was let in.

    Attributes
    ----------
    name
        As given at the login; empty without.
    """

    role: VisitorRole = VisitorRole.OPERATE
    name: str = ""

    def require(self, least: VisitorRole) -> None:
        """Refuse who may do less.

        Raises
        ------
        NotInControlError
            If the token is for less.
        """
        roles = list(VisitorRole)
        if roles.index(self.role) < roles.index(least):
            raise NotInControlError(
                f"this token is for {_MAY[self.role]}; log in with the operators' (quick stop is "
                "always possible)"
            )


VISITOR: Final = "pmm.visitor"  # key of the scope
_STRANGER: Final = Visitor(VisitorRole.WATCH)


@dataclass
class Door:
    """What is asked of whoever comes.

    Attributes
    ----------
    host, port
        Where the console listens.
    token
        Of the operators; needed where it listens beyond this machine; empty for none.
    watch_token, propose_token
        Of those who only watch, and of those who propose changes too; empty for none.
    tls
        Whether it speaks HTTPS.
    """

    host: str
    port: int
    token: str = field(default="", repr=False)
    tls: bool = False
    watch_token: str = field(default="", repr=False)
    propose_token: str = field(default="", repr=False)
    _visitors: dict[str, Visitor] = field(default_factory=dict, repr=False)

    def log_in(self, token: str, name: str = "") -> tuple[str, Visitor] | None:
        """Return a cookie's value and who has it, for a right token."""
        roles = (
            (self.token, VisitorRole.OPERATE),
            (self.propose_token, VisitorRole.PROPOSE),
            (self.watch_token, VisitorRole.WATCH),
        )
        fit = [role for secret, role in roles if secret and _is_same(token, secret)]
        if not fit:
            return None
        value, visitor = secrets.token_urlsafe(32), Visitor(fit[0], name)
        self._visitors[value] = visitor
        return value, visitor

    def visitor(self, cookie: str) -> Visitor | None:
        """Return who has a cookie of ours, or anybody where none is needed."""
        return self._visitors.get(cookie) if self.token else Visitor()

    def is_host(self, host: str) -> bool:
        """Whether a request means this machine: a foreign name that points here is refused.

        Beyond this machine the token guards; the names by which it is known there are not ours to
        say.
        """
        if self.token:
            return bool(host)
        return host in {f"{name}:{self.port}" for name in (*LOCAL, f"[{LOCAL[1]}]")}

    def is_origin(self, origin: str, host: str) -> bool:
        """Whether a page of this console is asking."""
        return origin == f"{'https' if self.tls else 'http'}://{host}"


class Guard:
    """Refuses what :class:`Door` does not let in, and adds the headers that keep pages apart."""

    def __init__(self, app: App, door: Door) -> None:
        self._app, self._door = app, door

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let a request through, or answer it here."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        refusal = self._refusal(scope)
        if refusal is None:
            with suppress(ClientDisconnect):  # nobody is there to be answered
                await self._app(scope, receive, _with_headers(send))
        elif scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": 1008, "reason": refusal[1]})
        else:
            await _answer(_with_headers(send), *refusal)

    def _refusal(self, scope: Scope) -> tuple[int, str] | None:
        """Return status and reason, or ``None`` to let it in."""
        headers = {
            key.decode("latin-1"): value.decode("latin-1") for key, value in scope["headers"]
        }
        host = headers.get("host", "")
        if not self._door.is_host(host):
            return 421, f"this console is not called {host!r}; open it by its own address"
        acts = scope["type"] == "websocket" or scope["method"] not in ("GET", "HEAD")
        origin = headers.get("origin")
        if (acts or origin is not None) and not self._door.is_origin(origin or "", host):
            return 403, f"origin {origin!r} is refused; only this console's own page may ask"
        visitor = self._door.visitor(_cookie(headers))
        scope[VISITOR] = visitor or _STRANGER
        if visitor is None and not _is_open(scope["path"]):
            if scope["type"] == "http" and scope["path"] == "/":
                return 303, "/login"
            return 401, "token needed: log in at /login"
        return None


def _is_same(text: str, reference: str) -> bool:
    return hmac.compare_digest(text.encode(), reference.encode())


def _is_open(path: str) -> bool:
    return path == _OPEN[0] or path.startswith(_OPEN[1])


def _cookie(headers: dict[str, str]) -> str:
    try:
        cookie = SimpleCookie(headers.get("cookie", "")).get(COOKIE)
    except CookieError:
        return ""
    return cookie.value if cookie is not None else ""


def _with_headers(send: Send) -> Send:
    async def sent(message: MutableMapping[str, Any]) -> None:
        if message["type"] == "http.response.start":
            names = {key for key, _ in message.get("headers", ())}
            more = [header for header in _HEADERS if header[0] not in names]
            message["headers"] = [*message.get("headers", ()), *more]
        await send(message)

    return sent


async def _answer(send: Send, status: int, text: str) -> None:
    headers = [(b"content-type", b"text/plain; charset=utf-8")]
    if status == 303:
        headers.append((b"location", text.encode()))
    await send({"type": "http.response.start", "status": status, "headers": headers})
    await send({"type": "http.response.body", "body": text.encode()})
