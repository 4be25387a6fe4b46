"""What is written of a campaign beside its runs, away from the loop: sources, campaign file."""

from collections.abc import Callable
from concurrent.futures import Executor, Future, wait
from typing import TYPE_CHECKING

from pmm.console.messages import WRITTEN, Notice
from pmm.console.queued_plan import QueuedPlan
from pmm.plan.campaign_writer import write_campaign
from pmm.plan.rig_file import RigFile
from pmm.recorder.campaign_owner import own_campaign
from pmm.run.campaign_folder import finished_runs, keep_sources

if TYPE_CHECKING:
    from pmm.recorder.campaign_owner import CampaignOwnership


class Writer:
    """Owns the folders of the queued plans and writes ``campaign.toml`` in the order of the runs.

    Each piece of work owns its folder until it is done, whoever else lets go of it meanwhile.

    Parameters
    ----------
    executor
        Has one thread, so that no older file replaces a newer one; ``None`` to write at once.
    """

    def __init__(self, rig_file: RigFile, executor: Executor | None) -> None:
        self._rig_file, self._executor = rig_file, executor
        self._pending: list[Future[None]] = []
        self._owned: dict[int, CampaignOwnership] = {}

    def begin(self, plan: QueuedPlan) -> None:
        """Own a plan's folder, and keep plan and rig file in it, as they were read.

        The loop owns it, because the web server may end before the plan; and it never waits.

        Raises
        ------
        OwnedElsewhereError
            If another process is writing into the folder.
        """
        owned = self._owned[plan.number] = own_campaign(plan.folder, patience_s=0.0)

        def begin() -> None:
            if not plan.chooses:  # whose plan lies in the folder, and grows
                keep_sources(plan.plan, self._rig_file, plan.folder)
            owned.count()  # now, and not in the loop

        self._do(plan, begin)

    def let_go(self, number: int) -> None:
        """Let others write into the folder of a plan that is done or taken out of the queue."""
        owned = self._owned.pop(number, None)
        if owned is not None:
            owned.release()

    def write(self, plan: QueuedPlan, tell: Callable[[Notice], None]) -> None:
        """Write the file of a plan's folder, and tell when it is there."""
        self._do(plan, lambda: self._write(plan, tell))

    def _do(self, plan: QueuedPlan, work: Callable[[], None]) -> None:
        owned = own_campaign(plan.folder, patience_s=0.0)

        def do_owned() -> None:
            with owned:
                work()

        if self._executor is None:
            do_owned()
        else:
            self._pending.append(self._executor.submit(do_owned))

    def failures(self) -> list[str]:
        """Return what went wrong since the last call."""
        ended = [task for task in self._pending if task.done()]
        self._pending = [task for task in self._pending if task not in ended]
        errors = [task.exception() for task in ended]
        return [f"the campaign is not written: {error}" for error in errors if error is not None]

    def close(self) -> list[str]:
        """Wait for what is being written and let go of the folders; return what went wrong."""
        wait(self._pending)
        for number in tuple(self._owned):
            self.let_go(number)
        return self.failures()

    def _write(self, plan: QueuedPlan, tell: Callable[[Notice], None]) -> None:
        runs = finished_runs(plan.folder, plan.plan, self._rig_file)
        write_campaign(plan.folder, plan.plan, self._rig_file, runs)
        tell(Notice(WRITTEN, 0.0, plan.plan.name, plan=plan.number, folder=plan.folder))
