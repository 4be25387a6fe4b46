"""The web server's process."""

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from multiprocessing.connection import Connection
from pathlib import Path
from socket import socket
from typing import TYPE_CHECKING, cast

from pmm.console.app_settings import ConsoleSettings
from pmm.console.limits import LARGEST_HEADERS, LARGEST_MESSAGE
from pmm.console.quick_stop import QuickStop

if TYPE_CHECKING:
    import asyncio

    import uvicorn

    from pmm.console.security import Guard


def serve(
    settings: ConsoleSettings,
    listening: socket,
    connection: Connection,
    quick_stop: QuickStop,
    certificate: Path | None,
    key: Path | None,
) -> None:
    """Serve until the loop's end of the pipe is closed.

    Ctrl-C is the loop's: it stops the rig first.
    """
    import asyncio

    import uvicorn

    from pmm.console.app import application

    signal.signal(signal.SIGINT, signal.SIG_IGN)

    class Server(uvicorn.Server):
        @contextmanager
        def capture_signals(self) -> Iterator[None]:
            yield

    def end() -> None:
        server.should_exit = True

    page = application(settings, connection, quick_stop, end)
    server = Server(_configuration(page, certificate, key))
    asyncio.run(server.serve(sockets=[listening]))


def _configuration(page: "Guard", certificate: Path | None, key: Path | None) -> "uvicorn.Config":
    """Return how the page is served: what comes is limited in size, number and time."""
    import uvicorn

    from pmm.console.connections import Connection, Crowd, PageStream

    return uvicorn.Config(
        page,
        ws=PageStream,
        ws_per_message_deflate=False,
        ws_max_size=LARGEST_MESSAGE,
        h11_max_incomplete_event_size=LARGEST_HEADERS,
        http=cast("type[asyncio.Protocol]", partial(Connection, Crowd())),
        log_level="warning",
        access_log=False,
        server_header=False,
        timeout_graceful_shutdown=2,
        ssl_certfile=certificate,
        ssl_keyfile=key,
    )
