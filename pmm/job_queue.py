"""A Dask cluster of jobs in the queue of Slurm, or of its like, for as long as a command runs."""

import re
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import Any, Final

from hardware.description.errors import ConfigurationError, DataError
from hardware.description.version import installing

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
    found = _NAMED.fullmatch(address)
    assert found is not None  # noqa: S101 - whoever calls has asked is_queue
    name, jobs = found[1], int(found[2])
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
    try:
        jobqueue: Any = import_module("dask_jobqueue")
    except ImportError:
        raise ConfigurationError(
            f"--scheduler {address} needs the extra 'queue': {installing('queue')}"
        ) from None
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
    options = {"dashboard": False, **settings["scheduler-options"]}
    exports = [f"export {name}={value}" for name, value in WORKER_ENVIRONMENT.items()]
    prologue = [*exports, *(settings.get("job-script-prologue") or [])]
    return kind(
        processes=settings["cores"], scheduler_options=options, job_script_prologue=prologue
    )
