"""Completing a recording while the loop goes on: drives that hear no heartbeat would stop."""

from concurrent.futures import Executor, Future

from hardware.description.errors import PmmError
from hardware.errors import HardwareError
from pmm.plan.run_plan import RunPlan
from pmm.recorder.run_recorder import Outcome
from pmm.run.measurement import Measurement
from pmm.run.status import RunOutcome


class Closing:
    """A recording that is being completed.

    Parameters
    ----------
    reason
        Why the run ended as it did, for the outcome.
    executor
        Where to work; ``None`` for at once, here.
    """

    def __init__(
        self,
        measurement: Measurement,
        run: RunPlan,
        outcome: Outcome,
        reason: str,
        executor: Executor | None,
    ) -> None:
        self._measurement, self._run = measurement, run
        self._outcome, self._reason = outcome, reason
        try:
            measurement.collect(final=True)
        except HardwareError as error:
            self._reason = self._reason or str(error)
        self._rows = measurement.rows()
        self._future: Future[str] | None = executor.submit(self._work) if executor else None
        self._file = "" if executor else self._work()

    def done(self) -> bool:
        """Whether it is complete."""
        return self._future is None or self._future.done()

    def result(self) -> RunOutcome:
        """Return how the run ended."""
        one, run = self._measurement, self._run
        file = self._file if self._future is None else self._future.result()
        return RunOutcome(
            run.name,
            str(run.kind),
            str(self._outcome),
            file,
            one.gate.periods,
            self._rows,
            tuple(one.flags),
            one.journal.statistics(),
            self._reason,
        )

    def _work(self) -> str:
        """Complete the recording; what cannot be completed stays as journals and is said."""
        try:
            return str(self._measurement.journal.close(self._outcome, self._measurement.flags))
        except (PmmError, OSError) as error:
            said = f"the recording was not completed: {error}; `pmm recover` makes one"
            self._reason = f"{self._reason}; {said}" if self._reason else said
            self._outcome = Outcome.FAULT
            return ""
