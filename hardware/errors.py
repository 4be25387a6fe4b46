"""What can go wrong with a rig: one type per situation, each with the reaction that it asks for.

Every class names the situations that raise it. :attr:`HardwareError.reaction` is the row of the
safety table: what has to happen to the rig, whoever notices.
"""

import traceback
from collections.abc import Iterable
from enum import IntEnum
from pathlib import Path
from typing import ClassVar

from hardware.cia402 import ERROR_WORDS
from hardware.description.errors import PmmError


class Reaction(IntEnum):
    """What a fault asks for, from mild to severe; a higher one includes the lower ones."""

    REFUSE = 0  # the command is refused; nothing moves differently
    VOID_GATE = 1  # the measurement in progress is void and flagged
    PROFILE_STOP = 2  # decelerate along the profile, then stand
    QUICK_STOP = 3  # quick stop of all axes
    END_RUN = 4  # the bus is lost: stop the heartbeat, so that the drives stop by themselves


class HardwareError(PmmError):
    """Base of what a device or a bus raises. ``device`` names it as the configuration does."""

    reaction: ClassVar[Reaction] = Reaction.QUICK_STOP

    def __init__(self, device: str, message: str) -> None:
        super().__init__(f"{device}: {message}")
        self.device = device


class BusOpenError(HardwareError):
    """The bus cannot be opened: unknown interface, no such channel, adapter in use."""

    reaction = Reaction.REFUSE


class BusOffError(HardwareError):
    """The controller went bus-off (too many transmit errors), or a frame cannot be sent."""

    reaction = Reaction.END_RUN


class ErrorFramesError(HardwareError):
    """Error frames come faster than good cycles wear them off: a cable or a termination."""

    reaction = Reaction.PROFILE_STOP


class DeadReceiveThreadError(HardwareError):
    """The thread that receives from the bus ended: the adapter raised, or it was stopped."""

    reaction = Reaction.END_RUN


class HeartbeatLostError(HardwareError):
    """A node's heartbeat stayed away for its period and more than the allowed cycles."""


class NodeStateError(HardwareError):
    """A node left the operational state, or booted, while it should operate."""


class ProcessDataLostError(HardwareError):
    """A node answered no SYNC with its process data for more than the allowed cycles."""


class OtherMasterError(HardwareError):
    """Another controller commands the bus: its SYNC, NMT, SDO or process data are heard on it."""

    reaction = Reaction.END_RUN  # its commands may undo ours: the drives stop by themselves too


class EmergencyError(HardwareError):
    """A node sent an emergency message (EMCY) with an error code other than reset.

    ``code`` and ``register`` are those of the message.
    """

    def __init__(self, device: str, code: int, register: int, vendor: bytes = b"") -> None:
        super().__init__(
            device,
            f"emergency 0x{code:04X}{f' ({words})' if (words := ERROR_WORDS.get(code)) else ''} "
            f"(register 0x{register:02X}, vendor {vendor.hex() or '-'}); "
            "clear its cause, then reset the fault",
        )
        self.code = code
        self.register = register


class CycleJumpError(HardwareError):
    """A cycle of the loop came so late that the set-points of a path lost their time."""


class FollowingError(HardwareError):
    """An axis is further from its demand than its window: blocked, overloaded, badly tuned."""


class DriveFaultError(HardwareError):
    """A drive went to FAULT (or FAULT REACTION ACTIVE) by itself."""


class DriveStateError(HardwareError):
    """A drive left the state that it was commanded to: power lost, quick stop input, local key."""


class NotAtRestError(HardwareError):
    """After a stop nothing says that the axes stand: the bus is lost, or a drive does not brake."""


class OverspeedError(HardwareError):
    """The shaft turns faster than it may, in either sense."""


class OverloadError(HardwareError):
    """A gauge carries more than its safe load."""


class TransitionTimeoutError(HardwareError):
    """A drive did not reach the commanded state, position or speed within its cycles."""


class HomingError(HardwareError):
    """A drive reports that homing failed."""


class InterlockError(HardwareError):
    """Eccentricity or phase was to change while the shaft turns, or the shaft while they move."""

    reaction = Reaction.REFUSE


class LimitError(HardwareError):
    """A command lies outside the limits of the configuration."""

    reaction = Reaction.REFUSE


class NotReadyError(HardwareError):
    """A command came before the device was enabled, homed or read, or in a fault."""

    reaction = Reaction.REFUSE


class SdoTimeoutError(HardwareError):
    """A node does not answer an SDO request: not powered, wrong node id, wrong bit rate."""


class SdoAbortError(HardwareError):
    """A node refuses an SDO request; ``code`` is CiA 301's abort code."""

    reaction = Reaction.REFUSE

    def __init__(self, device: str, message: str, code: int) -> None:
        super().__init__(device, message)
        self.code = code


class SdoInCallbackError(HardwareError):
    """An SDO was asked for while frames are being delivered; waiting there would never end."""

    reaction = Reaction.REFUSE


class PortOpenError(HardwareError):
    """A serial port cannot be opened: no such port, in use, no permission."""

    reaction = Reaction.REFUSE


class PortOpeningError(PortOpenError):
    """A serial port is still being opened: its server takes its time, or does not answer."""


class ModbusError(HardwareError):
    """A Modbus device refuses what it is asked: an exception of the protocol, with its code."""

    reaction = Reaction.PROFILE_STOP


class TrackEndError(HardwareError):
    """The carriage comes so near the end of its track that it has to stop now."""

    reaction = Reaction.PROFILE_STOP


class UnpluggedError(HardwareError):
    """A serial port failed while open: unplugged, the device server closed, write timed out."""

    reaction = Reaction.PROFILE_STOP


class SilentPortError(HardwareError):
    """A serial device that talks by itself has said nothing readable for its time."""

    reaction = Reaction.PROFILE_STOP


class LineError(HardwareError):
    """A line from a serial device is no line: wrong checksum, missing field, not a number."""

    reaction = Reaction.VOID_GATE


class PhotocellMissedError(HardwareError):
    """A photocell pulse stayed away: its counter, sequence or the shaft's angle shows it."""

    reaction = Reaction.VOID_GATE


class PhotocellExtraError(HardwareError):
    """A photocell pulse came where none belongs: chatter, stray light, a second slot."""

    reaction = Reaction.VOID_GATE


class PhotocellDeadError(HardwareError):
    """No photocell pulse for several turns: the lamp, the cable or the input is dead."""

    reaction = Reaction.PROFILE_STOP


class BridgeSaturatedError(HardwareError):
    """A force channel is at its full scale, or its amplifier reports overload."""

    reaction = Reaction.PROFILE_STOP


class SensorInvalidError(HardwareError):
    """A sensor reports its value as not valid, or delivers none: broken wire, NaN."""

    reaction = Reaction.PROFILE_STOP


class StuckSensorError(HardwareError):
    """A channel repeats one value bit for bit for longer than its noise could."""

    reaction = Reaction.VOID_GATE


class DialReadingError(HardwareError):
    """An operator's dial reading is no number, or too far from what was asked for."""

    reaction = Reaction.REFUSE


class ProgramError(HardwareError):
    """The program itself failed while it drove the rig: an exception that nobody foresaw."""


def as_fault(device: str, error: Exception) -> HardwareError:
    """Return an exception as a fault: itself if it is one, else the program's own.

    What drives a rig must not end by an exception: nobody would be left to stop the axes.

    Parameters
    ----------
    device
        Whose code raised it, as the configuration names it.
    """
    if isinstance(error, HardwareError):
        return error
    places = traceback.extract_tb(error.__traceback__)
    place = f" ({Path(places[-1].filename).name}:{places[-1].lineno})" if places else ""
    fault = ProgramError(device, f"{type(error).__name__}: {error}{place}")
    fault.__cause__ = error
    return fault


def worst(faults: Iterable[HardwareError]) -> HardwareError:
    """Return the most severe of some faults, the first of equals; the others are its notes."""
    first, *rest = sorted(faults, key=lambda error: -error.reaction)
    for fault in rest:
        first.add_note(f"also: {fault}")
    return first
