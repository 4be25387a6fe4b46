"""The campaign's file, written anew after each run, beside the loop."""

from collections.abc import Callable
from concurrent.futures import Executor, Future, wait

from pmm.console.messages import WRITTEN, Notice, QueuedPlan
from pmm.plan.campaign_writer import write_campaign
from pmm.plan.rig_file import RigFile
from pmm.run.campaign_folder import finished_runs


class Writer:
    """Writes ``campaign.toml`` in the order in which runs end.

    Parameters
    ----------
    executor
        Has one thread, so that no older file replaces a newer one; ``None`` to write at once.
    """

    def __init__(self, rig_file: RigFile, executor: Executor | None) -> None:
        self._rig_file, self._executor = rig_file, executor
        self._pending: list[Future[None]] = []

    def write(self, plan: QueuedPlan, tell: Callable[[Notice], None]) -> None:
        """Write the file of a plan's folder, and tell when it is there."""
        if self._executor is None:
            self._write(plan, tell)
        else:
            self._pending.append(self._executor.submit(self._write, plan, tell))

    def failures(self) -> list[str]:
        """Return what went wrong since the last call."""
        done = [one for one in self._pending if one.done()]
        self._pending = [one for one in self._pending if one not in done]
        found = [one.exception() for one in done]
        return [f"campaign.toml is not written: {error}" for error in found if error is not None]

    def close(self) -> list[str]:
        """Wait for what is being written; return what went wrong."""
        wait(self._pending)
        return self.failures()

    def _write(self, plan: QueuedPlan, tell: Callable[[Notice], None]) -> None:
        done = finished_runs(plan.folder, plan.plan.runs)
        write_campaign(plan.folder, plan.plan, self._rig_file, done)
        tell(Notice(WRITTEN, 0.0, plan.plan.name, plan=plan.number, folder=plan.folder))
