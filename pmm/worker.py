"""A thread for what a control loop must not wait for: a terminal, a disk."""

import queue
import threading
from collections.abc import Callable
from typing import TypeAlias

from pmm.real_time import step_back

Job: TypeAlias = Callable[[], object]


class Worker:
    """Does jobs one after the other in a thread of its own; who hands one over never waits.

    One thread hands over; where that goes before others, the worker goes one step behind it. After
    a job that fails the others are let go of, undone.

    Parameters
    ----------
    name
        Of the thread.

    Attributes
    ----------
    error
        What a job raised; ``None`` if none did.
    """

    def __init__(self, name: str) -> None:
        self.error: Exception | None = None
        self._jobs: queue.SimpleQueue[Job | threading.Event | None] = queue.SimpleQueue()
        # Each is written by one thread only, so that no count is lost between two.
        self._given = self._done = 0
        self._thread = threading.Thread(target=self._work, name=name, daemon=True)
        self._thread.start()

    @property
    def behind(self) -> int:
        """How many jobs are not done yet, the present one counted."""
        return self._given - self._done

    def do(self, job: Job) -> None:
        """Take a job that is to be done, however many wait."""
        self._given += 1
        self._jobs.put(job)

    def offer(self, job: Job, most: int) -> bool:
        """Take a job if fewer than ``most`` are not done yet; tell whether it was taken."""
        is_taken = self.behind < most
        if is_taken:
            self.do(job)
        return is_taken

    def wait(self) -> None:
        """Wait until what was handed over so far is done, or let go of."""
        reached = threading.Event()
        self._jobs.put(reached)
        reached.wait()

    def close(self) -> None:
        """Wait until all jobs are done and end the thread; may be repeated."""
        if self._thread.is_alive():
            self._jobs.put(None)
            self._thread.join()

    def _work(self) -> None:
        step_back()
        while (job := self._jobs.get()) is not None:
            if isinstance(job, threading.Event):
                job.set()
                continue
            if self.error is None:
                try:
                    job()
                except Exception as error:  # whoever handed it over learns of whatever it was
                    self.error = error
            self._done += 1
