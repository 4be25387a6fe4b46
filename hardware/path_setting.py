"""Eccentricity and strut phase of a path: numbers of the program, set by moving the struts."""

from dataclasses import dataclass
from typing import Literal

from hardware.command_limits import check_move
from hardware.description.oscillator import Range
from hardware.driver import Driver, Services
from hardware.led_shaft import led_shaft
from hardware.limits import check_above_0, check_ends
from hardware.roles import Cycle, Reading, Role


@dataclass(frozen=True)
class PathSettingSettings:
    """Settings of an eccentricity (``unit = "m"``) or strut phase (``unit = "rad"``) of a path.

    Attributes
    ----------
    standard_uncertainty
        Of what the struts make of it, in the unit.
    """

    low: float
    high: float
    standard_uncertainty: float
    unit: Literal["m", "rad"] = "m"

    def __post_init__(self) -> None:
        check_ends(self.low, self.high)
        check_above_0(self, "standard_uncertainty")


class PathSetting:
    """A :class:`hardware.roles.PositionAxis` whose motors are the struts'.

    Raises
    ------
    ConfigurationError
        If the rig's shaft has no struts that follow a path.
    """

    def __init__(self, name: str, settings: PathSettingSettings, services: Services) -> None:
        self.name = name
        self.unit: str = settings.unit
        self.limits = Range(settings.low, settings.high)
        self._settings, self._shaft = settings, led_shaft(name, services)
        self._moved = False

    @property
    def enabled(self) -> bool:
        """Whether the struts hold or move under power."""
        return self._shaft.enabled

    @property
    def homed(self) -> bool:
        """Whether the struts know where they are."""
        return self._shaft.homed

    @property
    def moving(self) -> bool:
        """Whether the struts are homed, or go to another path at rest."""
        return self._shaft.setting

    @property
    def settled(self) -> bool:
        """Whether the struts have come to the path that was asked for last."""
        return self._moved and self._shaft.placed

    @property
    def reading(self) -> Reading | None:
        """What is set; ``None`` before homing."""
        if not self.homed:
            return None
        return Reading(self._value, self._settings.standard_uncertainty, "encoder")

    def enable(self) -> None:
        """Put the struts under power where they stand."""
        if not self._shaft.enabled:
            self._shaft.enable()

    def disable(self) -> None:
        """Take the struts' power off as soon as they are at rest."""
        self._shaft.disable()

    def home(self) -> None:
        """Find the struts' reference positions; once for all settings.

        Raises
        ------
        NotReadyError
            If the struts are not enabled.
        """
        if not self._shaft.setting:
            self._shaft.home()

    def move_to(self, position: float) -> None:
        """Set a value: the struts go to where the path is then.

        Raises
        ------
        LimitError
            If it lies outside the limits (or is no number).
        NotReadyError
            If the struts are not enabled or not homed.
        """
        check_move(self, position)
        self._moved = True
        if self.unit == "m":
            self._shaft.aim(eccentricity_m=position)
        else:
            self._shaft.aim(strut_phase_rad=position)

    def stop(self) -> None:
        """Come to rest on the way."""
        self._moved = self._moved and not self._shaft.setting
        self._shaft.stop()

    def quick_stop(self) -> None:
        """Decelerate on the drives' quick-stop ramps."""
        self._shaft.quick_stop()

    def reset_fault(self) -> None:
        """Nothing of its own: the struts' drives are reset by the shaft."""

    def prepare(self) -> None:
        """Nothing to write."""

    def tick(self, cycle: Cycle) -> None:
        """Nothing of its own: the shaft leads the struts."""

    def close(self) -> None:
        """Nothing to let go of: the bus is the master's."""

    @property
    def _value(self) -> float:
        return self._shaft.eccentricity_m if self.unit == "m" else self._shaft.strut_phase_rad


DRIVER = Driver(Role.POSITION_AXIS, PathSettingSettings, PathSetting)
