"""What a fault does to a run, by the table of faults; the first that ends it is latched."""

from hardware.description.flags import Severity
from hardware.errors import HardwareError, ProgramError, Reaction, as_fault
from pmm.run.conduct import Conduct
from pmm.run.phases import enter
from pmm.run.states import FAULTS, State
from pmm.run.status import Alarms
from pmm.run.stopper import Stopper


class FaultLatch:
    """Takes faults: the first is the cause, later ones are alarms.

    Attributes
    ----------
    cause
        What is latched; ``None`` if nothing is.
    """

    def __init__(self, conduct: Conduct, stopper: Stopper, alarms: Alarms) -> None:
        self._conduct, self._stopper, self._alarms = conduct, stopper, alarms
        self.cause: HardwareError | None = None

    def take(self, error: HardwareError, *, own: bool = False) -> None:
        """Do what a fault asks for, beyond what the rig has done already.

        A command of our ``own`` that is refused ends the run: it would never come to its end.
        """
        if isinstance(error, ProgramError) and self._comes_again(error):
            return
        self._alarms.add(str(error))
        row = FAULTS[error.reaction]
        if self._conduct.state not in row.within or (row.own_only and not own):
            return
        if row.leads_to is State.FAULT:
            self._latch(error)
        else:
            self._void(error)

    def take_worse(self, error: HardwareError) -> None:
        """Stop more quickly if what was found in a fault asks for more than the fault did."""
        faults = self._conduct.rig.faults
        if all(fault.reaction < error.reaction for fault in faults):
            self._alarms.add(str(error))
            self._conduct.rig.latch(error)

    def reset(self) -> None:
        """Forget the fault, on the operator's demand.

        Raises
        ------
        HardwareError
            If the rig cannot be reset; the fault stays latched.
        """
        self._conduct.rig.reset()
        self.cause = None
        self._conduct.placed.clear()

    def _void(self, error: HardwareError) -> None:
        c = self._conduct
        try:
            c.recording.void(str(error))
        except Exception as last:
            self.take(as_fault("gate", last))
        else:
            if c.state is State.GATE_OPEN:
                enter(c, State.ARMED)

    def _latch(self, error: HardwareError) -> None:
        c = self._conduct
        c.rig.latch(error)
        if error.reaction < Reaction.PROFILE_STOP:
            c.rig.stop()
        if c.state is State.FAULT:
            return
        self.cause = error
        self._stopper.call_off()
        self._stopper.begin(error)
        c.go(State.FAULT)
        self._write_down(error)

    def _write_down(self, error: HardwareError) -> None:
        measurement = self._conduct.measurement
        if measurement is None:
            return
        try:
            measurement.note(type(error).__name__, Severity.VOID, str(error))
        except Exception as also:  # the fault that led here is what counts
            self.take_worse(as_fault("recorder", also))

    def _comes_again(self, error: HardwareError) -> bool:
        """Whether it was told already: an exception in a fault comes in every cycle."""
        return self._conduct.state is State.FAULT and str(error) in self._alarms.latest
