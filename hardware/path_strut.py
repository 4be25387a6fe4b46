"""One strut of a rig whose struts follow paths: cyclic synchronous position on a CiA 402 drive."""

from hardware.axis import DriveAxis
from hardware.axis_settings import PositionAxisSettings
from hardware.cia402 import ControlWord, Mode
from hardware.dictionary import Entry
from hardware.drive import TARGET_POSITION
from hardware.driver import Services
from hardware.sdo import Number

_PERIOD, _PERIOD_EXPONENT = Entry(0x60C2, 1), Entry(0x60C2, 2)
_MILLISECONDS = -3


class PathStrut(DriveAxis):
    """A position axis that takes a set-point with every SYNC, and is there at the next one.

    The set-point that is sent after SYNC ``n`` is taken by the drive at SYNC ``n + 1`` and reached
    at SYNC ``n + 2``.
    """

    modes = (Mode.CYCLIC_SYNCHRONOUS_POSITION, Mode.HOMING)

    def __init__(self, name: str, settings: PositionAxisSettings, services: Services) -> None:
        super().__init__(name, settings, services)
        self.settings = settings
        self.drive.node.cyclic = True

    @property
    def near(self) -> float:
        """How far from a set-point it counts as there, in metres."""
        return self.settings.tolerance

    def lead(self, position: float) -> None:
        """Send this cycle's set-point of the strut, in metres."""
        if self.drive.motion.at_rest:
            self.drive.extra = ControlWord(0)  # of a homing that was stopped
        self.drive.mode = Mode.CYCLIC_SYNCHRONOUS_POSITION
        self.drive.node.put(TARGET_POSITION, round(position * self.settings.counts_per_unit))

    def objects(self) -> tuple[tuple[Entry, Number], ...]:
        """Return the axis's settings, and the time from set-point to set-point."""
        period_ms = round(1000.0 / self._rate_hz)
        return (*super().objects(), (_PERIOD, period_ms), (_PERIOD_EXPONENT, _MILLISECONDS))
