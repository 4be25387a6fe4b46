"""How run control comes to rest: after a run, after a stop, and in a fault."""

from typing import Final

from hardware.description.flags import Severity
from hardware.errors import HardwareError, NotAtRestError, ProgramError, Reaction, as_fault
from hardware.limits import COASTING_S, REST_DEADLINE_S
from pmm.recorder.run_recorder import Outcome
from pmm.run.closing import Closing
from pmm.run.core import Core
from pmm.run.errors import RecordingError
from pmm.run.phases import at_rest
from pmm.run.states import State

_REST_S: Final = 3.0  # for drives that are not heard any more, or that quick-stop
_GATED: Final = frozenset({State.ARMED, State.GATE_OPEN})


class Stopping(Core):
    """Faults, limits and the way to rest."""

    def _found(self, error: HardwareError, *, own: bool = False) -> None:
        """Do what a fault asks for, beyond what the rig has done already.

        A command of our ``own`` that is refused ends the run: it would never come to its end.
        """
        if isinstance(error, ProgramError) and self._told(error):
            return  # it comes again in every cycle
        self._alarm(str(error))
        refused = own and error.reaction is Reaction.REFUSE
        if error.reaction >= Reaction.PROFILE_STOP or refused:
            self._fail(error)
        elif error.reaction is Reaction.VOID_GATE and self.state in _GATED:
            self._void(error)

    def _void(self, error: HardwareError) -> None:
        try:
            self._conduct.recording.void(str(error))
        except Exception as last:
            self._found(as_fault("gate", last))
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
        self.fault, self._mute, self._braking = error, False, False
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
            measurement.note(type(error).__name__, Severity.VOID, str(error))
        except Exception as also:  # the fault that led here is what counts
            self._worse(as_fault("recorder", also))

    def _closed(self, closing: Closing) -> None:
        """Keep how a run ended; a recording that could not be completed is a fault."""
        self._closing = None
        found = closing.result()
        self.outcomes.append(found)
        if found.outcome == Outcome.FAULT and self.fault is None:
            self._found(RecordingError(f"recorder of {found.run}", found.reason))

    def _wind_down(self) -> None:
        """In a fault: wait until the axes rest, take their power off, close the recording.

        What asks for a quick stop asks for the power to go, too: a drive takes both as one command,
        and its deadline begins.
        """
        if not self._winding_down:
            return
        c = self._conduct
        if not self._braking and any(r.reaction >= Reaction.QUICK_STOP for r in self.rig.faults):
            self._braking = True
            self._power_off()
        patience_s = self._ramp_s() + REST_DEADLINE_S + COASTING_S
        lost = self.fault is not None and self.fault.reaction is Reaction.END_RUN
        if lost:
            patience_s = _REST_S
        if c.moving and c.elapsed_s < patience_s:
            return
        if c.moving:
            self._alarm(str(_unseen(lost)))
        self._power_off()
        self._winding_down = False
        c.rested_since = self.rig.number
        self._close(Outcome.FAULT)

    def _give_up(self, error: HardwareError) -> None:
        """Close the recording of a fault whose way to rest cannot be followed any more."""
        self._worse(error)
        self._winding_down = False
        self._close(Outcome.FAULT)

    def _told(self, error: HardwareError) -> bool:
        return self.state is State.FAULT and str(error) in self._alarms

    def _come_to_rest(self) -> None:
        c = self._conduct
        if not at_rest(c):
            self._check_rest(_REST_S + self._ramp_s())
            return
        self._close(self._ending)
        ended = {one.run for one in self.outcomes} | {c.present.name}
        if self._halting or all(one.name in ended for one in self.runs):
            self._power_off()
        self._go(State.STOPPED if self._halting else State.DONE)

    def _power_off(self) -> None:
        for one in self.rig.powered():
            one.disable()

    def _check_rest(self, limit_s: float) -> None:
        c = self._conduct
        if c.moving and c.elapsed_s > limit_s and not c.questions.present:
            raise _unseen(False)

    def _ramp_s(self) -> float:
        """Longest time that a profile stop may take, from the shaft's own settings."""
        part = self.rig.configuration.shaft
        acceleration = getattr(part.settings, "acceleration_hz_per_s", None) if part else None
        return 1.5 * self._highest_hz / acceleration if acceleration else 60.0


def _unseen(lost: bool) -> NotAtRestError:
    why = (
        "the bus is lost and the drives stop by themselves, but nobody hears it"
        if lost
        else "an axis still moves after its time for a stop"
    )
    return NotAtRestError("rig", f"{why}; look at it, and use the emergency stop if it turns")
