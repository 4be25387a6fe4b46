"""Reading ``rig.toml``: the devices, the limits, the model, the tank and the recorder."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any

from hardware.description.body import Body
from hardware.description.oscillator import Oscillator
from hardware.rig_configuration import RigConfiguration


@dataclass(frozen=True)
class Tank:
    """The towing tank; ``length_m`` is what the carriage may use, from rest to rest."""

    length_m: float
    width_m: float
    carriage_acceleration_m_s2: float
    highest_speed_m_s: float


@dataclass(frozen=True)
class Limits:
    """What the struts and the shaft may do beyond what the drives' own limits say.

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
    channel
        Its name.
    full_scale_n
        Beyond it the run is stopped on the profile.
    safe_load_n
        Beyond it the axes are stopped quickly; ``None`` for 1.5 times the full scale.
    """

    channel: str
    full_scale_n: float
    safe_load_n: float | None = None


@dataclass(frozen=True)
class StructuralMode:
    """A natural frequency of model and mounting, as the pluck test found it.

    Attributes
    ----------
    damping_ratio
        Part of the critical damping; it sets how near is too near.
    """

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
        Campaign folders are made in it, seen from the rig's file.
    flush_s
        Longest wall time between two flushes.
    reserve_mb
        Disk space that has to stay free.
    """

    folder: str = "."
    flush_s: float = 1.0
    reserve_mb: float = 200.0


@dataclass(frozen=True)
class RigFile:
    """A rig's file, read and checked.

    Attributes
    ----------
    hardware
        The devices, as :class:`hardware.rig.Rig` opens them.
    model
        Mass and inertia, for the estimate of forces; ``None`` where the file does not say.
    gauges
        Ranges of the force channels.
    modes
        Structural modes from a pluck test.
    realtime
        Whether cycles keep to the clock; a simulated rig runs free unless it is asked for.
    campaign
        Tables that are handed on to ``campaign.toml``.
    """

    path: Path
    sha256: str
    oscillator: Oscillator
    hardware: RigConfiguration
    model: Body | None = None
    tank: Tank | None = None
    limits: Limits = field(default_factory=Limits)
    gauges: tuple[Gauge, ...] = ()
    modes: tuple[StructuralMode, ...] = ()
    photocell_offset: PhotocellOffset = field(default_factory=PhotocellOffset)
    recorder: RecorderSettings = field(default_factory=RecorderSettings)
    realtime: bool = True
    campaign: Mapping[str, Any] = field(default_factory=lambda: MappingProxyType({}))


def read_rig_file(path: str | Path) -> RigFile:
    """Read a rig's file.

    Raises
    ------
    ConfigurationError
        With every error of the file.
    """
    raise NotImplementedError(path)
