"""Completing a recording while the loop goes on: drives that hear no heartbeat would stop."""

from concurrent.futures import Executor, Future

from hardware.description.errors import PmmError
from hardware.errors import as_fault
from pmm.plan.run_plan import RunPlan
from pmm.recorder.run_recorder import Outcome
from pmm.run.measurement import Measurement
from pmm.run.status import HarmonicRow, RunOutcome


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
        self._rows: tuple[HarmonicRow, ...] = ()
        try:
            self._rows = measurement.rows()
        except Exception as error:  # closing is never skipped
            self._reason = self._reason or str(as_fault(f"recorder of {run.name}", error))
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
        except Exception as error:  # whatever it is, the loop goes on and the journals stay
            why = error if isinstance(error, PmmError | OSError) else as_fault("recorder", error)
            self._outcome = Outcome.FAULT
            if not self._measurement.journal.begun:
                self._reason = self._reason or str(why)
                return ""
            said = f"the recording was not completed: {why}; `pmm recover` makes one"
            self._reason = f"{self._reason}; {said}" if self._reason else said
            return ""
