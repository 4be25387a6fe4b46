"""What runs beside each other while the loop's latency is measured, each in its own process.

``python -m benchmarks.latency_child pmm FILE WORDS...``
    a command of pmm; how late each of its cycles began goes to FILE at the end.
``... bare FILE``
    a timer loop that does nothing, of the same period and priority.
``... disk FILE``
    writes and brings to the disk, without a pause.
``... watchers ADDRESS COUNT``
    as many streams of the console, each read as it comes and thrown away; says "ready" when all are
    there.

All end by Ctrl-C.
"""

import asyncio
import os
import sys
import time
from array import array
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Final

import numpy as np

from hardware.pacing import RealTime

PERIOD_S: Final = 0.01
_PIECE: Final = os.urandom(8 << 20)
_TOGETHER: Final = 8  # watchers that come at a time: the server ends requests that take too long
_AGAIN_S: Final = 0.5
_PIECES: Final = 16  # in a file, which is then written over


class Noted:
    """Notes when each cycle of a pacer was due, and how late it began, in seconds."""

    def __init__(self) -> None:
        self._found = array("d")

    def watch(self, pacer: type[RealTime]) -> None:
        """Note the cycles of all pacers of this kind."""
        wait = pacer.wait

        def noted(one: RealTime) -> float:
            late_s = wait(one)
            self._found.extend((time.monotonic(), late_s))
            return late_s

        pacer.wait = noted  # type: ignore[assignment, method-assign]

    def write(self, path: Path) -> None:
        """Write them, shape ``(cycles, 2)``."""
        np.save(path, np.array(self._found).reshape(-1, 2))


def _pmm(file: str, *words: str) -> None:
    from can.interfaces import BACKENDS

    from pmm.cli import cli

    BACKENDS.setdefault("pmm-simulated", ("sim.devices.bus", "SimulatedBus"))
    found = Noted()
    found.watch(RealTime)
    try:
        cli.main(args=list(words), prog_name="pmm")
    finally:
        found.write(Path(file))


def _bare(file: str) -> None:
    from pmm.real_time import before_others

    found = Noted()
    found.watch(RealTime)
    pacer = RealTime(PERIOD_S, time.monotonic, time.sleep)
    with before_others(), suppress(KeyboardInterrupt):
        while True:
            pacer.wait()
    found.write(Path(file))


def _disk(file: str) -> None:
    with Path(file).open("wb", buffering=0) as out, suppress(KeyboardInterrupt):
        while True:
            out.seek(0)
            for _ in range(_PIECES):
                out.write(_PIECE)
                os.fsync(out.fileno())


def _watchers(address: str, count: str) -> None:
    with suppress(KeyboardInterrupt):
        asyncio.run(_watch(address, int(count)))


async def _watch(address: str, count: int) -> None:
    """Watch; say ``ready`` once all are there. One that is sent away comes again."""
    from websockets.asyncio.client import connect
    from websockets.exceptions import WebSocketException

    there = asyncio.Semaphore(0)
    coming = asyncio.Semaphore(_TOGETHER)

    async def one(number: int) -> None:
        url = f"{address.replace('http', 'ws')}/stream?session=light-socket-{number:04d}"
        while True:
            with suppress(OSError, WebSocketException):
                async with coming:
                    stream = await connect(url, origin=address, max_size=None)  # type: ignore[arg-type]
                there.release()
                async for _ in stream:
                    pass  # a browser would draw it, elsewhere
            await asyncio.sleep(_AGAIN_S)

    async with asyncio.TaskGroup() as group:
        for number in range(count):
            group.create_task(one(number))
        for _ in range(count):
            await there.acquire()
        sys.stdout.write("ready\n")
        sys.stdout.flush()


_MODES: Final[dict[str, Callable[..., None]]] = {
    "pmm": _pmm,
    "bare": _bare,
    "disk": _disk,
    "watchers": _watchers,
}

if __name__ == "__main__":
    _MODES[sys.argv[1]](*sys.argv[2:])
