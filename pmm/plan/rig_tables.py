"""The tables of ``rig.toml`` beside those of the devices."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from hardware.description.body import ShipModel
from hardware.description.oscillator import Oscillator
from hardware.description.units import STANDARD_GRAVITY_M_S2
from pmm.configuration import STRICT_TABLE

Matrix = tuple[tuple[float, float], tuple[float, float]]
_NONE: Matrix = ((0.0, 0.0), (0.0, 0.0))
_SAFE_LOAD = 1.5  # of the full scale, where nobody says more


@dataclass(frozen=True)
class HullEstimate:
    """What the water is thought to do, for the estimate of forces; keys as in ``campaign.toml``.

    Rows are force and moment, columns translation and rotation, about the midpoint.
    """

    added_mass: Matrix = _NONE
    damping: Matrix = _NONE
    restoring: Matrix = _NONE


@dataclass(frozen=True)
class TankTable:
    """The towing tank.

    Attributes
    ----------
    length_m
        What the carriage may use, from rest to rest.
    depth_m
        ``None`` for deep water.
    radius_m
        Smallest and largest radius of a circle; ``None`` where nobody says.
    """

    length_m: float
    width_m: float
    carriage_acceleration_m_s2: float
    highest_speed_m_s: float
    depth_m: float | None = None
    radius_m: tuple[float, float] | None = None
    gravity_m_s2: float = STANDARD_GRAVITY_M_S2


@dataclass(frozen=True)
class Limits:
    """What the struts may do, beside the limits of the oscillator and the drives.

    Attributes
    ----------
    stroke_m
        Travel of a strut from end to end: **twice** the largest amplitude.
    velocity_m_s, acceleration_m_s2
        Peak of one strut.
    """

    stroke_m: float | None = None
    velocity_m_s: float | None = None
    acceleration_m_s2: float | None = None


@dataclass(frozen=True)
class Gauge:
    """Range of a force channel.

    Attributes
    ----------
    full_scale_n
        Beyond it a run is stopped on the profile.
    safe_load_n
        Beyond it the axes are stopped quickly.
    """

    channel: str
    full_scale_n: float
    safe_load_n: float | None = None

    @property
    def safe_n(self) -> float:
        """The safe load; 1.5 times the full scale where it is not given."""
        return _SAFE_LOAD * self.full_scale_n if self.safe_load_n is None else self.safe_load_n


@dataclass(frozen=True)
class StructuralMode:
    """A natural frequency of model and mounting, as the pluck test found it."""

    name: str
    frequency_hz: float
    damping_ratio: float = 0.02


@dataclass(frozen=True)
class PhotocellOffset:
    """Shaft angle at the photocell's mark, and the delay of its pulses."""

    angle_offset_rad: float = 0.0
    latency_s: float = 0.0


@dataclass(frozen=True)
class RecorderSettings:
    """Where campaigns are kept, and how often data are flushed.

    Attributes
    ----------
    folder
        Campaign folders are made in it; its path from the rig's file.
    flush_s
        Longest wall time between two flushes.
    reserve_mb
        Disk space that has to stay free.
    """

    folder: str = "."
    flush_s: float = 1.0
    reserve_mb: float = 200.0


@dataclass(frozen=True)
class RigTables:
    """All tables of the file but those of the devices.

    Attributes
    ----------
    realtime
        Whether cycles keep to the clock; by default all rigs do but simulated ones.
    modes_file
        A file with more ``[[modes]]``, as the pluck test writes it; its path from this one.
    calibration_file
        What ``pmm evaluate`` made of check weights; its path from this one.
    reference
        The photocell's calibration.
    campaign
        Tables that ``campaign.toml`` gets as they are.
    """

    oscillator: Oscillator
    name: str = "rig"
    realtime: bool | None = None
    model: ShipModel | None = None
    hull: HullEstimate | None = None
    tank: TankTable | None = None
    limits: Limits = field(default_factory=Limits)
    gauges: tuple[Gauge, ...] = ()
    modes: tuple[StructuralMode, ...] = ()
    modes_file: str | None = None
    calibration_file: str | None = None
    reference: PhotocellOffset = field(default_factory=PhotocellOffset)
    recorder: RecorderSettings = field(default_factory=RecorderSettings)
    campaign: Mapping[str, Any] = field(default_factory=dict)

    __pydantic_config__ = STRICT_TABLE


@dataclass(frozen=True)
class ModesFile:
    """The file that a pluck test writes."""

    modes: tuple[StructuralMode, ...] = ()

    __pydantic_config__ = STRICT_TABLE


# What `[campaign]` may hold: tables of campaign.toml that say nothing about the test itself.
HANDED_ON = (
    "acquisition",
    "analysis",
    "attitude",
    "carriage",
    "cross_flow",
    "drive",
    "dynamometers",
    "effects",
    "forces",
    "heel",
    "heel_loads",
    "linkage_aft",
    "linkage_fore",
    "model_name",
    "model_uncertainty",
    "mounting",
    "photocell",
    "radiation",
    "simulation",
    "squat",
    "steering",
    "surge",
    "tolerances",
    "waves",
)
