"""Jobs on some processes: what fails or hangs is named, and all others go on.

``concurrent.futures`` gives up the whole pool with a process that dies, and cannot end one that
hangs. Here each process has a pipe of its own, gets one job at a time, and is replaced when it dies
or overruns its limit.
"""

import os
import signal
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.connection import Connection, wait
from typing import TYPE_CHECKING, Generic, TypeVar

if TYPE_CHECKING:
    from multiprocessing.process import BaseProcess

JobT = TypeVar("JobT")
ValueT = TypeVar("ValueT")

_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


@dataclass(frozen=True)
class Done(Generic[JobT, ValueT]):
    """A job that came to its end.

    Attributes
    ----------
    value
        What it returned; ``None`` where it failed.
    failed
        Why it failed; empty where it did not.
    """

    job: JobT
    value: ValueT | None
    failed: str = ""


def each(
    work: Callable[[JobT], ValueT],
    jobs: Sequence[JobT],
    workers: int,
    limit_s: float | None = None,
) -> Iterator[Done[JobT, ValueT]]:
    """Yield each job as it ends, in no order.

    Parameters
    ----------
    work
        A function of a module, called with one job at a time in a process with one thread.
    limit_s
        Seconds that a job may take before its process is ended; no limit if ``None``, and one
        worker without a limit is this process itself.
    """
    if workers == 1 and limit_s is None:
        for job in jobs:
            yield Done(job, *_tried(work, job))
        return
    hands: list[_Hand[JobT, ValueT]] = []
    try:
        hands += [_Hand(work) for _ in range(min(workers, len(jobs)))]
        yield from _handed_out(hands, list(reversed(jobs)), limit_s)
    finally:
        for hand in hands:
            hand.dismiss()


def _handed_out(
    hands: "list[_Hand[JobT, ValueT]]", waiting: list[JobT], limit_s: float | None
) -> Iterator[Done[JobT, ValueT]]:
    for hand in hands:
        hand.give(waiting.pop(), limit_s)
    while busy := [hand for hand in hands if hand.job is not None]:
        ready = wait([hand.pipe for hand in busy], _left(busy))
        for hand in busy:
            done = hand.taken(hand.pipe in ready)
            if done is not None:
                if waiting:
                    hand.give(waiting.pop(), limit_s)
                yield done


class _Hand(Generic[JobT, ValueT]):
    """One process, the pipe to it, and the job that it has."""

    def __init__(self, work: Callable[[JobT], ValueT]) -> None:
        self._work = work
        self.job: JobT | None = None
        self.ends_at: float | None = None
        self._limit_s: float | None = None
        self.pipe: Connection[object, tuple[ValueT | None, str] | None]
        self._process: BaseProcess
        self._start()

    def _start(self) -> None:
        context = get_context("spawn")
        self.pipe, theirs = context.Pipe()
        self._process = context.Process(target=_serve, args=(theirs, self._work), daemon=True)
        with _single_threaded():
            self._process.start()
        theirs.close()

    def give(self, job: JobT, limit_s: float | None) -> None:
        """Hand it a job; its time counts from when the process has begun with it."""
        self.job, self._limit_s, self.ends_at = job, limit_s, None
        self.pipe.send(job)

    def taken(self, ready: bool) -> "Done[JobT, ValueT] | None":
        """Return its job if that has come to an end, in whichever way."""
        assert self.job is not None
        done: Done[JobT, ValueT] | None = None
        if ready:
            done = self._heard(self.job)
        elif self.ends_at is not None and time.monotonic() >= self.ends_at:
            done = Done(self.job, None, "it took longer than it may")
            self._replace()
        if done is not None:
            self.job = None
        return done

    def _heard(self, job: JobT) -> "Done[JobT, ValueT] | None":
        """Return the job if what comes down the pipe ends it; else it has just begun."""
        try:
            said = self.pipe.recv()
        except (EOFError, ConnectionResetError):
            self._process.join()
            why = f"its process ended with {self._process.exitcode}"
            self._replace()
            return Done(job, None, why)
        if said is not None:
            return Done(job, *said)
        if self._limit_s is not None:
            self.ends_at = time.monotonic() + self._limit_s
        return None

    def _replace(self) -> None:
        self.dismiss()
        self._start()

    def dismiss(self) -> None:
        """End the process."""
        self.pipe.close()
        self._process.kill()
        self._process.join()
        self._process.close()


def _tried(work: Callable[[JobT], ValueT], job: JobT) -> tuple[ValueT | None, str]:
    try:
        return work(job), ""
    except Exception as error:  # whatever it is, whoever gave the job is told
        return None, f"{type(error).__name__}: {error}"


def _left(busy: "Sequence[_Hand[JobT, ValueT]]") -> float | None:
    """Return the seconds until the first of some jobs overruns; ``None`` if none can."""
    ends = [hand.ends_at for hand in busy if hand.ends_at is not None]
    return max(min(ends) - time.monotonic(), 0.0) if ends else None


@contextmanager
def _single_threaded() -> Iterator[None]:
    """Leave the cores to the processes that start meanwhile: threads would only take turns."""
    before = {name: os.environ.get(name) for name in _THREADS}
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


def _serve(
    pipe: "Connection[tuple[ValueT | None, str] | None, JobT]", work: Callable[[JobT], ValueT]
) -> None:
    """Do what comes down the pipe until it is closed."""
    # Whoever presses Ctrl-C ends the board; this process ends with it, and without a traceback.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    while True:
        try:
            job = pipe.recv()
        except EOFError:
            return
        pipe.send(None)  # begun
        pipe.send(_tried(work, job))
