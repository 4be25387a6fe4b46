"""Run control: one step per cycle, one state machine, one way to stop.

A fault ends in :attr:`~pmm.run.states.State.FAULT` and stays there: axes brought to rest,
power off, the recording closed with what there is. Only an operator's reset leads out of it, and
nothing goes on by itself afterwards. The tables are in :mod:`pmm.run.states`.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from concurrent.futures import Executor
from functools import partial
from typing import TYPE_CHECKING, Final

from hardware.errors import HardwareError, Reaction, as_fault
from hardware.rig import Rig
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan
from pmm.recorder.run_recorder import RunEnd
from pmm.run.closer import Closer
from pmm.run.conduct import Begin, Conduct, lead_carriage
from pmm.run.errors import RecordingError
from pmm.run.fault_latch import FaultLatch
from pmm.run.measurement import Measurement
from pmm.run.phases import PHASES, enter
from pmm.run.planned_runs import PlannedRuns
from pmm.run.present_status import status_of
from pmm.run.states import Command, RunStateError, State
from pmm.run.status import Alarms, RunOutcome, RunStatus
from pmm.run.stopper import Stopper

if TYPE_CHECKING:
    from pmm.recorder.live_path import CycleSamples
    from pmm.run.view import View

_FINAL: Final = frozenset({State.STOPPED, State.FAULT, State.DONE})


class RunControl:
    """Carries out runs on a rig.

    Parameters
    ----------
    runs
        In order.
    begin
        Begins to open the recorder of a run, in the cycle in which recording begins.
    clock
        Monotonic seconds: only for flushing in time.
    view
        Looked at in every cycle; it decides itself how often it shows anything.
    executor
        Where recordings are completed while the loop goes on; ``None`` to wait for the disk in the
        loop, when one is opened too, for a rig whose time is counted in cycles.

    Attributes
    ----------
    planned
        The runs: begun, to be made, held.
    alarms
        What went wrong so far.
    taken
        What the last cycle brought.
    free_bytes
        Returns the room on the disk; ``None`` where nothing is recorded.
    """

    def __init__(
        self,
        rig: Rig,
        rig_file: RigFile,
        runs: Sequence[RunPlan],
        begin: Begin,
        clock: Callable[[], float],
        view: "View[RunControl]",
        executor: Executor | None = None,
    ) -> None:
        self.rig = rig
        self.taken: CycleSamples | None = None
        self.free_bytes: Callable[[], int | None] = lambda: None
        self._clock, self._view = clock, view
        self._conduct = c = Conduct(rig, rig_file, begin, waits=executor is None)
        self.alarms = Alarms()
        self._stopper = Stopper(c, self.alarms)
        self._faults = FaultLatch(c, self._stopper, self.alarms)
        self._closer = Closer(executor)
        self.planned = PlannedRuns(runs, self._closer.ended)
        self._is_mute = False  # the recorder has failed in a fault, and is not tried again
        self._doing: Mapping[State, Callable[[], State | None]] = {
            **{state: partial(phase, c) for state, phase in PHASES.items()},
            State.STOPPING: self._come_to_rest,
            State.DONE: self._go_on,
            State.FAULT: self._wind_down,
        }
        rig.limit(rig_file.watched)

    def follow(self, before: "RunControl") -> None:
        """Go on where another plan's control left the rig: carriage, medium and loads stay."""
        self._conduct.surroundings = before._conduct.surroundings
        self._conduct.rested_since = before._conduct.rested_since

    def replan(self, runs: Sequence[RunPlan], held: Collection[str] = ()) -> None:
        """Take other runs than those still to be made, some of them held; axes are set anew.

        Raises
        ------
        RunStateError
            As :meth:`pmm.run.planned_runs.PlannedRuns.replan`.
        """
        under_way = self.state not in (*_FINAL, State.IDLE) or self._closer.busy
        self.planned.replan(runs, held, self._conduct.run if under_way else None)
        self._conduct.placed.clear()

    @property
    def runs(self) -> tuple[RunPlan, ...]:
        """All runs, in order."""
        return self.planned.runs

    @property
    def state(self) -> State:
        """Where run control stands."""
        return self._conduct.state

    @property
    def measurement(self) -> Measurement | None:
        """The run that is being recorded; ``None`` between runs."""
        return self._conduct.measurement

    @property
    def outcomes(self) -> list[RunOutcome]:
        """How each run ended, in the order in which they did."""
        return self._closer.outcomes

    @property
    def fault(self) -> HardwareError | None:
        """What is latched; ``None`` if nothing is."""
        return self._faults.cause

    @property
    def finished(self) -> bool:
        """Whether nothing more happens without a command."""
        more = self.state is State.DONE and bool(self.planned.runs_left)
        settled = not self._closer.busy and self.measurement is None
        return self.state in _FINAL and not more and settled and not self._stopper.winding_down

    def request(self, command: Command) -> None:
        """Take a command.

        Raises
        ------
        RunStateError
            If the present state does not allow it.
        HardwareError
            If a reset does not succeed; the fault stays latched.
        """
        self._conduct.machine.check(command)
        if self.measurement is not None:
            self.measurement.event("command", str(command))
        {
            Command.START: self._start,
            Command.NEXT: self._skip,
            Command.HOLD: lambda: self._conduct.recording.gate.hold(),
            Command.RESET: self._reset,
            Command.STOP: self._stop,
            Command.QUICK_STOP: self._quick_stop,
        }[command]()

    def fail(self, error: HardwareError) -> None:
        """Take a fault that was found outside: by what hands the commands in, for example."""
        self._faults.take(error)

    def step(self) -> None:
        """Run one cycle of the rig, and what the present state makes of it.

        Nothing is raised: an exception of the program's own is a fault like any other.
        """
        lateness_s = 0.0
        try:
            lateness_s = self.rig.cycle().lateness_s
        except HardwareError as error:
            self._faults.take(error)
        try:
            self._record(lateness_s)
            self._hear_closer()
            self._do()
        except Exception as error:  # the loop must not end: nobody would stop the axes
            self._faults.take(as_fault("run control", error), own=True)
        try:
            self._view.show(self)
        except Exception as error:  # nor by what only shows
            self._faults.take(as_fault("view", error))

    def status(self) -> RunStatus:
        """Return a picture of this moment."""
        return status_of(self._conduct, self.planned, self.alarms, self.free_bytes())

    def _record(self, lateness_s: float) -> None:
        """Record a cycle; in a fault a recorder that fails must not keep the axes from stopping."""
        if self._is_mute:
            return
        measurement = self.measurement
        try:
            self.taken = self._conduct.path.step()
            if measurement is not None:
                measurement.cycle(self.taken, lateness_s, self._clock())
        except Exception as error:
            if self.state is not State.FAULT:
                raise
            fault = as_fault(f"recorder of {measurement.run.name}" if measurement else "rig", error)
            self._faults.take_worse(fault)
            self._is_mute = fault.reaction < Reaction.QUICK_STOP or fault is not error

    def _hear_closer(self) -> None:
        """Take how a run ended; a recording that could not be completed is a fault."""
        ended = self._closer.closed()
        if ended is not None and ended.outcome == RunEnd.FAULT and self.fault is None:
            self._faults.take(RecordingError(f"recorder of {ended.run}", ended.reason))

    def _do(self) -> None:
        """Do what the present state is for; enter the one that follows it."""
        if self.state in PHASES:
            lead_carriage(self._conduct)
        doing = self._doing.get(self.state)
        following = doing() if doing is not None else None
        if following is not None:
            enter(self._conduct, following)

    def _come_to_rest(self) -> State | None:
        c = self._conduct
        if not self._stopper.at_rest():
            return None
        self._closer.close(c, c.ending)
        if c.leaves_plan or all(run.name == c.present.name for run in self.planned.runs_left):
            self._stopper.power_off()
        return State.STOPPED if c.leaves_plan else State.DONE

    def _wind_down(self) -> None:
        """In a fault: close the recording once the axes rest, or whatever goes wrong meanwhile."""
        close = partial(self._closer.close, self._conduct, RunEnd.FAULT, str(self.fault))
        try:
            if self._stopper.winding_down and self._stopper.wound_down():
                close()
        except Exception as error:
            self._faults.take_worse(as_fault("run control", error))
            self._stopper.give_up()
            close()

    def _go_on(self) -> State | None:
        """Take the next run once the last one's recording is closed."""
        if self._closer.busy or not self.planned.runs_left:
            return None
        self._conduct.take(self.planned.runs_left[0])
        return State.SETTING

    def _start(self) -> None:
        if self._closer.busy:
            raise RunStateError(
                "the last run's recording is still being completed; start again soon"
            )
        if not self.planned.runs_left:
            raise RunStateError("all runs are done or held; nothing to start")
        self._conduct.take(self.planned.runs_left[0])
        enter(self._conduct, State.HOMING)

    def _skip(self) -> None:
        self._conduct.ending = RunEnd.STOPPED
        enter(self._conduct, State.STOPPING)

    def _reset(self) -> None:
        if self.state is not State.FAULT:
            enter(self._conduct, State.ARMED)
            return
        if self._stopper.winding_down or self._closer.busy:
            raise RunStateError("the axes are still coming to rest, or the recording is closing")
        self._faults.reset()
        self._is_mute = False
        enter(self._conduct, State.IDLE)

    def _stop(self) -> None:
        """Stop along the profile; a run whose gate has closed already counts as complete."""
        c = self._conduct
        c.leaves_plan = True
        if self.state is State.DONE:
            self._stopper.power_off()
            enter(c, State.STOPPED)
        elif self.state is not State.STOPPING:
            self._skip()

    def _quick_stop(self) -> None:
        if self.state in PHASES or self.state is State.DONE:
            self._stop()
        self._conduct.leaves_plan = True
        self.rig.quick_stop()
        if self.state is State.STOPPING:
            self._stopper.power_off()  # at rest; a drive that does not brake has its deadline now
        self._stopper.call_off()
