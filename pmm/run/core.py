"""What run control is made of: its state, the run under way, and how a run's recording ends."""

from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from typing import TYPE_CHECKING, Final, Protocol

from hardware.errors import HardwareError, Reaction, as_fault
from hardware.rig import Rig
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan
from pmm.recorder.run_recorder import Outcome
from pmm.run.closing import Closing
from pmm.run.conduct import Begin, Conduct
from pmm.run.measurement import Measurement
from pmm.run.phases import ENTER
from pmm.run.states import Machine, State
from pmm.run.status import RunOutcome

if TYPE_CHECKING:
    from pmm.recorder.live_path import Taken
    from pmm.run.run_control import RunControl

_FINAL: Final = frozenset({State.STOPPED, State.FAULT, State.DONE})
_ALARMS: Final = 20  # kept for the screen; the recording keeps all


class View(Protocol):
    """Shows what is going on."""

    def show(self, control: "RunControl") -> None:
        """Look at the control, if it is time to."""
        ...


class Core:
    """State and bookkeeping of run control; see :class:`pmm.run.run_control.RunControl`."""

    def __init__(
        self,
        rig: Rig,
        rig_file: RigFile,
        runs: Sequence[RunPlan],
        begin: Begin,
        clock: Callable[[], float],
        view: View,
        executor: Executor | None = None,
    ) -> None:
        self.rig, self.runs = rig, tuple(runs)
        self._numbers = {one.name: number for number, one in enumerate(self.runs, 1)}
        self.outcomes: list[RunOutcome] = []
        self.fault: HardwareError | None = None
        self.free_bytes: Callable[[], int | None] = lambda: None
        self._clock, self._view = clock, view
        self._machine = Machine()
        self._conduct = Conduct(rig, rig_file, begin, waits=executor is None)
        self._ending = Outcome.COMPLETE
        self._halting = self._winding_down = self._braking = self._mute = False
        self._closing: Closing | None = None
        self._executor = executor
        self.taken: Taken | None = None
        self.alarm_count = 0
        self._alarms: deque[str] = deque(maxlen=_ALARMS)
        self._highest_hz = rig_file.oscillator.frequency_hz.high
        rig.limit(rig_file.watched)

    def follow(self, before: "Core") -> None:
        """Go on where another plan's control left the rig: carriage, medium and loads stay."""
        self._conduct.surroundings = before._conduct.surroundings
        self._conduct.rested_since = before._conduct.rested_since

    @property
    def state(self) -> State:
        """Where run control stands."""
        return self._machine.state

    @property
    def measurement(self) -> Measurement | None:
        """The run that is being recorded; ``None`` between runs."""
        return self._conduct.measurement

    @property
    def finished(self) -> bool:
        """Whether nothing more happens without a command."""
        more = self.state is State.DONE and self._next() is not None
        settled = self._closing is None and self._conduct.measurement is None
        return self.state in _FINAL and not more and settled and not self._winding_down

    def _record(self, lateness_s: float) -> None:
        """Record a cycle; in a fault a recorder that fails must not keep the axes from stopping."""
        measurement = self._conduct.measurement
        if self._mute:
            return
        try:
            self.taken = self._conduct.path.step()
            if measurement is not None:
                measurement.cycle(self.taken, lateness_s, self._clock())
        except Exception as error:
            if self.state is not State.FAULT:
                raise
            fault = as_fault(f"recorder of {measurement.run.name}" if measurement else "rig", error)
            self._worse(fault)
            self._mute = fault.reaction < Reaction.QUICK_STOP or fault is not error

    def _worse(self, error: HardwareError) -> None:
        """Stop more quickly if what was found in a fault asks for more than the fault did."""
        if all(one.reaction < error.reaction for one in self.rig.faults):
            self._alarm(str(error))
            self.rig.latch(error)

    def _go(self, state: State) -> None:
        c = self._conduct
        self._machine.go(state, self.rig.number)
        c.since, c.told = self.rig.number, False
        if c.measurement is not None:
            c.measurement.event("state", str(state))
        if state in ENTER:
            ENTER[state](c)

    def _next(self) -> RunPlan | None:
        ended = {one.run for one in self.outcomes}
        return next((one for one in self.runs if one.name not in ended), None)

    def _close(self, outcome: Outcome) -> None:
        c = self._conduct
        if c.measurement is not None and c.run is not None:
            reason = str(self.fault) if outcome is Outcome.FAULT else ""
            self._closing = Closing(c.measurement, c.run, outcome, reason, self._executor)
            c.measurement = None
        elif c.run is not None and outcome is not Outcome.COMPLETE and not self._ended(c.run):
            self.outcomes.append(_without_recording(c.run, outcome, self.fault))

    def _ended(self, run: RunPlan) -> bool:
        return any(one.run == run.name for one in self.outcomes)

    def _alarm(self, text: str) -> None:
        self.alarm_count += 1
        self._alarms.append(text)


def _without_recording(run: RunPlan, outcome: Outcome, fault: HardwareError | None) -> RunOutcome:
    reason = str(fault) if fault is not None else ""
    return RunOutcome(run.name, str(run.kind), str(outcome), "", 0, (), (), None, reason)
