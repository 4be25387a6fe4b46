"""What run control finds by itself: one type per situation, each with its reaction."""

from hardware.errors import HardwareError, Reaction


class FrequencyError(HardwareError):
    """The shaft turns at another frequency than the run's while it is measured."""

    reaction = Reaction.PROFILE_STOP


class CarriageOffSpeedError(HardwareError):
    """The carriage runs at another speed than the run's while it is measured."""

    reaction = Reaction.PROFILE_STOP


class PulseOverdueError(HardwareError):
    """No pulse came to open or to close the gate, and no device has said why."""

    reaction = Reaction.PROFILE_STOP


class GateVoidError(HardwareError):
    """The gate was void more often than it is tried again."""

    reaction = Reaction.PROFILE_STOP


class RecordingError(HardwareError):
    """The recorder cannot keep the data any more: disk full, folder gone, permission lost."""

    reaction = Reaction.PROFILE_STOP


class PushRefusedError(HardwareError):
    """A push test shows swapped cables, a wrong sign, or nothing at all."""

    reaction = Reaction.PROFILE_STOP
