"""A drive's state machine as its controller walks it: from state to state towards a goal.

Nothing here waits, sends or asks for the time. :class:`DriveStateMachine` is ticked once per SYNC
with the status word and returns the control word to send; its deadlines are counted in ticks.
"""

from enum import Enum
from typing import Final

from hardware.cia402 import DriveCommand, DriveState, state_of
from hardware.errors import DriveFaultError, DriveStateError, NotAtRestError, TransitionTimeoutError


class Goal(Enum):
    """The CiA 402 state to which a drive is to be brought."""

    DISABLED = "disabled"  # no torque: SWITCH ON DISABLED
    ENABLED = "enabled"  # OPERATION ENABLED
    QUICK_STOPPED = "quick stopped"  # QUICK STOP ACTIVE, or without power already

    __hash__ = object.__hash__


_FAULTS: Final = (DriveState.FAULT, DriveState.FAULT_REACTION_ACTIVE)
_AT: Final[dict[Goal, tuple[DriveState, ...]]] = {
    Goal.DISABLED: (DriveState.SWITCH_ON_DISABLED, DriveState.NOT_READY_TO_SWITCH_ON),
    Goal.ENABLED: (DriveState.OPERATION_ENABLED,),
    Goal.QUICK_STOPPED: (
        DriveState.QUICK_STOP_ACTIVE,
        DriveState.SWITCH_ON_DISABLED,
        DriveState.NOT_READY_TO_SWITCH_ON,
    ),
}
_UP: Final[dict[DriveState, DriveCommand]] = {
    DriveState.NOT_READY_TO_SWITCH_ON: DriveCommand.DISABLE_VOLTAGE,
    DriveState.SWITCH_ON_DISABLED: DriveCommand.SHUTDOWN,
    DriveState.READY_TO_SWITCH_ON: DriveCommand.SWITCH_ON,
    DriveState.SWITCHED_ON: DriveCommand.ENABLE_OPERATION,
    DriveState.OPERATION_ENABLED: DriveCommand.ENABLE_OPERATION,
    DriveState.QUICK_STOP_ACTIVE: DriveCommand.DISABLE_VOLTAGE,  # transition 16 is optional
}


def next_command(state: DriveState, goal: Goal) -> DriveCommand:
    """Return the command that leads an axis at rest from ``state`` one step towards ``goal``."""
    if goal is Goal.ENABLED:
        return _UP.get(state, DriveCommand.DISABLE_VOLTAGE)
    if goal is Goal.QUICK_STOPPED:
        return DriveCommand.QUICK_STOP
    return DriveCommand.DISABLE_VOLTAGE


class DriveStateMachine:
    """Walks a drive from state to state, one control word a tick.

    Power is taken off an axis at rest only: until then the word is a quick stop, which from every
    state either brakes or leaves the drive without torque. An axis that does not come to rest by
    its deadline loses its power all the same, with an alarm.

    Parameters
    ----------
    name
        The axis, for messages.
    step_cycles
        Ticks that one transition may take.
    rest_cycles
        Ticks that a quick stop may take until the axis rests.

    Attributes
    ----------
    word
        The control word of the last tick.
    """

    def __init__(self, name: str, step_cycles: int, rest_cycles: int) -> None:
        self._name = name
        self._step_cycles = step_cycles
        self._rest_cycles = rest_cycles
        self._waited = self._braked = 0
        self._arrived = False
        self._reset: int | None = None
        self._quiet = False
        self._at_rest = False
        self.goal = Goal.DISABLED
        self.state = DriveState.NOT_READY_TO_SWITCH_ON
        self.word = int(DriveCommand.QUICK_STOP)

    @property
    def arrived(self) -> bool:
        """Whether the last status word showed the goal."""
        return self.state in _AT[self.goal]

    @property
    def faulty(self) -> bool:
        """Whether the drive is in FAULT or on its way there."""
        return self.state in _FAULTS

    def head_for(self, goal: Goal) -> None:
        """Change the goal; the next tick takes the first step.

        An arrival at the old goal is forgotten, so that leaving it is no surprise. A quick stop of
        a drive whose power is to go changes nothing: it brakes already.
        """
        if goal is Goal.QUICK_STOPPED and self.goal is Goal.DISABLED:
            return
        if goal is not self.goal:
            self._braked = 0
        self.goal = goal
        self._waited = 0
        self._arrived = False

    def reset_fault(self) -> None:
        """Send a rising edge of the reset bit in the next two ticks, then stay disabled."""
        self.head_for(Goal.DISABLED)
        self._reset = 0
        self._quiet = False

    def tick(self, status_word: int, *, at_rest: bool) -> int:
        """Take a status word, and whether the axis is at rest; return the control word for it.

        Raises
        ------
        DriveFaultError
            Once per fault, when the drive shows one that no reset is under way for.
        DriveStateError
            If the drive left the goal by itself; the goal becomes ``DISABLED``.
        TransitionTimeoutError
            If a step takes longer than its cycles; the goal becomes ``DISABLED``.
        NotAtRestError
            If the axis has not come to rest by its deadline; the power goes now.
        """
        before, self.state, self._at_rest = self.state, state_of(status_word), at_rest
        edge = 0
        try:
            if self._reset is not None:
                edge = self._resetting(status_word)
            elif self.faulty:
                self._in_fault(status_word)
            else:
                self._pursue(before, status_word)
        finally:
            self.word = self._command() | edge
        return self.word

    def _command(self) -> DriveCommand:
        """Return the next command, or the quick stop that has to come to rest before it."""
        command = next_command(self.state, self.goal)
        braking = not self._at_rest and self._braked <= self._rest_cycles
        return (
            DriveCommand.QUICK_STOP
            if command is DriveCommand.DISABLE_VOLTAGE and braking
            else command
        )

    def _pursue(self, before: DriveState, status_word: int) -> None:
        self._quiet = False
        if self.arrived:
            self._waited, self._arrived, self._braked = 0, True, 0
        elif self._command() is DriveCommand.QUICK_STOP and self.goal is not Goal.QUICK_STOPPED:
            self._brake(status_word)
        else:
            self._under_way(before, status_word)

    def _brake(self, status_word: int) -> None:
        """Wait for rest, which the drive's own state does not show."""
        self._waited = 0
        self._braked += 1
        if self._braked > self._rest_cycles:
            self.goal, self._arrived = Goal.DISABLED, False
            raise NotAtRestError(
                self._name,
                f"not at rest {self._rest_cycles} cycles after its quick stop (status word "
                f"0x{status_word:04X}); its power is taken off and it coasts: look at it, and use "
                "the emergency stop if it turns",
            )

    def _under_way(self, before: DriveState, status_word: int) -> None:
        wanted = self.goal
        if self._arrived:
            self.head_for(Goal.DISABLED)
            raise DriveStateError(
                self._name,
                f"left {wanted.value} for {self.state.name} by itself "
                f"(status word 0x{status_word:04X})",
            )
        self._waited = 0 if self.state is not before else self._waited + 1
        if self._waited > self._step_cycles:
            self.head_for(Goal.DISABLED)
            raise TransitionTimeoutError(
                self._name,
                f"still {self.state.name} (status word 0x{status_word:04X}) after "
                f"{self._step_cycles} cycles on the way to {wanted.value}",
            )

    def _in_fault(self, status_word: int) -> None:
        if not self._quiet:
            self._quiet = True
            self.head_for(Goal.DISABLED)
            raise DriveFaultError(
                self._name, f"{self.state.name} (status word 0x{status_word:04X}); reset it"
            )

    def _resetting(self, status_word: int) -> int:
        """Return no edge once, then bit 7, until the drive has left FAULT."""
        sent, self._reset = self._reset or 0, (self._reset or 0) + 1
        if sent and not self.faulty:
            self._reset = None
            return 0
        if sent > self._step_cycles:
            self._reset, self._quiet = None, True
            raise TransitionTimeoutError(
                self._name,
                f"still {self.state.name} (status word 0x{status_word:04X}) "
                f"{self._step_cycles} cycles after a fault reset",
            )
        return DriveCommand.FAULT_RESET if sent else 0
