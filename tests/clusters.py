"""A Dask cluster on this computer, for as long as a test takes."""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager

import pytest


@contextmanager
def cluster(workers: int = 1) -> Iterator[str]:
    """Start some workers of one thread, and yield their scheduler's address."""
    distributed = pytest.importorskip("distributed")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # distributed's own, of ports and of killed workers
        with distributed.LocalCluster(
            n_workers=workers, threads_per_worker=1, host="127.0.0.1", dashboard_address=None
        ) as started:
            yield started.scheduler_address
