"""A Dask cluster on this computer, for as long as a test takes."""

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from benchmarks.workers import dask_workers


@contextmanager
def cluster(workers: int = 1) -> Iterator[str]:
    """Start some workers of one thread, and yield their scheduler's address."""
    pytest.importorskip("distributed")
    with dask_workers(workers) as started:
        yield started.scheduler_address
