"""What run control finds by itself: one type per situation, each with its reaction."""

from hardware.errors import HardwareError, Reaction


class OverloadError(HardwareError):
    """A gauge carries more than its safe load."""

    reaction = Reaction.QUICK_STOP


class OverspeedError(HardwareError):
    """The shaft turns faster than the oscillator may."""

    reaction = Reaction.QUICK_STOP


class PulseOverdueError(HardwareError):
    """No pulse came to open or to close the gate, and no device has said why."""

    reaction = Reaction.PROFILE_STOP


class GateVoidError(HardwareError):
    """The gate was void more often than it is tried again."""

    reaction = Reaction.PROFILE_STOP


class RecordingError(HardwareError):
    """The recorder cannot keep the data any more: disk full, folder gone, permission lost."""

    reaction = Reaction.PROFILE_STOP


class NotAtRestError(HardwareError):
    """After a stop nothing says that the axes stand: the bus is lost, or a drive does not obey."""

    reaction = Reaction.QUICK_STOP


class PushRefusedError(HardwareError):
    """A push test shows swapped cables, a wrong sign, or nothing at all."""

    reaction = Reaction.PROFILE_STOP
