"""Work that may take long or all memory, in a process of its own: the server never waits."""

import asyncio
import os
import signal
import threading
import time
from collections.abc import Awaitable, Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context, parent_process
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnProcess
from typing import Any, Final, Generic, ParamSpec, TypeVar

from analysis.process_memory import limit_memory
from hardware.description.errors import PmmError
from pmm.console.limits import CHECK_MEMORY, CHECK_S, MOST_CHECKS

P = ParamSpec("P")
T = TypeVar("T")
_NICE: Final = 10  # the control loop and the server go first
# So many times its processor time work may take by the clock: others leave it a tenth to a half.
BY_THE_CLOCK: Final = 5.0
_GONE_S: Final = 1.0  # for a process whose end of the pipe is closed
_LOOK_S: Final = 0.1  # between two looks at the processor time
_TOO_LONG: Final = 124  # exit status of a process that took too much of it, as of timeout(1)
_MIB: Final = 1 << 20


class BusyError(PmmError):
    """Others are waiting for the same kind of work, as many as may wait."""


class NotWorkedOutError(PmmError):
    """Work took too long or too much memory, or ended its process."""


@dataclass(frozen=True)
class WorkLimits:
    """What work may take.

    Attributes
    ----------
    seconds
        Of the processor: a machine that is busy otherwise does not count. By the clock
        :data:`BY_THE_CLOCK` times that.
    memory_bytes
        0 for any.
    waiting
        How many may be asked for at a time.
    """

    seconds: float
    memory_bytes: int
    waiting: int


class WorkerProcess:
    """Does one piece of work after the other in a process that is started with the first.

    Parameters
    ----------
    what
        What it does, for messages.
    """

    def __init__(self, name: str, bounds: WorkLimits) -> None:
        self._what, self._bounds = name, bounds
        self._waiting, self._closed = 0, False
        self._thread: ThreadPoolExecutor | None = None
        self._child: tuple[SpawnProcess, Connection] | None = None

    async def run(self, work: Callable[P, T], *arguments: P.args, **named: P.kwargs) -> T:
        """Return what a function of a module returns, or raise what it raises.

        Raises
        ------
        BusyError
            If too many wait.
        NotWorkedOutError
            If it takes more than it may, or ends its process.
        """
        if self._waiting >= self._bounds.waiting:
            raise BusyError(
                f"{self._what}: {self._waiting} wait already, which is the limit; ask again later"
            )
        if self._thread is None:
            self._thread = ThreadPoolExecutor(1, thread_name_prefix=self._what)
        self._waiting += 1
        asked = asyncio.get_running_loop().run_in_executor(
            self._thread, self._ask, work, arguments, named
        )
        asked.add_done_callback(self._end_request)
        result: T = await asyncio.shield(asked)
        return result

    def close(self) -> None:
        """End the process, whatever it is at."""
        self._closed = True
        if self._thread is None:
            return
        self._thread.shutdown(wait=False, cancel_futures=True)
        child = self._child
        if child is not None:
            child[0].kill()
        self._thread.shutdown()
        self._end()

    def _end_request(self, asked: "asyncio.Future[Any]") -> None:
        self._waiting -= 1
        if not asked.cancelled():
            asked.exception()  # whoever asked may have gone

    def _ask(self, work: Callable[..., T], arguments: Any, named: Any) -> T:
        """Ask the process; in the thread, which waits for it."""
        process, connection = self._child = self._child or _started(self._bounds)
        try:
            if self._closed:  # while it was being started
                process.kill()
            connection.send((work, arguments, named))
            if not connection.poll(BY_THE_CLOCK * self._bounds.seconds):
                self._end()
                raise NotWorkedOutError(
                    f"{self._what} took longer than {BY_THE_CLOCK * self._bounds.seconds:g} s and "
                    "was ended"
                )
            value, error = connection.recv()
        except (EOFError, OSError) as lost:
            process.join(_GONE_S)
            self._end()
            how = f"ended its process (status {process.exitcode})"
            if process.exitcode == _TOO_LONG:
                how = f"took more than {self._bounds.seconds:g} s of the processor and was ended"
            raise NotWorkedOutError(f"{self._what} {how}") from lost
        if isinstance(error, MemoryError):
            self._end()
            raise NotWorkedOutError(
                f"{self._what} took more than {self._bounds.memory_bytes / _MIB:g} MiB of memory"
            )
        if error is not None:
            raise error
        result: T = value
        return result

    def _end(self) -> None:
        if self._child is not None:
            process, connection = self._child
            self._child = None
            process.kill()
            process.join()
            connection.close()


def _started(bounds: WorkLimits) -> tuple[SpawnProcess, Connection]:
    context = get_context("spawn")
    ours, theirs = context.Pipe()
    process = context.Process(target=_work, args=(theirs, bounds), daemon=True)
    process.start()
    theirs.close()
    return process, ours


class _ProcessorTime(threading.Thread):
    """Ends the process when a piece of work takes too much of the processor."""

    def __init__(self, most_s: float) -> None:
        super().__init__(name="processor time", daemon=True)
        self._most_s = most_s
        self.began_s: float | None = None

    def run(self) -> None:
        while True:
            time.sleep(_LOOK_S)
            began_s = self.began_s
            if began_s is not None and time.process_time() - began_s > self._most_s:
                os._exit(_TOO_LONG)


def _work(connection: Connection, bounds: WorkLimits) -> None:
    """Do what is asked until nobody asks any more."""
    yield_to_the_loop()
    os.environ |= dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"), "1")
    limit_memory(bounds.memory_bytes)
    clock = _ProcessorTime(bounds.seconds)
    clock.start()
    while True:
        try:
            work, arguments, named = connection.recv()
        except EOFError:
            return
        result, error = None, None
        clock.began_s = time.process_time()
        try:
            result = work(*arguments, **named)
        except Exception as raised:
            error = raised.with_traceback(None)
        clock.began_s = None
        try:
            connection.send((result, error))
        except (TypeError, AttributeError, ValueError) as raised:  # it cannot be pickled
            connection.send((None, NotWorkedOutError(f"{error!r}: {raised}")))


def yield_to_the_loop() -> None:
    """Let the control loop and the server go first, and Ctrl-C be theirs; end with the server."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_the_server, name="server's end", daemon=True).start()
    if hasattr(os, "nice"):
        os.nice(_NICE)


def _end_with_the_server() -> None:
    """Leave nothing behind a server that was killed: nobody else would end this process."""
    server = parent_process()
    if server is not None:
        server.join()
        os._exit(1)


# Recordings are read there: they may be as large as the machine takes, and nobody but us asks.
_FIGURES: Final = WorkLimits(3600.0, 0, 1)
_CHECKS: Final = WorkLimits(CHECK_S, CHECK_MEMORY, MOST_CHECKS)


class Workers:
    """Processes beside the server; none is started before it is needed."""

    def __init__(self) -> None:
        self._control = WorkerProcess("checking plans", _CHECKS)
        self._watchers = WorkerProcess("checking plans of those who watch", _CHECKS)
        self.around = WorkerProcess("looking through the folders", _CHECKS)
        self.figures = WorkerProcess("coefficients", _FIGURES)

    def for_whom(self, *, in_control: bool) -> WorkerProcess:
        """Return who checks plans: nobody who watches holds up who has control."""
        return self._control if in_control else self._watchers

    def close(self) -> None:
        """End all worker processes."""
        for worker in (self._control, self._watchers, self.around, self.figures):
            worker.close()


class SharedAnswer(Generic[T]):
    """One answer for all who ask while another is worked out: every page asks when a run ends."""

    def __init__(self, ask: Callable[[], Awaitable[T]]) -> None:
        self._ask = ask
        self._present: asyncio.Future[T] | None = None
        self._next: asyncio.Future[T] | None = None

    async def get(self) -> T:
        """Return an answer that was begun after this question."""
        if self._next is None:
            self._next = asyncio.ensure_future(self._ask_after(self._present))
        return await asyncio.shield(self._next)

    async def _ask_after(self, before: "asyncio.Future[T] | None") -> T:
        if before is not None:
            await asyncio.wait([before])
        self._present, self._next = self._next, None
        return await self._ask()
