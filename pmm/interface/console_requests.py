"""What a program asks of a console over HTTP, and the stream that it opens, as its page does."""

import json
import ssl
from pathlib import Path
from typing import Any, Final, TypeAlias
from urllib.error import HTTPError, URLError
from urllib.request import HTTPCookieProcessor, HTTPSHandler, Request, build_opener

from websockets.exceptions import WebSocketException
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin

from hardware.description.errors import ConfigurationError, PmmError

Message: TypeAlias = dict[str, Any]
_ANSWER_S: Final = 630.0  # the console itself ends a check after 600 s


class ConsoleRefusalError(PmmError):
    """The console, or the rig behind it, does not do what was asked; the text says why."""


class ConsoleRequests:
    """Asks one console, with the cookie that a token gives and the session that has control.

    Attributes
    ----------
    url
        Of the console, without a slash at its end.
    secure
        What a connection is held against; ``None`` without TLS.
    session
        As the stream has told; empty before.

    Raises
    ------
    ConsoleRefusalError
        By each request that the console refuses.
    ConfigurationError
        If no console answers, or a token is needed.
    """

    def __init__(self, url: str, certificate: str | Path | None) -> None:
        self.url, self.session = url, ""
        self.secure: ssl.SSLContext | None = None
        if url.startswith("https:"):
            file = None if certificate is None else str(certificate)
            try:
                self.secure = ssl.create_default_context(cafile=file)
            except OSError as error:
                raise ConfigurationError(f"{file}: no certificate: {error}") from None
        handler = HTTPCookieProcessor()
        self._opener = build_opener(handler, HTTPSHandler(context=self.secure))
        self._jar = handler.cookiejar

    def stream(self, patience_s: float) -> ClientConnection:
        """Open the stream; raises ConfigurationError where no console lets the program in."""
        cookies = "; ".join(f"{cookie.name}={cookie.value}" for cookie in self._jar)
        try:
            return connect(
                self.url.replace("http", "ws", 1) + "/stream",
                origin=Origin(self.url),
                additional_headers={"cookie": cookies} if cookies else None,
                ssl=self.secure,
                max_size=None,
                open_timeout=patience_s,
                proxy=None,
            )
        except (OSError, WebSocketException) as error:
            raise ConfigurationError(
                f"{self.url}: no console that lets this program in ({error}); is its address "
                "right, and is a token needed?"
            ) from None

    def ask(self, path: str, body: Message | None = None) -> dict[str, Any]:
        """Post a body, or get without one, and return the answer; raises as the class says."""
        headers = {"origin": self.url, "x-pmm-session": self.session}
        data = None if body is None else json.dumps(body).encode()
        try:
            request = Request(self.url + path, data, headers)  # noqa: S310 - the user's console
            with self._opener.open(request, timeout=_ANSWER_S) as answer:
                content: dict[str, Any] = json.loads(answer.read())
                return content
        except HTTPError as error:
            text = error.read().decode("utf-8", "replace")
            if error.code == 401:
                raise ConfigurationError(f"{self.url}: {_error(text)}; give the token") from None
            raise ConsoleRefusalError(_error(text)) from None
        except (URLError, ValueError) as error:
            raise ConfigurationError(f"{self.url}: no console answers ({error})") from None


def _error(text: str) -> str:
    try:
        return str(json.loads(text)["error"])
    except (ValueError, KeyError, TypeError):
        return text.strip()
