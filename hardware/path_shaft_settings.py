"""Settings of two struts with drives of their own that follow a path."""

from dataclasses import dataclass

from hardware.axis_settings import PositionAxisSettings
from hardware.description.errors import ConfigurationError
from hardware.limits import check_above_0

STRUTS = ("aft", "fore")


@dataclass(frozen=True)
class PathShaftSettings:
    """Settings of two struts that follow paths.

    Attributes
    ----------
    aft, fore
        Each strut's drive, as an axis in metres whose ``speed`` and ``acceleration`` are the
        strut's largest.
    approach_speed
        At which a strut goes to where its path begins, in m/s.
    encoders
        Whether the drives' positions are recorded as the struts' displacements; ``False`` where
        sensors of their own are.
    """

    aft: PositionAxisSettings
    fore: PositionAxisSettings
    highest_frequency_hz: float
    acceleration_hz_per_s: float
    lowest_frequency_hz: float = 0.0
    approach_speed: float = 0.02
    encoders: bool = True

    def __post_init__(self) -> None:
        check_above_0(self, "highest_frequency_hz", "acceleration_hz_per_s", "approach_speed")
        for name in STRUTS:
            if getattr(self, name).unit != "m":
                raise ConfigurationError(f'{name}.unit has to be "m"')
