"""The process that carries live values out, and the web server's end of it."""

import asyncio
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from multiprocessing import get_context
from multiprocessing.connection import Connection
from threading import Thread
from typing import Any, Final

from pmm.console.link import Link
from pmm.console.live.live_settings import OutletSettings
from pmm.console.live.outlet import Outlet, OutletStatus
from pmm.console.live.values import LiveTable, Tick
from pmm.console.messages import Frame, Hello, LoopMessage
from pmm.console.worker_process import yield_to_the_loop

SILENT_S: Final = 2.0  # without a tick: then nobody vouches for the values any more
_MOST_FRAMES: Final = 750  # 30 s: starting takes 1 to 10 s, and nothing is to be lost meanwhile
_TELL_S: Final = 1.0
_LOST: Final = "its process has ended, and nothing goes out any more; start the console anew"
_JOIN_S: Final = 3.0  # for a last word to the broker


class Publishing:
    """The server's end: hands ticks on and never waits; the oldest are dropped and counted."""

    def __init__(self, settings: OutletSettings) -> None:
        context = get_context("spawn")
        ours, theirs = context.Pipe()
        self._process = context.Process(
            target=carry_out, args=(theirs, settings), name="console live values", daemon=True
        )
        self._process.start()
        self._last: tuple[OutletStatus, ...] = ()
        theirs.close()
        self._link: Link[tuple[OutletStatus, ...]] = Link(ours, _MOST_FRAMES)

    def take(self, message: LoopMessage) -> None:
        """Hand on what the loop tells of itself."""
        if isinstance(message, Frame):
            self._link.frame(message)
        elif isinstance(message, Hello):
            self._link.tell(message)

    @property
    def pid(self) -> int:
        """The process that carries out."""
        return self._process.pid or 0

    @property
    def waiting(self) -> int:
        """Ticks that its process has not fetched yet."""
        return self._link.waiting

    def statuses(self) -> tuple[OutletStatus, ...]:
        """Return how the outlets are, if there is something new since the last call."""
        statuses = self._link.orders()
        if statuses:
            self._last = statuses[-1]
            return self._last
        if self._link.lost and any(status.connected or not status.trouble for status in self._last):
            self._last = tuple(
                replace(status, connected=False, trouble=_LOST) for status in self._last
            )
            return self._last
        return ()

    def close(self) -> None:
        """End the process, with a last word to the broker where that is quick."""
        self._link.close()
        self._process.join(_JOIN_S)
        if self._process.is_alive():
            self._process.kill()
            self._process.join()


def carry_out(connection: Connection, settings: OutletSettings) -> None:
    """Carry out what comes through the pipe until that is closed."""
    yield_to_the_loop()
    # Sockets are waited for by their numbers, which not every system's own event loop does.
    with asyncio.Runner(loop_factory=asyncio.SelectorEventLoop) as runner:
        runner.run(_carry_out(connection, settings))


def outlets_of(settings: OutletSettings) -> list[Outlet]:
    """Return an outlet for each protocol that is wished for."""
    from pmm.console.live.epics import EpicsOutlet
    from pmm.console.live.mqtt import MqttOutlet

    outlets: list[Outlet] = []
    if settings.broker is not None:
        outlets.append(MqttOutlet(settings.broker))
    if settings.epics_prefix:
        outlets.append(EpicsOutlet(settings.epics_prefix))
    return outlets


class _Source(Thread):
    """Offers what comes through the pipe to all outlets."""

    def __init__(self, connection: Connection, outlets: Sequence[Outlet]) -> None:
        super().__init__(name="live values", daemon=True)
        self._connection, self._outlets = connection, outlets
        self._table: LiveTable | None = None
        self._tick: Tick | None = None

    def run(self) -> None:
        with suppress(OSError, EOFError):
            while True:
                if self._connection.poll(SILENT_S):
                    self._take(self._connection.recv())
                elif self._tick is not None:
                    self._offer(self._tick.unknown())
                    self._tick = None

    def _take(self, message: Any) -> None:
        if isinstance(message, Hello):
            self._table = LiveTable(message)
        elif isinstance(message, Frame) and self._table is not None:
            self._tick = self._table.tick(message, time.time())
            self._offer(self._tick)

    def _offer(self, tick: Tick) -> None:
        for outlet in self._outlets:
            outlet.offer(tick)


async def _carry_out(connection: Connection, settings: OutletSettings) -> None:
    # aiomqtt waits for sockets that have just gone; whatever matters ends a task.
    asyncio.get_running_loop().set_exception_handler(lambda *_: None)
    outlets = outlets_of(settings)
    source = _Source(connection, outlets)
    source.start()
    tasks = [asyncio.ensure_future(outlet.run()) for outlet in outlets]
    try:
        while source.is_alive() and not any(task.done() for task in tasks):
            connection.send(tuple(outlet.status() for outlet in outlets))
            await asyncio.sleep(_TELL_S)
    except OSError:  # the server has gone
        pass
    finally:
        for task in tasks:
            task.cancel()
        outcomes = await asyncio.gather(*tasks, return_exceptions=True)
    for error in outcomes:
        if isinstance(error, Exception):
            raise error
