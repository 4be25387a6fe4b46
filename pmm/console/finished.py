"""Keeps the coefficients up to date: one calculation at a time, in a process of its own."""

import asyncio
from concurrent.futures import BrokenExecutor, ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

from pmm.console.figures import figures_of
from pmm.console.hub import Hub


class Finished:
    """Works coefficients out when runs end.

    What comes while a calculation runs is taken together in the next one.

    Parameters
    ----------
    earlier, reference
        What is shown beside; see :func:`pmm.console.figures.figures_of`.
    """

    def __init__(self, hub: Hub, earlier: tuple[Path, ...], reference: Path | None) -> None:
        self._hub, self._earlier, self._reference = hub, earlier, reference
        self._folders: dict[Path, None] = {}
        self._again = False
        self._task: asyncio.Task[None] | None = None
        self._pool: ProcessPoolExecutor | None = None

    def look_at(self, folder: Path) -> None:
        """Take a campaign's folder in, or look at it again."""
        self._folders[folder] = None
        self._again = True
        if self._task is None or self._task.done():
            self._task = asyncio.get_running_loop().create_task(self._work())

    def close(self) -> None:
        """End the calculation."""
        if self._task is not None:
            self._task.cancel()
        if self._pool is not None:
            self._pool.shutdown(wait=True, cancel_futures=True)

    async def _work(self) -> None:
        while self._again:
            self._again = False
            given = tuple(self._folders), self._earlier, self._reference
            try:
                loop = asyncio.get_running_loop()
                figures = await loop.run_in_executor(self._worker(), figures_of, *given)
            except BrokenExecutor as error:
                self._pool = None
                figures = {"points": [], "problems": [f"coefficients: {error}"]}
            except (ArithmeticError, LookupError, TypeError, ValueError) as error:
                figures = {"points": [], "problems": [f"coefficients: {error!r}"]}
            self._hub.figures = figures
            self._hub.broadcast({"type": "figures", "figures": figures})

    def _worker(self) -> ProcessPoolExecutor:
        if self._pool is None:
            self._pool = ProcessPoolExecutor(1, get_context("spawn"), _yield_to_the_loop)
        return self._pool


def _yield_to_the_loop() -> None:
    """Let the control loop and the server go first, and Ctrl-C be theirs; end with the server."""
    import os
    import signal
    import threading

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_the_server, name="server's end", daemon=True).start()
    if hasattr(os, "nice"):
        os.nice(10)


def _end_with_the_server() -> None:
    """Leave nothing behind a server that was killed: nobody else would end this process."""
    import os
    from multiprocessing import parent_process

    server = parent_process()
    if server is not None:
        server.join()
        os._exit(1)
