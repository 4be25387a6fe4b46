"""Run control on a page: its states, what may follow each, what a command and a fault may do there.

Nothing is implied: what stands in no table here is refused. ``docs/run-control.md`` shows the same
tables, and a test holds the page to them.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType
from typing import Final

from hardware.description.errors import PmmError
from hardware.errors import Reaction


class State(StrEnum):
    """Where run control stands."""

    IDLE = "idle"
    HOMING = "homing"
    SETTING = "setting"
    PAUSING = "pausing"
    STARTING = "starting"
    SETTLING = "settling"
    ARMED = "armed"
    GATE_OPEN = "gate open"
    HOLD = "hold"
    STOPPING = "stopping"
    DONE = "done"
    STOPPED = "stopped"
    FAULT = "fault"


class Command(StrEnum):
    """What an operator or a console may ask for."""

    START = "start"  # with the first run that is not done
    NEXT = "next"  # end this run where it stands and go on with the next one
    HOLD = "hold"  # close the gate at the next pulse
    RESET = "reset"  # the gate; in a fault, the fault
    STOP = "stop"  # along the profile
    QUICK_STOP = "quick stop"


@dataclass(frozen=True)
class StateRow:
    """A row of the table of states.

    Attributes
    ----------
    happens, ends
        What is done in the state, and what ends it.
    follows
        States that it may be left for; :attr:`State.FAULT` besides, from every other state.
    commands
        What may be commanded in it; :attr:`Command.QUICK_STOP` besides, in every state.
    """

    happens: str
    ends: str
    follows: tuple[State, ...]
    commands: tuple[Command, ...] = ()


_S, _C = State, Command
_LEAVE: Final = (_C.NEXT, _C.STOP)
STATES: Final[Mapping[State, StateRow]] = MappingProxyType(
    {
        _S.IDLE: StateRow("nothing", "*start*", (_S.HOMING,), (_C.START,)),
        _S.HOMING: StateRow(
            "axes under power, homed (manual ones: read)",
            "all are homed",
            (_S.SETTING, _S.STOPPING),
            (_C.STOP,),
        ),
        _S.SETTING: StateRow(
            "what the operator has to do; eccentricity and phase move",
            "both have settled",
            (_S.PAUSING, _S.STOPPING),
            _LEAVE,
        ),
        _S.PAUSING: StateRow(
            "calm water",
            "`pause_s` since shaft and carriage came to rest",
            (_S.STARTING, _S.STOPPING),
            _LEAVE,
        ),
        _S.STARTING: StateRow(
            "the recorder opens; then carriage and shaft run up",
            "the speed is reached",
            (_S.SETTLING, _S.STOPPING),
            _LEAVE,
        ),
        _S.SETTLING: StateRow(
            "the transient dies out", "`settling_periods`", (_S.ARMED, _S.STOPPING), _LEAVE
        ),
        _S.ARMED: StateRow(
            "the gate waits", "a photocell pulse opens it", (_S.GATE_OPEN, _S.STOPPING), _LEAVE
        ),
        _S.GATE_OPEN: StateRow(
            "measuring",
            "the pulse m periods later closes it",
            (_S.HOLD, _S.ARMED, _S.STOPPING),
            (_C.NEXT, _C.HOLD, _C.RESET, _C.STOP),
        ),
        _S.HOLD: StateRow(
            "the last samples come, the reading is final",
            "it is made",
            (_S.STOPPING, _S.ARMED),
            (_C.NEXT, _C.RESET, _C.STOP),
        ),
        _S.STOPPING: StateRow(
            "profile stop, carriage back", "all is at rest", (_S.DONE, _S.STOPPED), (_C.STOP,)
        ),
        _S.DONE: StateRow(
            "the recording is completed", "the next run", (_S.SETTING, _S.STOPPED), (_C.STOP,)
        ),
        _S.STOPPED: StateRow("the operator stopped", "*start*", (_S.HOMING,), (_C.START,)),
        _S.FAULT: StateRow(
            "latched: the axes come to rest, lose their power, the recording is closed",
            "*reset*, at measured rest",
            (_S.IDLE,),
            (_C.RESET,),
        ),
    }
)


@dataclass(frozen=True)
class FaultRow:
    """A row of the table of faults: what one that asks for a reaction leads to.

    Attributes
    ----------
    rig
        What the rig does in the cycle in which the fault is found (:mod:`hardware.rig`).
    control
        What run control does.
    leads_to, within
        The state that follows, from the states in which one does; elsewhere there is an alarm only.
    own_only
        Whether it leads there only where a command of run control's own has failed.
    takes_power
        Whether axes lose their power as soon as they rest, one by one, not when all do.
    axes_heard
        Whether the axes are still heard, so that their rest can be waited for.
    """

    rig: str
    control: str
    leads_to: State
    within: frozenset[State] = frozenset(State)
    own_only: bool = False
    takes_power: bool = False
    axes_heard: bool = True


FAULTS: Final[Mapping[Reaction, FaultRow]] = MappingProxyType(
    {
        Reaction.REFUSE: FaultRow(
            "refuses the command",
            "alarm; a command of its own that is refused ends the run with a profile stop",
            _S.FAULT,
            own_only=True,
        ),
        Reaction.VOID_GATE: FaultRow(
            "nothing",
            "alarm; the gate is void, flagged and armed again; the third void gate is a fault",
            _S.ARMED,
            within=frozenset({_S.ARMED, _S.GATE_OPEN}),
        ),
        Reaction.PROFILE_STOP: FaultRow(
            "stops along the profile", "power off when all axes rest", _S.FAULT
        ),
        Reaction.QUICK_STOP: FaultRow(
            "quick stop", "power off as each axis rests", _S.FAULT, takes_power=True
        ),
        Reaction.END_RUN: FaultRow(
            "quick stop, and the heartbeat stops",
            "as a quick stop; waits 3 s, then says to look",
            _S.FAULT,
            takes_power=True,
            axes_heard=False,
        ),
    }
)


class RunStateError(PmmError):
    """A command that the present state does not allow, or a step that the table does not know."""


def is_allowed(command: Command, state: State) -> bool:
    """Return whether a command is taken in a state."""
    return command is Command.QUICK_STOP or command in STATES[state].commands


class RunStateMachine:
    """Holds the state; refuses what the table does not know."""

    def __init__(self) -> None:
        self.state = State.IDLE

    def go(self, state: State) -> None:
        """Enter a state.

        Raises
        ------
        RunStateError
            If the table has no such step.
        """
        targets = set(STATES[self.state].follows) | ({State.FAULT} - {self.state})
        if state not in targets:
            steps = ", ".join(sorted(targets))
            raise RunStateError(f"no step from {self.state} to {state}; there are {steps}")
        self.state = state

    def check(self, command: Command) -> None:
        """Refuse a command that makes no sense now.

        Raises
        ------
        RunStateError
            If the state does not allow it; the message says which ones do.
        """
        if not is_allowed(command, self.state):
            states = ", ".join(sorted(state for state in State if is_allowed(command, state)))
            raise RunStateError(f"{command} is refused in state {self.state}; possible in {states}")
