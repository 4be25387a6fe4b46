"""The workers of a Dask cluster as an executor, and what is said where there is none."""

import math
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError, Executor, Future
from contextlib import contextmanager
from importlib import import_module
from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from typing import Any, Final, TypeVar

from hardware.description.errors import ConfigurationError, DataError
from hardware.description.version import installing
from pmm.job_queue import is_queue, queued_jobs

T = TypeVar("T")

_TIMEOUT: Final = "10s"  # for a scheduler to answer, and for its first worker
SENDING_S: Final = 4e-3  # of sender or scheduler for a message and its answer, see docs/parallel.md
_LOOK_S: Final = 5.0  # from one look at how many workers there are to the next


class ClusterWorkers(Executor):
    """The workers of a Dask cluster; those that come later work too.

    Parameters
    ----------
    client
        A ``distributed.Client``.

    Attributes
    ----------
    client
        The same.
    """

    def __init__(self, client: Any) -> None:
        self.client, self._executor = client, client.get_executor(pure=False)
        self._workers, self._looked_s = 0, -math.inf

    @property
    def workers(self) -> int:
        """How many threads the cluster's workers have together, as of the last seconds."""
        if time.monotonic() > self._looked_s + _LOOK_S:
            self._workers = sum(self.client.ncores().values())
            self._looked_s = time.monotonic()
        return max(1, self._workers)

    @property
    def round_s(self) -> float:
        """How long sender and scheduler need for a message to each worker, with its answer."""
        return self.workers * SENDING_S

    def submit(self, fn: Callable[..., T], /, *args: Any, **kwargs: Any) -> Future[T]:
        """Send a task; its result comes through the future that is returned."""
        future: Future[T] = self._executor.submit(fn, *args, **kwargs)
        return future

    def map(self, fn: Callable[..., T], *iterables: Iterable[Any], **options: Any) -> Iterator[T]:
        """Yield results in the order of the tasks."""
        results: Iterator[T] = self._executor.map(fn, *iterables, **options)
        return results

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Let go of the cluster."""
        self._executor.shutdown(wait=wait, cancel_futures=cancel_futures)


@contextmanager
def cluster(address: str, module: str) -> Iterator[Executor]:
    """Open the workers of a cluster; raises as :func:`pmm.parallel.open_executor` says."""
    if is_queue(address):
        with queued_jobs(address) as started, _workers_of(started, module, None) as executor:
            yield executor
        return
    with _workers_of(address, module, _TIMEOUT) as executor:
        yield executor


@contextmanager
def _workers_of(address: str, module: str, patience: str | None) -> Iterator[Executor]:
    """Open a scheduler's workers; the first may take so long to come, ``None`` without end."""
    try:
        distributed: Any = import_module("distributed")
    except ImportError:
        raise ConfigurationError(
            f"--scheduler needs the extra 'cluster': {installing('cluster')}"
        ) from None
    try:
        client = distributed.Client(address, timeout=_TIMEOUT, set_as_default=False, name="pmm")
    except (OSError, ValueError) as error:
        raise DataError(
            f"--scheduler {address}: no Dask scheduler answers there within {_TIMEOUT} ({error}); "
            "start one with 'dask scheduler', or leave the option out"
        ) from None
    try:
        _wait_for_a_worker(client, address, patience)
        _check_workers(client, address, module)
        yield ClusterWorkers(client)
    except CancelledError:
        raise DataError(
            f"--scheduler {address}: the scheduler ended, or was told to give the work up"
        ) from None
    except distributed.KilledWorker as error:
        raise DataError(
            f"--scheduler {address}: a task's workers died again and again: {error}"
        ) from error
    finally:
        client.close()


def _wait_for_a_worker(client: Any, address: str, patience: str | None) -> None:
    """Refuse a scheduler without workers: it keeps tasks for as long as none comes."""
    try:
        client.wait_for_workers(1, timeout=patience)
    except TimeoutError:
        raise DataError(
            f"--scheduler {address}: no workers there within {patience}; start one with "
            f"'dask worker {address}'"
        ) from None


def _check_workers(client: Any, address: str, module: str) -> None:
    """Refuse workers that lack a module: one that is sent such a task ends without a word."""
    found = client.run(find_spec, module, on_error="return")
    lacking = sorted(worker for worker, has in found.items() if not isinstance(has, ModuleSpec))
    if lacking:
        raise DataError(
            f"--scheduler {address}: {', '.join(lacking)} cannot import {module}; a cluster's "
            "workers need it in the same version"
        )
