"""Run control: one step per cycle, one state machine, one way to stop.

A fault ends in :attr:`~pmm.run.states.State.FAULT` and stays there: axes brought to rest,
power off, the recording closed with what there is. Only an operator's reset leads out of it, and
nothing goes on by itself afterwards.
"""

from hardware.errors import HardwareError, as_fault
from pmm.recorder.run_recorder import Outcome
from pmm.run.phases import NEXT
from pmm.run.states import Command, RunStateError, State
from pmm.run.status import Status
from pmm.run.stopping import Stopping


class RunControl(Stopping):
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
    outcomes
        Of the runs that ended.
    fault
        What is latched; ``None`` if nothing is.
    alarm_count
        How many alarms there were so far.
    """

    @property
    def question(self) -> str:
        """What the operator is asked by run control itself; empty if nothing."""
        return self._conduct.questions.present

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

    def fail(self, error: HardwareError) -> None:
        """Take a fault that was found outside: by what hands the commands in, for example."""
        self._found(error)

    def step(self) -> None:
        """Run one cycle of the rig, and what the present state makes of it.

        Nothing is raised: an exception of the program's own is a fault like any other.
        """
        lateness_s = 0.0
        try:
            lateness_s = self.rig.cycle().lateness_s
        except HardwareError as error:
            self._found(error)
        try:
            self._follow(lateness_s)
        except Exception as error:  # the loop must not end: nobody would stop the axes
            self._found(as_fault("run control", error), own=True)
        try:
            self._view.show(self)
        except Exception as error:  # nor by what only shows
            self._found(as_fault("view", error))

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
            run_number=self._numbers[run.name] if run else 0,
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
            try:
                self._wind_down()
            except Exception as error:  # the recording is closed all the same
                self._give_up(as_fault("run control", error))
        elif self.state is State.STOPPING:
            self._come_to_rest()
        elif self.state is State.DONE:
            self._go_on()
        elif self.state in NEXT:
            following = NEXT[self.state](c)
            if following is not None:
                self._go(following)

    def _go_on(self) -> None:
        """Take the next run once the last one's recording is closed."""
        if self._closing is not None:
            return
        following = self._next()
        if following is not None:
            self._conduct.run, self._conduct.pushed = following, 0
            self._ending, self._halting = Outcome.COMPLETE, False
            self._go(State.SETTING)

    def _start(self) -> None:
        if self._closing is not None:
            raise RunStateError(
                "the last run's recording is still being completed; start again soon"
            )
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
        self.fault, self._mute = None, False
        self._conduct.placed.clear()
        self._go(State.IDLE)

    def _stop(self) -> None:
        """Stop along the profile; a run whose gate has closed already counts as complete."""
        self._halting = True
        if self.state is State.DONE:
            self._power_off()
            self._machine.go(State.STOPPED, self.rig.number)
        elif self.state is not State.STOPPING:
            self._ending = Outcome.STOPPED
            self._go(State.STOPPING)

    def _quick_stop(self) -> None:
        if self.state in NEXT or self.state is State.DONE:
            self._stop()
        self._halting = True
        self.rig.quick_stop()
        if self.state is State.STOPPING:
            self._power_off()  # at rest; the deadline of a drive that does not brake begins now
        self._conduct.questions.withdraw()

    def _note_command(self, command: Command) -> None:
        if self._conduct.measurement is not None:
            self._conduct.measurement.event("command", str(command))
