"""The control loop before everything else that wants the processor."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from enum import StrEnum
from typing import Final

_LEVEL: Final = 10  # of 1 to 99: above all ordinary programs, below the kernel's own threads
_NICE: Final = -10


class Priority(StrEnum):
    """What the operating system allows."""

    REAL_TIME = "real time"
    RAISED = "raised"
    ORDINARY = "ordinary"


ADVICE: Final = (
    "the control loop runs at {} priority: what else runs here can make its cycles late. Allow "
    f"real-time priority ('* - rtprio {_LEVEL}' in /etc/security/limits.conf, then log in anew)"
)


@contextmanager
def before_others() -> Iterator[Priority]:
    """Let this thread, and those that it starts, go before everything else.

    Threads of one process share an interpreter: one that is held up while it has the interpreter's
    lock holds up the loop. So the loop's helpers are raised with it. Processes that are to stay
    ordinary must be started before.
    """
    found = _raise()
    try:
        yield found
    finally:
        if found is Priority.REAL_TIME:
            os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
        elif found is Priority.RAISED:
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
