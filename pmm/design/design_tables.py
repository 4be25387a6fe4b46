"""The tables of ``design.toml`` beside those of a plan."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from analysis.coefficients.stated_uncertainties import StatedUncertainties
from pmm.configuration import STRICT_TABLE


@dataclass(frozen=True)
class NoiseTable:
    """Noise of the channels, as :class:`analysis.design.noise.Noise` has it.

    Attributes
    ----------
    sample_rate_hz
        At which the standard deviations hold; the rig's own by default.
    """

    force_n: float
    displacement_m: float = 0.0
    corner_hz: float = 0.0
    repeat_relative: float = 0.0
    sample_rate_hz: float | None = None


@dataclass(frozen=True)
class DesignLimits:
    """What the runs may ask for, beside what the rig can do.

    Attributes
    ----------
    time_h
        Tank time of the runs that are chosen.
    rotation_deg
        Largest yaw or pitch, drift or trim in it.
    angle_to_flow_deg
        Largest drift angle or angle of attack.
    w_l_u, w_u_g
        Largest ``omega L / U`` and ``omega U / g``.
    advised
        Whether runs that ``pmm plan check`` would warn of are left out.
    """

    time_h: float | None = None
    rotation_deg: float | None = None
    angle_to_flow_deg: float | None = None
    w_l_u: float | None = None
    w_u_g: float | None = None
    advised: bool = True


@dataclass(frozen=True)
class GapTable:
    """A campaign that is made until it is known why rig and simulation differ.

    Attributes
    ----------
    least_log_odds
        Expected log odds below which a run is not worth making.
    batch
        Runs that are proposed at once, at most.
    effects
        Names to restrict the catalogue to; all of it if there are none.
    """

    least_log_odds: float = 1.0
    batch: int = 1
    effects: tuple[str, ...] = ()


@dataclass(frozen=True)
class DesignTables:
    """All tables of the file that a plan does not have.

    Attributes
    ----------
    believed
        Coefficients by name, SI units: the terms that are fitted; of ``[hull]`` by default.
    targets
        By coefficient, a standard uncertainty or a text in per cent of what is believed.
    stated
        Standard uncertainties that no run lowers; what is 0 is taken from the rig's file.
    gap
        Where the campaign is to find a cause in place of targets.
    """

    noise: NoiseTable
    targets: Mapping[str, float | str] = field(default_factory=dict)
    believed: Mapping[str, float] = field(default_factory=dict)
    stated: StatedUncertainties = field(default_factory=StatedUncertainties)
    limits: DesignLimits = field(default_factory=DesignLimits)
    gap: GapTable | None = None

    __pydantic_config__ = STRICT_TABLE
