"""Keeps the coefficients up to date: one calculation at a time, in a process of its own."""

import asyncio
from pathlib import Path

from pmm.console.figures import figures_of
from pmm.console.hub import Hub
from pmm.console.worker_process import NotWorkedOutError, WorkerProcess


class CoefficientUpdates:
    """Works coefficients out when runs end.

    What comes while a calculation runs is taken together in the next one.

    Parameters
    ----------
    earlier, reference
        What is shown beside; see :func:`pmm.console.figures.figures_of`.
    """

    def __init__(
        self, hub: Hub, worker: WorkerProcess, earlier: tuple[Path, ...], reference: Path | None
    ) -> None:
        self._worker = worker
        self._hub, self._earlier, self._reference = hub, earlier, reference
        self._folders: dict[Path, None] = {}
        self._again = False
        self._task: asyncio.Task[None] | None = None

    def look_at(self, folder: Path) -> None:
        """Take a campaign's folder in, or look at it again."""
        self._folders[folder] = None
        self._again = True
        if self._task is None or self._task.done():
            self._task = asyncio.get_running_loop().create_task(self._work())

    def close(self) -> None:
        """Cancel the calculation of coefficients, if one is under way."""
        if self._task is not None:
            self._task.cancel()

    async def _work(self) -> None:
        while self._again:
            self._again = False
            arguments = tuple(self._folders), self._earlier, self._reference
            try:
                figures = await self._worker.run(figures_of, *arguments)
            except NotWorkedOutError as error:
                figures = {"points": [], "problems": [str(error)]}
            except (ArithmeticError, LookupError, TypeError, ValueError) as error:
                figures = {"points": [], "problems": [f"coefficients: {error!r}"]}
            self._hub.tell_figures(figures)
