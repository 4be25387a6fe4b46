"""The workers of a Dask cluster as an executor, and what is said where there is none.

A cluster runs already, or is made of jobs in the queue of Slurm, or of its like, for as long as a
command runs.
"""

import math
import re
import shutil
import signal
import threading
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

T = TypeVar("T")

_TIMEOUT: Final = "10s"  # for a scheduler to answer, and for its first worker
SENDING_S: Final = 4e-3  # of sender or scheduler for a message and its answer, see docs/parallel.md
_LOOK_S: Final = 5.0  # from one look at how many workers there are to the next
_KINDS: Final = {
    "slurm": "SLURMCluster", "pbs": "PBSCluster", "sge": "SGECluster", "lsf": "LSFCluster",
    "oar": "OARCluster", "moab": "MoabCluster",
}  # fmt: skip
# Of a worker's environment; docs/parallel.md says what each is for.
WORKER_ENVIRONMENT: Final = {
    "MALLOC_TRIM_THRESHOLD_": "134217728",
    "MALLOC_MMAP_THRESHOLD_": "33554432",
    "DASK_DISTRIBUTED__WORKER__PROFILE__ENABLED": "False",
}
_NAMED: Final = re.compile(rf"({'|'.join(_KINDS)}):(\d+)")


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
        """Close the connection to the cluster, as :meth:`Executor.shutdown` does."""
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
    specs = client.run(find_spec, module, on_error="return")
    lacking = sorted(worker for worker, spec in specs.items() if not isinstance(spec, ModuleSpec))
    if lacking:
        raise DataError(
            f"--scheduler {address}: {', '.join(lacking)} cannot import {module}; a cluster's "
            "workers need it in the same version"
        )


def is_queue(address: str) -> bool:
    """Tell a queue with a number of jobs, such as ``slurm:20``, from a scheduler's address."""
    return _NAMED.fullmatch(address) is not None


@contextmanager
def queued_jobs(address: str) -> Iterator[str]:
    """Submit jobs, yield the address of their scheduler, and cancel them at the end.

    Cores, memory, time and partition of a job are those of ``jobqueue.yaml`` in Dask's own folder
    of settings; each core gets a worker of one thread. Before what the settings have in front of
    the worker come the exports of :data:`WORKER_ENVIRONMENT`.

    Raises
    ------
    ConfigurationError
        If the extra ``queue`` or the queue's own commands are not there, the number of jobs is 0,
        or the settings lack cores or memory.
    DataError
        If the queue refuses a job.
    """
    match = _NAMED.fullmatch(address)
    assert match is not None  # noqa: S101 - whoever calls has asked is_queue
    name, jobs = match[1], int(match[2])
    if jobs < 1:
        raise ConfigurationError(f"--scheduler {address}: at least one job is needed")
    with _cluster(address, name) as cluster:
        try:
            cluster.sync(_submit, cluster, jobs)
        except RuntimeError as error:
            raise DataError(f"--scheduler {address}: a job was refused: {error}") from error
        yield cluster.scheduler_address


async def _submit(cluster: Any, jobs: int) -> None:
    """Submit, and wait for the queue's answers, which ``scale`` alone would only log."""
    from distributed.core import Status

    cluster.scale(jobs=jobs)
    try:
        await cluster._correct_state()
    finally:
        for job in cluster._created:  # what has not become a job cannot be cancelled
            if job.job_id is None:
                job.status = Status.failed


def _cluster(address: str, name: str) -> Any:
    interrupted = signal.getsignal(signal.SIGINT)
    try:
        jobqueue: Any = import_module("dask_jobqueue")
    except ImportError:
        raise ConfigurationError(
            f"--scheduler {address} needs the extra 'queue': {installing('queue')}"
        ) from None
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGINT, interrupted)  # which it makes an exit of this program's
    import dask

    kind, settings = getattr(jobqueue, _KINDS[name]), dask.config.get(f"jobqueue.{name}")
    submit = kind.job_cls.submit_command.split()[0]
    if shutil.which(submit) is None:
        raise ConfigurationError(
            f"--scheduler {address}: no command {submit} here; run this where jobs are submitted"
        )
    if lacking := [key for key in ("cores", "memory") if not settings[key]]:
        raise ConfigurationError(
            f"--scheduler {address}: state {' and '.join(lacking)} below jobqueue: {name}: in "
            "~/.config/dask/jobqueue.yaml (docs/parallel.md)"
        )
    # Of two schedulers on one machine each has a port.
    unseen = {"dashboard": False, "dashboard_address": ":0"}
    options = {**unseen, **settings["scheduler-options"]}
    exports = [f"export {name}={value}" for name, value in WORKER_ENVIRONMENT.items()]
    prologue = [*exports, *(settings.get("job-script-prologue") or [])]
    return kind(
        processes=settings["cores"], scheduler_options=options, job_script_prologue=prologue
    )
