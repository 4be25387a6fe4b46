"""Keeps the queue's journal as the queue is, one writing after the other."""

import asyncio
from collections.abc import Callable

from anyio.to_thread import run_sync

from pmm.console.queue_journal import KeptQueue, QueueJournal


class QueueKeeper:
    """Keeps the journal up to date from :meth:`begin` on: before it, what is kept is not all known.

    Parameters
    ----------
    state
        Returns what is to be kept.
    alarm
        Told why it cannot be written.
    """

    def __init__(
        self, journal: QueueJournal, state: Callable[[], KeptQueue], alarm: Callable[[str], None]
    ) -> None:
        self._journal, self._state, self._alarm = journal, state, alarm
        self._begun = self._again = False
        self._task: asyncio.Task[None] | None = None
        self._trouble = ""

    def read(self) -> KeptQueue:
        """Return what is kept; raises ConfigurationError as the journal does."""
        return self._journal.read()

    def begin(self) -> None:
        """Keep the present state, and each that follows."""
        self._begun = True
        self.note_change()

    def note_change(self) -> None:
        """Note that there is something to keep."""
        self._again = self._begun
        if self._begun and (self._task is None or self._task.done()):
            self._task = asyncio.get_running_loop().create_task(self._write())

    async def wait_written(self) -> str:
        """Wait until what was changed so far is on the disk; return why it is not, if it is not."""
        if self._task is not None:
            await asyncio.wait([self._task])
        return self._trouble

    async def _write(self) -> None:
        while self._again:
            self._again, self._trouble = False, ""
            try:
                await run_sync(self._journal.write, self._state())
            except OSError as error:
                self._trouble = f"the queue is not kept: {error}"
                self._alarm(self._trouble)
