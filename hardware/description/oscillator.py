"""The oscillator: its plane, its struts and its limits."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType
from typing import Final

from hardware.description.arrangement import Arrangement
from hardware.description.errors import ConfigurationError
from hardware.description.units import STANDARD_GRAVITY_M_S2


class Plane(StrEnum):
    """The plane of motion: heave and pitch, or sway and yaw."""

    VERTICAL = "vertical"
    HORIZONTAL = "horizontal"


@dataclass(frozen=True)
class Range:
    """A closed interval; ``value in range`` asks whether a value lies in it."""

    low: float
    high: float

    def __contains__(self, value: float) -> bool:
        return self.low <= value <= self.high


@dataclass(frozen=True, kw_only=True)
class Oscillator(Arrangement):
    """A two-strut oscillator, with how its struts, gauges and a drift angle are arranged.

    Attributes
    ----------
    half_spacing_m
        Distance ``l`` of each strut from the midpoint; the struts stand at ``x = +l`` (fore) and
        ``x = -l`` (aft).
    rod_length_m
        Length of the connecting rod of a crank and slider; ``None`` for a scotch yoke.
    paths
        Whether each strut can follow a path of its own; ``None`` where nobody has said.
    force_per_strut_n
        Largest force that a motion may ask of one strut, in newtons, as its tared gauge reads it:
        what the strut holds at rest is not in it.
    counterbalanced
        Share of what the struts hold at rest that springs or counterweights bear, 0 to 1; the shaft
        lifts the rest.

    Raises
    ------
    ConfigurationError
        If that share is not between 0 and 1.
    """

    plane: Plane
    half_spacing_m: float
    frequency_hz: Range
    eccentricity_m: Range
    force_per_strut_n: float
    rod_length_m: float | None = None
    paths: bool | None = None
    counterbalanced: float = 0.0

    def __post_init__(self) -> None:
        if not 0.0 <= self.counterbalanced <= 1.0:
            raise ConfigurationError(
                f"oscillator: counterbalanced = {self.counterbalanced:g} is a share of the weight "
                f"and must be between 0 and 1"
            )

    @property
    def lifted(self) -> float:
        """Share of what the struts hold at rest that the shaft lifts."""
        return 1.0 - self.counterbalanced

    @property
    def arrangement(self) -> Arrangement:
        """How struts, gauges and a drift angle are arranged, by itself."""
        return Arrangement(self.joint, self.pivot, self.gauges, self.drift_by)


# The limits of the two rigs of 1963 (Delft). Their strut spacing is not published: 1 m is assumed.
# The force of the horizontal one is not published either: that of the vertical one is taken.
VERTICAL_1963 = Oscillator(
    plane=Plane.VERTICAL,
    half_spacing_m=0.5,
    frequency_hz=Range(0.1, 2.0),
    eccentricity_m=Range(0.0, 0.060),
    force_per_strut_n=50.0 * STANDARD_GRAVITY_M_S2,
)
HORIZONTAL_1963 = Oscillator(
    plane=Plane.HORIZONTAL,
    half_spacing_m=0.5,
    frequency_hz=Range(0.01, 2.0),
    eccentricity_m=Range(0.0, 0.300),
    force_per_strut_n=50.0 * STANDARD_GRAVITY_M_S2,
)

PRESETS: Final[Mapping[str, Oscillator]] = MappingProxyType(
    {"vertical-1963": VERTICAL_1963, "horizontal-1963": HORIZONTAL_1963}
)
