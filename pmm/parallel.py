"""Where work over many runs and trials is done: this process, local processes, or a Dask cluster.

All three are a ``concurrent.futures.Executor``; whoever has work calls ``executor.map`` and never
learns which it is. A task is a plain function of what can be pickled, and random numbers come from
the task's own number (``SeedSequence(seed, spawn_key=(i,))``), so that the results are the same on
every engine and with any number of workers. See ``docs/parallel.md``.
"""

import math
import os
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from itertools import islice
from multiprocessing import get_context
from pathlib import Path
from platform import node
from queue import SimpleQueue
from typing import Any, Final, Generic, TypeVar

from analysis.threads import SETTING, cores
from hardware.description.errors import ConfigurationError, DataError
from pmm.cluster import cluster
from pmm.remote import local_path

T = TypeVar("T")
S = TypeVar("S")

MOST_RESTARTS: Final = 10  # of a pool whose workers die: beyond it something is wrong with the work
_THREADS: Final = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", SETTING)
IN_HAND_EACH: Final = 3  # messages of a worker at a time: the one it does, and some that wait
MOST_TOGETHER: Final = 100  # tasks of a message: an interruption begins them again


@contextmanager
def open_executor(
    jobs: int | None = None, scheduler: str | None = None, *, module: str = __name__
) -> Iterator[Executor]:
    """Open an executor for the time of a ``with`` block; nothing is left running after it.

    Parameters
    ----------
    jobs
        Local processes; 1 works in this process, ``None`` takes one for each core.
    scheduler
        Address of a Dask scheduler, such as ``tcp://127.0.0.1:8786``, or a queue and the number of
        jobs to submit there, such as ``slurm:20``. Workers need this package, and the recordings
        under the same paths or by URL.
    module
        Where the tasks' function is, if it is no part of this package; a cluster's workers are
        asked whether they have it.

    Raises
    ------
    ConfigurationError
        If both are given, the number is below 1, or the extra ``cluster`` is not installed; or as
        :func:`pmm.cluster.queued_jobs`.
    DataError
        If no scheduler answers there or it has no workers, a worker lacks the module, the workers
        died again and again, or the scheduler ended.
    """
    if scheduler is not None and jobs is not None:
        raise ConfigurationError("give --jobs or --scheduler, not both: a cluster has its own size")
    if jobs is not None and jobs < 1:
        raise ConfigurationError(f"--jobs {jobs}: at least one process is needed")
    if scheduler is not None:
        with cluster(scheduler, module) as executor:
            yield executor
        return
    count = cores() if jobs is None else jobs
    local: Executor = InThisProcess() if count == 1 else LocalProcesses(count)
    try:
        yield local
    finally:
        local.shutdown(wait=True, cancel_futures=True)


def as_done(
    executor: Executor, work: Callable[[S], T], tasks: Iterable[S], most: int | None = None
) -> Iterator[T]:
    """Yield the results of tasks as they come, in no order; a slow task holds up no other.

    Parameters
    ----------
    work
        A function of a module, called with one task at a time.
    most
        Messages in hand at a time. By default :data:`IN_HAND_EACH` for each worker, as many as
        there are then: clusters grow. A message has one task, and of short tasks to many workers
        :func:`tasks_each`.
    """
    futures: SimpleQueue[Future[_BatchResult[T]]] = SimpleQueue()
    waiting, running = iter(tasks), 0
    count, work_s = 0, 0.0

    def results() -> Iterator[T]:
        nonlocal running, count, work_s
        outcome = futures.get().result()
        running -= 1
        count, work_s = count + len(outcome.results), work_s + outcome.work_s
        yield from outcome.results
        if outcome.error is not None:
            raise outcome.error

    while batch := list(islice(waiting, tasks_each(executor, work_s / count if count else None))):
        executor.submit(_each, work, batch).add_done_callback(futures.put)
        running += 1
        # What is done at once, as in this process, is yielded before the next task is begun.
        while not futures.empty() or running >= (most or in_hand(executor)):
            yield from results()
    while running:
        yield from results()


@dataclass(frozen=True)
class _BatchResult(Generic[T]):
    """What came of a message's tasks, up to the first that fails."""

    results: list[T]
    work_s: float
    error: Exception | None = None


def _each(work: Callable[[S], T], tasks: Sequence[S]) -> _BatchResult[T]:
    started = time.perf_counter()
    results: list[T] = []
    try:
        results.extend(map(work, tasks))
    except Exception as error:  # it belongs to whoever asks for the results
        return _BatchResult(results, time.perf_counter() - started, error)
    return _BatchResult(results, time.perf_counter() - started)


def tasks_each(executor: Executor, task_s: float | None) -> int:
    """Return how many tasks go in a message, so that who sends keeps pace with all workers.

    Parameters
    ----------
    task_s
        What a task takes on the mean; ``None`` before the first result.
    """
    round_s: float = getattr(executor, "round_s", 0.0)
    if task_s is None:
        return 1
    return max(1, math.ceil(min(MOST_TOGETHER, round_s / max(task_s, 1e-9))))


def in_hand(executor: Executor) -> int:
    """Return how many messages an executor's workers are to have at a time."""
    workers: int = getattr(executor, "workers", 1)
    return IN_HAND_EACH * workers


def task_folder(folder: Path) -> Path:
    """Return a task's folder as the process sees it that has the task.

    Raises
    ------
    DataError
        With the folder and the computer that does not see it.
    ConfigurationError, DataError
        As :func:`pmm.remote.local_path`, for what lies elsewhere.
    """
    folder = local_path(folder)
    if not folder.is_dir():
        raise DataError(
            f"{folder}: not there on {node()}; the workers of a cluster need it under the same path"
        )
    return folder


class InThisProcess(Executor):
    """An executor that does each task when it is asked for its result, one after the other."""

    def submit(self, fn: Callable[..., T], /, *args: Any, **kwargs: Any) -> Future[T]:
        """Do a task now and return it done."""
        future: Future[T] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:  # it belongs to whoever asks for the result
            future.set_exception(error)
        return future

    def map(
        self,
        fn: Callable[..., T],
        *iterables: Iterable[Any],
        timeout: float | None = None,
        chunksize: int = 1,
    ) -> Iterator[T]:
        """Yield results as they are asked for, so that no more than one is held."""
        return map(fn, *iterables)


class LocalProcesses(Executor):
    """Spawned processes; one that is killed costs the time of its tasks, not their results.

    A :class:`ProcessPoolExecutor` fails every task in hand when a worker dies. Here these tasks
    start again in new processes. Tasks have no effect but their result, so doing one twice is safe.

    Attributes
    ----------
    workers
        How many processes there are.
    """

    def __init__(self, jobs: int, most_restarts: int = MOST_RESTARTS) -> None:
        self._jobs = self.workers = jobs
        self._left = most_restarts
        self._lock = threading.Lock()
        self._pools = [self._new_pool()]  # the last one works, those before it are broken

    def submit(self, fn: Callable[..., T], /, *args: Any, **kwargs: Any) -> Future[T]:
        """Start a task; its result comes through the future that is returned."""
        outer: Future[T] = Future()
        self._start(outer, partial(fn, *args, **kwargs))
        return outer

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End the processes, those of broken pools too."""
        with self._lock:
            self._left = 0
            pools = list(self._pools)
        for pool in pools:
            pool.shutdown(wait=wait, cancel_futures=cancel_futures)

    def _new_pool(self) -> ProcessPoolExecutor:
        return ProcessPoolExecutor(self._jobs, get_context("spawn"), initializer=one_thread)

    def _start(self, outer: Future[T], work: Callable[[], T]) -> None:
        # The lock is never held while a pool is spoken to: a pool that breaks calls back from a
        # thread that holds the pool's own lock.
        with self._lock:
            pool = self._pools[-1]
        try:
            inner = pool.submit(work)
        except BrokenProcessPool:
            self._restart(outer, work, pool)
            return
        inner.add_done_callback(lambda future: self._settle(outer, work, pool, future))

    def _settle(
        self, outer: Future[T], work: Callable[[], T], pool: ProcessPoolExecutor, inner: Future[T]
    ) -> None:
        if inner.cancelled():
            outer.cancel()
            return
        error = inner.exception()
        if isinstance(error, BrokenProcessPool):
            self._restart(outer, work, pool)
        elif not outer.set_running_or_notify_cancel():
            return
        elif error is not None:
            outer.set_exception(error)
        else:
            outer.set_result(inner.result())

    def _restart(self, outer: Future[T], work: Callable[[], T], pool: ProcessPoolExecutor) -> None:
        with self._lock:
            if self._pools[-1] is pool and self._left > 0:
                self._left -= 1
                self._pools.append(self._new_pool())
            given_up = self._pools[-1] is pool
        if not given_up:
            self._start(outer, work)
        elif outer.set_running_or_notify_cancel():
            outer.set_exception(
                DataError(
                    "the worker processes ended again and again without being asked to (out of "
                    "memory, or killed); take fewer with --jobs, 1 for none"
                )
            )


def one_thread() -> None:
    """Let numerical libraries use one thread in this process: its siblings have the other cores.

    Acts if it is called before they are loaded.
    """
    for name in _THREADS:
        os.environ.setdefault(name, "1")
