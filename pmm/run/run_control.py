"""Run control: one step per cycle, one state machine, one way to stop.

A fault ends in :attr:`~pmm.run.states.State.FAULT` and stays there: axes brought to rest,
power off, the recording closed with what there is. Only an operator's reset leads out of it, and
nothing goes on by itself afterwards.
"""

from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from typing import Final, Protocol

from hardware.description.flags import Severity
from hardware.errors import HardwareError, Reaction
from hardware.rig import Rig
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan
from pmm.recorder.run_recorder import Outcome
from pmm.run.closing import Closing
from pmm.run.conduct import Begin, Conduct
from pmm.run.errors import NotAtRestError, OverspeedError
from pmm.run.measurement import Measurement
from pmm.run.phases import ENTER, NEXT, at_rest
from pmm.run.states import Command, Machine, RunStateError, State
from pmm.run.status import RunOutcome, Status

_OVERSPEED: Final = 1.05  # over the oscillator's highest frequency
_REST_S: Final = 3.0  # for drives that are not heard any more, or that quick-stop
_GATED: Final = frozenset({State.ARMED, State.GATE_OPEN})
_FINAL: Final = frozenset({State.STOPPED, State.FAULT, State.DONE})
_ALARMS: Final = 20  # kept for the screen; the recording keeps all


class View(Protocol):
    """Shows what is going on."""

    def show(self, control: "RunControl") -> None:
        """Look at the control, if it is time to."""
        ...


class RunControl:
    """Carries out runs on a rig.

    Parameters
    ----------
    runs
        In order.
    begin
        Opens the recorder of a run, in the cycle in which recording begins.
    clock
        Monotonic seconds: only for flushing in time.
    view
        Looked at in every cycle; it decides itself how often it shows anything.
    executor
        Where recordings are completed while the loop goes on; ``None`` to do it in the loop, for
        a rig whose time is counted in cycles.

    Attributes
    ----------
    outcomes
        Of the runs that ended.
    fault
        What is latched; ``None`` if nothing is.
    alarm_count
        How many alarms there were so far.
    """

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
        self.outcomes: list[RunOutcome] = []
        self.fault: HardwareError | None = None
        self.free_bytes: Callable[[], int | None] = lambda: None
        self._clock, self._view = clock, view
        self._machine = Machine()
        self._conduct = Conduct(rig, rig_file, begin)
        self._ending = Outcome.COMPLETE
        self._halting = self._winding_down = self._mute = False
        self._closing: Closing | None = None
        self._executor = executor
        self.alarm_count = 0
        self._alarms: deque[str] = deque(maxlen=_ALARMS)
        self._highest_hz = _OVERSPEED * rig_file.oscillator.frequency_hz.high

    @property
    def state(self) -> State:
        """Where run control stands."""
        return self._machine.state

    @property
    def measurement(self) -> Measurement | None:
        """The run that is being recorded; ``None`` between runs."""
        return self._conduct.measurement

    @property
    def question(self) -> str:
        """What the operator is asked by run control itself; empty if nothing."""
        return self._conduct.questions.present

    @property
    def finished(self) -> bool:
        """Whether nothing more happens without a command."""
        more = self.state is State.DONE and self._next() is not None
        settled = self._closing is None and self._conduct.measurement is None
        return self.state in _FINAL and not more and settled and not self._winding_down

    def request(self, command: Command) -> None:
        """Take a command.

        Raises
        ------
        RunStateError
            If the present state does not allow it.
        HardwareError
            If a reset does not succeed; the fault stays latched.
        """
        self._machine.check(command)
        self._note_command(command)
        {
            Command.START: self._start,
            Command.NEXT: self._skip,
            Command.HOLD: self._hold,
            Command.RESET: self._reset,
            Command.STOP: self._stop,
            Command.QUICK_STOP: self._quick_stop,
        }[command]()

    def step(self) -> None:
        """Run one cycle of the rig, and what the present state makes of it."""
        lateness_s = 0.0
        try:
            lateness_s = self.rig.cycle().lateness_s
        except HardwareError as error:
            self._found(error)
        try:
            self._follow(lateness_s)
        except HardwareError as error:
            self._found(error, own=True)
        self._view.show(self)

    def status(self) -> Status:
        """Return a picture of this moment."""
        c, run, number = self._conduct, self._conduct.run, self.rig.number
        measurement = c.measurement
        return Status(
            state=self.state,
            cycle=number,
            time_s=number / c.rate_hz,
            run=run.name if run else "",
            kind=str(run.kind) if run else "",
            run_number=self.runs.index(run) + 1 if run else 0,
            run_count=len(self.runs),
            frequency_hz=run.set_point.frequency_hz if run else 0.0,
            gate=measurement.gate.state if measurement else Status.gate,
            periods=measurement.gate.periods if measurement else 0,
            wanted_periods=measurement.gate.wanted if measurement else 0,
            harmonics=measurement.rows() if measurement else (),
            question=c.questions.present,
            alarms=tuple(self._alarms),
            statistics=measurement.journal.statistics() if measurement else None,
            free_bytes=self.free_bytes(),
        )

    def _follow(self, lateness_s: float) -> None:
        """Let time pass for recording, closing and the present state."""
        c = self._conduct
        self._record(lateness_s)
        if self._closing is not None and self._closing.done():
            self._closed(self._closing)
        if self.state is State.FAULT:
            self._wind_down()
        elif self.state is State.STOPPING:
            self._come_to_rest()
        elif self.state is State.DONE:
            self._go_on()
        elif self.state in NEXT:
            self._check_speed()
            following = NEXT[self.state](c)
            if following is not None:
                self._go(following)

    def _record(self, lateness_s: float) -> None:
        """Record a cycle; in a fault a recorder that fails must not keep the axes from stopping."""
        measurement = self._conduct.measurement
        if measurement is None or self._mute:
            return
        try:
            measurement.cycle(lateness_s, self._clock())
        except HardwareError:
            if self.state is not State.FAULT:
                raise
            self._mute = True

    def _go(self, state: State) -> None:
        c = self._conduct
        self._machine.go(state, self.rig.number)
        c.since, c.told = self.rig.number, False
        if c.measurement is not None:
            c.measurement.event("state", str(state))
        if state in ENTER:
            ENTER[state](c)

    def _go_on(self) -> None:
        """Take the next run once the last one's recording is closed."""
        if self._closing is not None:
            return
        following = self._next()
        if following is not None:
            self._conduct.run, self._conduct.pushed = following, 0
            self._ending, self._halting = Outcome.COMPLETE, False
            self._go(State.SETTING)

    def _next(self) -> RunPlan | None:
        ended = {one.run for one in self.outcomes}
        return next((one for one in self.runs if one.name not in ended), None)

    def _come_to_rest(self) -> None:
        c = self._conduct
        if not at_rest(c):
            self._check_rest(_REST_S + self._ramp_s())
            return
        self._close(self._ending)
        if self._halting or self._next() is None:
            for one in self.rig.powered():
                one.disable()
        self._go(State.STOPPED if self._halting else State.DONE)

    def _wind_down(self) -> None:
        """In a fault: wait until the axes rest, take their power off, close the recording."""
        if not self._winding_down:
            return
        c = self._conduct
        patience_s = _REST_S + self._ramp_s()
        lost = self.fault is not None and self.fault.reaction is Reaction.END_RUN
        if lost:
            patience_s = _REST_S
        if c.moving and c.elapsed_s < patience_s:
            return
        if c.moving:
            self._alarm(str(_unseen(lost)))
        for one in self.rig.powered():
            one.disable()
        self._winding_down = False
        c.rested_since = self.rig.number
        self._close(Outcome.FAULT)

    def _check_rest(self, limit_s: float) -> None:
        c = self._conduct
        if c.moving and c.elapsed_s > limit_s and not c.questions.present:
            raise _unseen(False)

    def _ramp_s(self) -> float:
        """Longest time that a profile stop may take, from the shaft's own settings."""
        part = self.rig.configuration.shaft
        acceleration = getattr(part.settings, "acceleration_hz_per_s", None) if part else None
        return 1.5 * self._highest_hz / acceleration if acceleration else 60.0

    def _check_speed(self) -> None:
        shaft = self.rig.shaft
        if shaft is not None and shaft.measured_frequency_hz > self._highest_hz:
            raise OverspeedError(
                shaft.name,
                f"turns at {shaft.measured_frequency_hz:g} Hz (limit {self._highest_hz:g} Hz)",
            )

    def _found(self, error: HardwareError, *, own: bool = False) -> None:
        """Do what a fault asks for, beyond what the rig has done already.

        A command of our ``own`` that is refused ends the run: it would never come to its end.
        """
        self._alarm(str(error))
        refused = own and error.reaction is Reaction.REFUSE
        if error.reaction >= Reaction.PROFILE_STOP or refused:
            self._fail(error)
        elif error.reaction is Reaction.VOID_GATE and self.state in _GATED:
            self._void(error)

    def _void(self, error: HardwareError) -> None:
        try:
            self._conduct.recording.void(str(error))
        except HardwareError as last:
            self._found(last)
        else:
            if self.state is State.GATE_OPEN:
                self._go(State.ARMED)

    def _fail(self, error: HardwareError) -> None:
        """Latch a fault: the first one is the cause, later ones are alarms."""
        self.rig.latch(error)
        if error.reaction < Reaction.PROFILE_STOP:
            self.rig.stop()
        if self.state is State.FAULT:
            return
        self.fault, self._mute = error, False
        self._conduct.questions.withdraw()
        self._winding_down = True
        self._machine.go(State.FAULT, self.rig.number)
        self._conduct.since = self.rig.number
        self._keep_alarm(error)

    def _keep_alarm(self, error: HardwareError) -> None:
        measurement = self._conduct.measurement
        if measurement is None:
            return
        try:
            measurement.collect()
            measurement.note(type(error).__name__, Severity.VOID, str(error))
        except HardwareError as also:
            self._alarm(str(also))

    def _close(self, outcome: Outcome) -> None:
        c = self._conduct
        if c.measurement is not None and c.run is not None:
            reason = str(self.fault) if outcome is Outcome.FAULT else ""
            self._closing = Closing(c.measurement, c.run, outcome, reason, self._executor)
            c.measurement = None
        elif c.run is not None and outcome is not Outcome.COMPLETE and not self._ended(c.run):
            self.outcomes.append(_without_recording(c.run, outcome, self.fault))

    def _closed(self, closing: Closing) -> None:
        self._closing = None
        found = closing.result()
        self.outcomes.append(found)
        if found.reason and found.outcome == Outcome.COMPLETE:
            self._alarm(found.reason)

    def _ended(self, run: RunPlan) -> bool:
        return any(one.run == run.name for one in self.outcomes)

    def _start(self) -> None:
        following = self._next()
        if following is None:
            raise RunStateError("all runs are done; nothing to start")
        self._conduct.run, self._conduct.pushed = following, 0
        self._ending, self._halting = Outcome.COMPLETE, False
        self._go(State.HOMING)

    def _skip(self) -> None:
        self._ending = Outcome.STOPPED
        self._go(State.STOPPING)

    def _hold(self) -> None:
        self._conduct.recording.gate.hold()

    def _reset(self) -> None:
        if self.state is not State.FAULT:
            self._go(State.ARMED)
            return
        if self._winding_down or self._closing is not None:
            raise RunStateError("the axes are still coming to rest, or the recording is closing")
        self.rig.reset()
        self.fault = None
        self._conduct.placed.clear()
        self._go(State.IDLE)

    def _stop(self) -> None:
        """Stop along the profile; a run whose gate has closed already counts as complete."""
        self._halting = True
        if self.state is State.DONE:
            for one in self.rig.powered():
                one.disable()
            self._machine.go(State.STOPPED, self.rig.number)
        elif self.state is not State.STOPPING:
            self._ending = Outcome.STOPPED
            self._go(State.STOPPING)

    def _quick_stop(self) -> None:
        if self.state in NEXT or self.state is State.DONE:
            self._stop()
        self._halting = True
        self.rig.quick_stop()
        self._conduct.questions.withdraw()

    def _note_command(self, command: Command) -> None:
        if self._conduct.measurement is not None:
            self._conduct.measurement.event("command", str(command))

    def _alarm(self, text: str) -> None:
        self.alarm_count += 1
        self._alarms.append(text)


def _unseen(lost: bool) -> NotAtRestError:
    why = (
        "the bus is lost and the drives stop by themselves, but nobody hears it"
        if lost
        else "an axis still moves after its time for a stop"
    )
    return NotAtRestError("rig", f"{why}; look at it, and use the emergency stop if it turns")


def _without_recording(run: RunPlan, outcome: Outcome, fault: HardwareError | None) -> RunOutcome:
    reason = str(fault) if fault is not None else ""
    return RunOutcome(run.name, str(run.kind), str(outcome), "", 0, (), (), None, reason)
