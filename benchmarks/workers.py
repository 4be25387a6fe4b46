"""Dask workers on this computer, for as long as they are needed."""

import logging
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from pmm.cluster import WORKER_ENVIRONMENT


@contextmanager
def dask_workers(count: int, *, apart: bool = False) -> Iterator[Any]:
    """Start some workers of one thread each, and yield their cluster; it needs ``distributed``.

    Parameters
    ----------
    apart
        Whether the scheduler too has a process of its own.
    """
    import distributed
    import pytest
    from distributed.deploy.subprocess import SubprocessCluster

    kind: Any = SubprocessCluster if apart else distributed.LocalCluster
    with pytest.MonkeyPatch.context() as patch, warnings.catch_warnings():
        for name, value in WORKER_ENVIRONMENT.items():
            patch.setenv(name, value)
        warnings.simplefilter("ignore")  # distributed's own, of ports and of killed workers
        with kind(
            n_workers=count, threads_per_worker=1, host="127.0.0.1", dashboard_address=None,
            silence_logs=logging.CRITICAL,
        ) as started:  # fmt: skip
            yield started
