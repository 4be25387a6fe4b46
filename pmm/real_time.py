"""The control loop before everything else that wants the processor, with its memory at hand."""

import ctypes
import gc
import os
import sys
from collections.abc import Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from enum import StrEnum
from typing import Final

_LEVEL: Final = 10  # of 1 to 99: above all ordinary programs, below the kernel's own threads
_NICE: Final = -10
# Seconds after which a thread hands the interpreter to the loop. Halved, drawing and writing take
# 3 % longer; doubled, the loop waits 1 ms for them.
_SWITCH_S: Final = 5e-4
_LOCK_ALL: Final = 1 | 2 | 4  # mlockall(2): MCL_CURRENT, MCL_FUTURE, MCL_ONFAULT


class Priority(StrEnum):
    """What the operating system allows."""

    REAL_TIME = "real time"
    RAISED = "raised"
    ORDINARY = "ordinary"


@dataclass(frozen=True)
class LoopScheduling:
    """What the operating system has granted to the loop.

    Attributes
    ----------
    memory_locked
        Whether what is in memory stays there, and is never fetched from a disk.
    """

    priority: Priority
    memory_locked: bool

    @property
    def advice(self) -> str:
        """What is missing and how to allow it, in a line; empty if nothing is."""
        missing, allow = [], []
        if self.priority is not Priority.REAL_TIME:
            missing.append(f"runs at {self.priority} priority")
            allow.append(f"'* - rtprio {_LEVEL}'")
        if not self.memory_locked:
            missing.append("may be moved out of memory")
            allow.append("'* - memlock unlimited'")
        if not missing:
            return ""
        return (
            f"the control loop {' and '.join(missing)}: what else runs here can make its cycles "
            f"late. Allow it ({' and '.join(allow)} in /etc/security/limits.conf, then log in anew)"
        )


@contextmanager
def before_others() -> Iterator[LoopScheduling]:
    """Let this thread, and those that it starts, go before everything else.

    Threads of one process share an interpreter: one that is held up while it has the interpreter's
    lock holds up the loop. So the loop's helpers are raised with it, one step below, and hand the
    interpreter over soon. What is loaded by then is not searched for garbage any more: that takes
    0.16 s at a time. Processes that are to stay ordinary must be started before.
    """
    before_s = sys.getswitchinterval()
    sys.setswitchinterval(_SWITCH_S)
    gc.collect()
    gc.freeze()
    priority, locked = _raise(), _lock_memory()
    try:
        yield LoopScheduling(priority, locked)
    finally:
        gc.unfreeze()
        sys.setswitchinterval(before_s)
        if locked:
            ctypes.CDLL(None).munlockall()
        if priority is Priority.REAL_TIME:
            os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
        elif priority is Priority.RAISED:
            os.setpriority(os.PRIO_PROCESS, 0, 0)


def step_back() -> None:
    """Let this thread go behind the loop, still before other programs."""
    if hasattr(os, "sched_getscheduler") and os.sched_getscheduler(0) == os.SCHED_FIFO:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(_LEVEL - 1))


def _raise() -> Priority:
    if not hasattr(os, "sched_setscheduler"):
        return Priority.ORDINARY
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(_LEVEL))
    except OSError:
        return _nice()
    return Priority.REAL_TIME


def _nice() -> Priority:
    try:
        os.setpriority(os.PRIO_PROCESS, 0, _NICE)
    except OSError:
        return Priority.ORDINARY
    return Priority.RAISED


def may_lock_memory() -> bool | None:
    """Tell whether no limit is set to the memory that is locked; ``None`` where none can be.

    Under a limit the first allocation beyond it would fail: in a run.
    """
    if sys.platform != "linux":
        return None
    import resource

    return resource.getrlimit(resource.RLIMIT_MEMLOCK)[0] == resource.RLIM_INFINITY


def _lock_memory() -> bool:
    """Keep in memory what is and comes there, if there is no limit to it; tell whether it is so."""
    return bool(may_lock_memory() and ctypes.CDLL(None).mlockall(_LOCK_ALL) == 0)


@contextmanager
def thread_beside(name: str, *, keeps_time: bool) -> Iterator[Executor | None]:
    """Give a thread that steps back for a loop that keeps time; a loop that does not may wait."""
    if not keeps_time:
        yield None
        return
    with ThreadPoolExecutor(1, thread_name_prefix=name, initializer=step_back) as executor:
        yield executor
