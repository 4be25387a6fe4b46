"""The states of a run and how they may follow each other: one table, nothing implied."""

from collections.abc import Mapping
from enum import StrEnum
from types import MappingProxyType
from typing import Final

from hardware.description.errors import PmmError


class State(StrEnum):
    """Where run control stands."""

    IDLE = "idle"
    HOMING = "homing"
    SETTING = "setting"  # eccentricity, strut phase and whatever the operator has to do
    PAUSING = "pausing"  # for calm water
    STARTING = "starting"  # to speed
    SETTLING = "settling"
    ARMED = "armed"  # waits for the pulse that opens the gate
    GATE_OPEN = "gate open"
    HOLD = "hold"  # the gate is closed and its readings stand
    STOPPING = "stopping"
    DONE = "done"  # with a run; the next one follows, or the plan is done
    STOPPED = "stopped"  # by the operator
    FAULT = "fault"  # latched until the operator resets


class Command(StrEnum):
    """What an operator or a console may ask for."""

    START = "start"  # with the first run that is not done
    NEXT = "next"  # end this run where it stands and go on with the next one
    HOLD = "hold"  # close the gate at the next pulse
    RESET = "reset"  # the gate; in a fault, the fault
    STOP = "stop"  # along the profile
    QUICK_STOP = "quick stop"


class RunStateError(PmmError):
    """A command that the present state does not allow, or a step that the table does not know."""


_ACTIVE: Final = frozenset({State.STOPPING, State.FAULT})
TRANSITIONS: Final[Mapping[State, frozenset[State]]] = MappingProxyType(
    {
        State.IDLE: frozenset({State.HOMING, State.FAULT}),
        State.HOMING: _ACTIVE | {State.SETTING},
        State.SETTING: _ACTIVE | {State.PAUSING},
        State.PAUSING: _ACTIVE | {State.STARTING},
        State.STARTING: _ACTIVE | {State.SETTLING},
        State.SETTLING: _ACTIVE | {State.ARMED},
        State.ARMED: _ACTIVE | {State.GATE_OPEN},
        State.GATE_OPEN: _ACTIVE | {State.HOLD, State.ARMED},
        State.HOLD: _ACTIVE | {State.ARMED},
        State.STOPPING: frozenset({State.DONE, State.STOPPED, State.FAULT}),
        State.DONE: frozenset({State.SETTING, State.STOPPED, State.FAULT}),
        State.STOPPED: frozenset({State.HOMING, State.FAULT}),
        State.FAULT: frozenset({State.IDLE}),
    }
)

_UNDER_WAY: Final = frozenset(State) - {State.IDLE, State.DONE, State.STOPPED, State.FAULT}
ALLOWED: Final[Mapping[Command, frozenset[State]]] = MappingProxyType(
    {
        Command.START: frozenset({State.IDLE, State.STOPPED}),
        Command.NEXT: _UNDER_WAY - {State.HOMING, State.STOPPING},
        Command.HOLD: frozenset({State.GATE_OPEN}),
        Command.RESET: frozenset({State.GATE_OPEN, State.HOLD, State.FAULT}),
        Command.STOP: _UNDER_WAY | {State.DONE},
        Command.QUICK_STOP: frozenset(State),
    }
)


class Machine:
    """Holds the state; refuses what the table does not know.

    Attributes
    ----------
    since
        Number of the cycle in which the state was entered.
    """

    def __init__(self) -> None:
        self.state = State.IDLE
        self.since = 0

    def go(self, state: State, number: int) -> None:
        """Enter a state in cycle ``number``.

        Raises
        ------
        RunStateError
            If the table has no such step.
        """
        if state not in TRANSITIONS[self.state]:
            known = ", ".join(sorted(TRANSITIONS[self.state]))
            raise RunStateError(f"no step from {self.state} to {state}; there are {known}")
        self.state, self.since = state, number

    def check(self, command: Command) -> None:
        """Refuse a command that makes no sense now.

        Raises
        ------
        RunStateError
            If the state does not allow it; the message says which ones do.
        """
        if self.state not in ALLOWED[command]:
            known = ", ".join(sorted(ALLOWED[command]))
            raise RunStateError(f"{command} is refused in state {self.state}; possible in {known}")
