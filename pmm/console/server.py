"""The web server's process."""

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing.connection import Connection
from pathlib import Path
from socket import socket

from pmm.console.app_settings import Settings


def serve(
    settings: Settings,
    listening: socket,
    connection: Connection,
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

    configuration = uvicorn.Config(
        application(settings, connection, end),
        ws="websockets-sansio",
        ws_per_message_deflate=False,
        ws_max_size=1 << 16,
        log_level="warning",
        access_log=False,
        server_header=False,
        timeout_graceful_shutdown=2,
        ssl_certfile=certificate,
        ssl_keyfile=key,
    )
    server = Server(configuration)
    asyncio.run(server.serve(sockets=[listening]))
