"""Numerical work spread over the cores of this machine, in threads of this process.

NumPy lets other threads run inside a loop over large arrays, so threads serve where the work is
such loops; nothing is copied or started anew as processes would.
"""

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

from hardware.description.errors import ConfigurationError

T = TypeVar("T")
S = TypeVar("S")

SETTING = "OMP_NUM_THREADS"
"""The setting that numerical libraries share. Processes that are one of several set it to 1
(``pmm.parallel``, Dask's workers), so no second one is needed."""


def cores() -> int:
    """Return how many cores this process may use."""
    affinity = getattr(os, "sched_getaffinity", None)  # not on every system
    return len(affinity(0)) if affinity is not None else os.cpu_count() or 1


def thread_count() -> int:
    """Return how many threads numerical work takes: ``OMP_NUM_THREADS``, or one for each core.

    Raises
    ------
    ConfigurationError
        If the setting is no whole number above 0.
    """
    stated = os.environ.get(SETTING, "").strip()
    if not stated:
        return cores()
    outermost = stated.partition(",")[0].strip()  # a list is one number for each level of nesting
    if not (outermost.isascii() and outermost.isdigit() and int(outermost) > 0):
        raise ConfigurationError(
            f"{SETTING} = {stated}: must be a whole number above 0; unset it for a thread a core"
        )
    return int(outermost)


def spread(work: Callable[[S], T], tasks: Sequence[S], threads: int | None = None) -> list[T]:
    """Do all tasks and return their results in the tasks' order.

    Each result is that of the task alone, so it is the same with any number of threads.

    Parameters
    ----------
    threads
        By default :func:`thread_count`. One, or a single task, is done in the calling thread.
    """
    count = min(thread_count() if threads is None else threads, len(tasks))
    if count <= 1:
        return [work(task) for task in tasks]
    pool = ThreadPoolExecutor(count, thread_name_prefix="numerical")
    try:
        return list(pool.map(work, tasks))
    finally:  # after an error or Ctrl-C what was not begun is not done
        pool.shutdown(cancel_futures=True)
