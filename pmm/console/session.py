"""The console runs: the rig is open, the web server in a process beside it, the loop goes round."""

import signal
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from functools import partial
from multiprocessing import get_context
from multiprocessing.connection import Connection
from pathlib import Path
from socket import socket
from typing import TYPE_CHECKING, Final, cast

from hardware.description.version import program
from hardware.pacing import RealTime
from hardware.wall_clock import utc_now
from pmm.console.answers import BrowserAnswers
from pmm.console.app_settings import ConsoleSettings
from pmm.console.limits import LARGEST_HEADERS, LARGEST_MESSAGE
from pmm.console.link import Link
from pmm.console.pacing import CountingPacer
from pmm.console.quick_stop import QuickStop
from pmm.console.request import ConsoleRequest
from pmm.console.station import Station
from pmm.plan.rig_file import RigFile
from pmm.real_time import Priority, step_back
from pmm.run.journal import Taps
from pmm.run.operator import Interrupts
from pmm.run.session import keep_time, tapped_rig

if TYPE_CHECKING:
    import asyncio

    import uvicorn

    from pmm.console.messages import LoopOrder
    from pmm.console.security import Guard

_WINDOW_S: Final = 10.0  # of the statistics of the loop's cycles
_JOIN_S: Final = 10.0
Tell = Callable[[str], object]


@contextmanager
def station_of(request: ConsoleRequest, rig_file: RigFile, tell: Tell) -> Iterator[Station]:
    """Open a rig under the console, its page served by another process.

    Parameters
    ----------
    tell
        Says what is to be known besides.

    Raises
    ------
    ConfigurationError
        If it cannot listen where it is asked to.
    """
    with ExitStack() as stack:
        listening = stack.enter_context(request.listening())
        quick_stop = QuickStop()
        connection = stack.enter_context(_server(request, rig_file, listening, quick_stop, tell))
        yield stack.enter_context(_station(request, rig_file, connection, quick_stop, tell))


def run_loop(station: Station, interrupts: Interrupts, tell: Tell) -> None:
    """Step until Ctrl-C, and then until everything rests."""
    is_told = False
    while True:
        station.step()
        interrupts.hand_on(station.control.request)
        if interrupts.heard and station.at_rest:
            return
        if station.deserted and not is_told:
            is_told = True
            tell("the web server has ended; the rig runs on. Ctrl-C stops it")


@contextmanager
def _server(
    request: ConsoleRequest,
    rig_file: RigFile,
    listening: socket,
    quick_stop: QuickStop,
    tell: Tell,
) -> Iterator[Connection]:
    """Start the server's process; end it when the loop has ended."""
    settings = request.settings(rig_file, listening.getsockname()[1])
    context = get_context("spawn")
    ours, theirs = context.Pipe()
    files = [None if name is None else Path(name) for name in (request.certificate, request.key)]
    process = context.Process(
        target=serve, args=(settings, listening, theirs, quick_stop, *files), name="console server"
    )
    process.start()
    theirs.close()
    for line in request.greeting(rig_file.name, settings.door):
        tell(line)
    try:
        yield ours
    finally:
        ours.close()
        process.join(_JOIN_S)
        if process.is_alive():
            process.kill()
            process.join()


@contextmanager
def _station(
    request: ConsoleRequest,
    rig_file: RigFile,
    connection: Connection,
    quick_stop: QuickStop,
    tell: Tell,
) -> Iterator[Station]:
    period_s = 1.0 / rig_file.sample_rate_hz / request.speed
    pacer = CountingPacer(
        RealTime(period_s, time.monotonic, time.sleep), period_s, round(_WINDOW_S / period_s)
    )
    taps, answers = Taps(), BrowserAnswers()
    with ExitStack() as stack:
        priority = _priority(stack, request.speed, tell)
        link: Link[LoopOrder] = Link(connection)
        stack.callback(link.close)
        closing = ThreadPoolExecutor(1, thread_name_prefix="closing", initializer=step_back)
        executor = stack.enter_context(closing)
        rig = stack.enter_context(tapped_rig(rig_file, pacer, answers, taps))
        rig.prepare()
        for note in rig.notes:
            tell(f"note: {note}")
        station = Station(
            rig, rig_file, link, quick_stop, answers, pacer, taps, time.monotonic, utc_now,
            {"program": program()}, executor, request.speed,
        )  # fmt: skip
        link.tell(replace(station.hello(), priority=str(priority)))
        yield station
        for line in station.close():
            tell(line)


def _priority(stack: ExitStack, speed: float, tell: Tell) -> Priority:
    """Put the loop first; one that runs faster than the clock would leave nothing to others."""
    if speed != 1.0:
        return Priority.ORDINARY
    timing = keep_time(stack)
    if timing.advice:
        tell(timing.advice)
    return timing.priority


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
        proxy_headers=False,  # who asks is whoever is connected, not whom a header names
        timeout_graceful_shutdown=2,
        ssl_certfile=certificate,
        ssl_keyfile=key,
    )
