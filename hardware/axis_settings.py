"""How a position axis is set: its counts, limits, speeds and homing, each checked by itself."""

from dataclasses import dataclass
from typing import Literal

from hardware.description.errors import ConfigurationError
from hardware.limits import check_above_0, check_ends, check_quick_stop


@dataclass(frozen=True)
class PositionAxisSettings:
    """Settings of an eccentricity (``unit = "m"``) or phase axis (``unit = "rad"``).

    Attributes
    ----------
    counts_per_unit
        Increments of 6064 per metre or radian; negative if the drive counts the other way.
    low, high
        Limits of the position, also written to the drive (607D).
    speed, acceleration, quick_stop
        In units per second and per second squared.
    tolerance, standard_uncertainty
        How near a move has to come, and what is believed of the position afterwards.
    homing_method
        Of 6098; 35 takes the present position for ``home_position``.
    velocity_per_count
        Units of 6081, 6083 and so on for one count per second.
    max_motor_speed_rpm
        The motor's own limit, before any gear (6080); not written where it is not given.
    """

    node: int
    counts_per_unit: float
    low: float
    high: float
    speed: float
    acceleration: float
    quick_stop: float
    tolerance: float
    standard_uncertainty: float
    unit: Literal["m", "rad"] = "m"
    following_error: float = 1e-3
    following_error_ms: int = 20
    homing_method: int = 17
    homing_speed: float = 1e-3
    homing_timeout_s: float = 120.0
    home_position: float = 0.0
    velocity_per_count: float = 1.0
    max_motor_speed_rpm: float | None = None
    eds: str = "cia402-drive.eds"

    def __post_init__(self) -> None:
        check_above_0(self, "speed", "acceleration", "quick_stop", "tolerance", "homing_speed")
        check_quick_stop(self.speed, self.quick_stop, f"{self.unit}/s", "quick_stop")
        check_ends(self.low, self.high)
        furthest = max(abs(self.low), abs(self.high)) * abs(self.counts_per_unit)
        if not 0.0 < furthest < 2**31:
            raise ConfigurationError(
                f"counts_per_unit = {self.counts_per_unit:g} makes {furthest:g} counts of the "
                "furthest limit; it has to be between 0 and 2147483648"
            )
