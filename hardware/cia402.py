"""The words of CiA 402: states, commands, modes, and the bits of status and control word."""

from collections.abc import Mapping
from enum import Enum, IntEnum, IntFlag
from types import MappingProxyType
from typing import Final


class DriveState(Enum):
    """The states of the power drive system; the value is (mask, bits) of the status word."""

    NOT_READY_TO_SWITCH_ON = (0x4F, 0x00)
    SWITCH_ON_DISABLED = (0x4F, 0x40)
    READY_TO_SWITCH_ON = (0x6F, 0x21)
    SWITCHED_ON = (0x6F, 0x23)
    OPERATION_ENABLED = (0x6F, 0x27)
    QUICK_STOP_ACTIVE = (0x6F, 0x07)
    FAULT_REACTION_ACTIVE = (0x4F, 0x0F)
    FAULT = (0x4F, 0x08)

    __hash__ = object.__hash__  # in every cycle; of the name, as an Enum's, it costs five times


class DriveCommand(IntEnum):
    """The commands; the value is bits 0 to 3 and 7 of the control word."""

    DISABLE_VOLTAGE = 0x00
    QUICK_STOP = 0x02
    SHUTDOWN = 0x06
    SWITCH_ON = 0x07  # from OPERATION ENABLED the same bits are "disable operation"
    ENABLE_OPERATION = 0x0F
    FAULT_RESET = 0x80  # acts on the rising edge of bit 7


class ControlWord(IntFlag):
    """Bits of the control word (6040) beyond the commands."""

    NEW_SET_POINT = 0x0010  # profile position
    CHANGE_AT_ONCE = 0x0020  # profile position
    START_HOMING = 0x0010  # homing
    HALT = 0x0100


class StatusWord(IntFlag):
    """Bits of the status word (6041) beyond the state."""

    VOLTAGE_ENABLED = 0x0010
    WARNING = 0x0080
    REMOTE = 0x0200
    TARGET_REACHED = 0x0400
    INTERNAL_LIMIT = 0x0800
    SET_POINT_ACKNOWLEDGED = 0x1000  # profile position
    STANDSTILL = 0x1000  # profile velocity
    HOMING_ATTAINED = 0x1000  # homing
    FOLLOWS_COMMAND = 0x1000  # cyclic synchronous position
    FOLLOWING_ERROR = 0x2000  # profile position; maximal slippage in profile velocity
    HOMING_ERROR = 0x2000  # homing


class Mode(IntEnum):
    """Modes of operation (6060, 6061) used here."""

    NONE = 0
    PROFILE_POSITION = 1
    PROFILE_VELOCITY = 3
    HOMING = 6
    CYCLIC_SYNCHRONOUS_POSITION = 8

    @property
    def supported_bit(self) -> int:
        """The mode's bit in the supported drive modes (6502)."""
        return 1 << (self.value - 1)


# Error codes (603F, emergencies) of set-points that do not come as they should, in words.
ERROR_WORDS: Final[Mapping[int, str]] = MappingProxyType(
    {0x8250: "a set-point came too late for its SYNC", 0x8700: "SYNC stayed away or came unevenly"}
)


# The transitions of CiA 402 by number: 0, 1, 13 and 14 are the drive's own.
TRANSITIONS: Final[dict[tuple[DriveState, DriveCommand], tuple[int, DriveState]]] = {
    (DriveState.SWITCH_ON_DISABLED, DriveCommand.SHUTDOWN): (2, DriveState.READY_TO_SWITCH_ON),
    (DriveState.READY_TO_SWITCH_ON, DriveCommand.SWITCH_ON): (3, DriveState.SWITCHED_ON),
    (DriveState.SWITCHED_ON, DriveCommand.ENABLE_OPERATION): (4, DriveState.OPERATION_ENABLED),
    (DriveState.OPERATION_ENABLED, DriveCommand.SWITCH_ON): (5, DriveState.SWITCHED_ON),
    (DriveState.SWITCHED_ON, DriveCommand.SHUTDOWN): (6, DriveState.READY_TO_SWITCH_ON),
    (DriveState.READY_TO_SWITCH_ON, DriveCommand.QUICK_STOP): (7, DriveState.SWITCH_ON_DISABLED),
    (DriveState.READY_TO_SWITCH_ON, DriveCommand.DISABLE_VOLTAGE): (
        7,
        DriveState.SWITCH_ON_DISABLED,
    ),
    (DriveState.OPERATION_ENABLED, DriveCommand.SHUTDOWN): (8, DriveState.READY_TO_SWITCH_ON),
    (DriveState.OPERATION_ENABLED, DriveCommand.DISABLE_VOLTAGE): (
        9,
        DriveState.SWITCH_ON_DISABLED,
    ),
    (DriveState.SWITCHED_ON, DriveCommand.QUICK_STOP): (10, DriveState.SWITCH_ON_DISABLED),
    (DriveState.SWITCHED_ON, DriveCommand.DISABLE_VOLTAGE): (10, DriveState.SWITCH_ON_DISABLED),
    (DriveState.OPERATION_ENABLED, DriveCommand.QUICK_STOP): (11, DriveState.QUICK_STOP_ACTIVE),
    (DriveState.QUICK_STOP_ACTIVE, DriveCommand.DISABLE_VOLTAGE): (
        12,
        DriveState.SWITCH_ON_DISABLED,
    ),
    (DriveState.FAULT, DriveCommand.FAULT_RESET): (15, DriveState.SWITCH_ON_DISABLED),
    (DriveState.QUICK_STOP_ACTIVE, DriveCommand.ENABLE_OPERATION): (
        16,
        DriveState.OPERATION_ENABLED,
    ),
}


def _decode_table() -> tuple[DriveState, ...]:
    """Return the state of each pattern of the status word's low seven bits."""
    table = []
    for word in range(0x80):
        states = [state for state in DriveState if word & state.value[0] == state.value[1]]
        table.append(states[0] if states else DriveState.NOT_READY_TO_SWITCH_ON)
    return tuple(table)


_STATES: Final = _decode_table()


def state_of(status_word: int) -> DriveState:
    """Return the state that a status word (6041) shows."""
    return _STATES[status_word & 0x7F]
