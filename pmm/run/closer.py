"""Recordings are completed while the loop goes on: drives that hear no heartbeat would stop."""

from concurrent.futures import Executor, Future

from hardware.description.errors import PmmError
from hardware.errors import as_fault
from pmm.plan.run_plan import RunPlan
from pmm.recorder.run_recorder import RunEnd
from pmm.run.conduct import Conduct
from pmm.run.measurement import Measurement
from pmm.run.status import ChannelReading, RunOutcome


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
        outcome: RunEnd,
        reason: str,
        executor: Executor | None,
    ) -> None:
        self._measurement, self._run = measurement, run
        self._outcome, self._reason = outcome, reason
        self._rows: tuple[ChannelReading, ...] = ()
        try:
            self._rows = measurement.rows()
        except Exception as error:  # closing is never skipped
            self._reason = self._reason or str(as_fault(f"recorder of {run.name}", error))
        self._future: Future[str] | None = executor.submit(self._work) if executor else None
        self._file = "" if executor else self._work()

    def is_closed(self) -> bool:
        """Whether the recording is closed and the outcome can be taken."""
        return self._future is None or self._future.done()

    def result(self) -> RunOutcome:
        """Return how the run ended; waits until the recording is closed."""
        measurement, run = self._measurement, self._run
        file = self._file if self._future is None else self._future.result()
        return RunOutcome(
            run.name,
            str(run.kind),
            str(self._outcome),
            file,
            measurement.gate.periods,
            self._rows,
            tuple(measurement.flags),
            measurement.journal.statistics(),
            self._reason,
        )

    def _work(self) -> str:
        """Complete the recording; what cannot be completed stays as journals and is said."""
        try:
            return str(self._measurement.journal.close(self._outcome, self._measurement.flags))
        except Exception as error:  # whatever it is, the loop goes on and the journals stay
            why = error if isinstance(error, PmmError | OSError) else as_fault("recorder", error)
            self._outcome = RunEnd.FAULT
            if not self._measurement.journal.has_files:
                self._reason = self._reason or str(why)
                return ""
            said = f"the recording was not completed: {why}; `pmm recover` makes one"
            self._reason = f"{self._reason}; {said}" if self._reason else said
            return ""


class Closer:
    """Closes the recordings of runs, and keeps how the runs ended.

    Parameters
    ----------
    executor
        Where recordings are completed; ``None`` for at once.

    Attributes
    ----------
    outcomes
        Of the runs that ended.
    """

    def __init__(self, executor: Executor | None) -> None:
        self.outcomes: list[RunOutcome] = []
        self._ended: set[str] = set()
        self.executor = executor
        self._closing: Closing | None = None

    @property
    def busy(self) -> bool:
        """Whether a recording is still being completed."""
        return self._closing is not None

    def close(self, c: Conduct, outcome: RunEnd, reason: str = "") -> None:
        """End the present run; one that left before it recorded anything is none but complete."""
        if c.run is None:
            return
        if c.measurement is not None:
            self._closing = Closing(c.measurement, c.run, outcome, reason, self.executor)
            c.measurement = None
        elif outcome is not RunEnd.COMPLETE and not self.ended(c.run):
            run = c.run
            kind, ended = str(run.kind), str(outcome)
            self._keep(RunOutcome(run.name, kind, ended, "", 0, (), (), None, reason))

    def closed(self) -> RunOutcome | None:
        """Return how a run ended, once, in the cycle in which its recording is complete."""
        if self._closing is None or not self._closing.is_closed():
            return None
        closing, self._closing = self._closing, None
        return self._keep(closing.result())

    def ended(self, run: RunPlan) -> bool:
        """Return whether a run has ended, however."""
        return run.name in self._ended

    def _keep(self, outcome: RunOutcome) -> RunOutcome:
        self.outcomes.append(outcome)
        self._ended.add(outcome.run)
        return outcome
