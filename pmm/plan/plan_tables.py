"""The tables of ``plan.toml``."""

import math
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TypeVar

from analysis.water import Water
from hardware.description.kinds import Motion, RunKind
from hardware.description.known_loads import KnownMass
from hardware.description.setpoint import Medium
from pmm.configuration import STRICT_TABLE

T = TypeVar("T")


class Scheme(StrEnum):
    """In which order the runs of a matrix are made."""

    AS_WRITTEN = "as-written"
    RANDOM = "random"
    SNAKE = "snake"  # back and forth: from run to run one setting changes, by one step


@dataclass(frozen=True)
class OrderTable:
    """The order of oscillations, drifts and tows that follow each other in the file.

    Attributes
    ----------
    seed
        Of the random order.
    across_entries
        Whether a random order mixes neighbouring entries, or keeps each together.
    """

    scheme: Scheme = Scheme.AS_WRITTEN
    seed: int = 1
    across_entries: bool = False


@dataclass(frozen=True)
class ZeroTable:
    """Records at rest before, between and after the runs that need the gauges' zero.

    Attributes
    ----------
    every
        So many runs share the zero between two zero runs; 1 has one before and after each run.
    """

    duration_s: float = 20.0
    every: int = 1


@dataclass(frozen=True)
class Defaults:
    """What holds for every entry that does not say otherwise."""

    periods: int = 10
    settling_periods: int = 3
    repeats: int = 1
    pause_s: float = 0.0
    duration_s: float = 20.0
    target_relative: float | None = None
    max_periods: int | None = None


@dataclass(frozen=True)
class PlanEntry:
    """A matrix of runs: every combination of its lists.

    Attributes
    ----------
    name
        What its runs' names begin with; the motion or the kind by default.
    amplitudes_m
        **Amplitudes** of each strut, half the stroke.
    strut_phases_rad
        For the motion ``"phase"``.
    drifts_rad
        Steady drift angles, positive for the bow to starboard.
    rudder_angles_rad, revolutions_hz
        Of the rudder, positive to turn to starboard; of the propeller.
    heels_rad
        Heel angles, positive to starboard.
    radii_m
        Of circles, positive to starboard.
    releases_rad
        Heel angles off its rest from which the model is let go, positive to starboard.
    wave_frequency_hz, wave_amplitude_m, wave_heading_rad
        Of the waves in which all of the entry's runs are made; amplitude is half the height.
    lines
        Harmonics of each frequency, which is the base of a motion of many lines; one run has them
        all, with amplitudes as one over their order.
    sweep
        Lowest and highest harmonic of a sweep that repeats with the base period.
    recorded
        Of the struts over one base period, evenly spaced, in any unit: what a file holds.
    highest
        Harmonic up to which a recorded motion is followed.
    exact
        Whether the struts follow the paths that make the motion pure at any angle.
    steady_ahead
        Whether the carriage's speed follows too, so that the model's along itself is steady.
    channels, loads_n
        Gauges and their loads, of check weights and pushes.
    medium
        Of runs that may be made in either.
    prompt
        What the operator is asked to do before each of its runs.
    """

    kind: RunKind = RunKind.OSCILLATION
    motion: Motion | None = None
    name: str = ""
    frequencies_hz: tuple[float, ...] = ()
    amplitudes_m: tuple[float, ...] = ()
    speeds_m_s: tuple[float, ...] = ()
    strut_phases_rad: tuple[float, ...] = ()
    drifts_rad: tuple[float, ...] = ()
    rudder_angles_rad: tuple[float, ...] = ()
    revolutions_hz: tuple[float, ...] = ()
    heels_rad: tuple[float, ...] = ()
    radii_m: tuple[float, ...] = ()
    releases_rad: tuple[float, ...] = ()
    wave_frequency_hz: float = 0.0
    wave_amplitude_m: float = 0.0
    wave_heading_rad: float = math.pi
    periods: int | None = None
    settling_periods: int | None = None
    repeats: int | None = None
    pause_s: float | None = None
    duration_s: float | None = None
    target_relative: float | None = None
    max_periods: int | None = None
    lines: tuple[int, ...] = ()
    sweep: tuple[int, ...] = ()
    recorded: tuple[float, ...] = ()
    highest: int = 20
    exact: bool = False
    steady_ahead: bool = False
    channels: tuple[str, ...] = ()
    loads_n: tuple[float, ...] = ()
    known_mass: KnownMass | None = None
    medium: Medium | None = None
    prompt: str = ""

    @property
    def many_lines(self) -> str:
        """Which key asks for many lines at once; empty where none does."""
        several = (key for key in ("lines", "sweep", "recorded") if getattr(self, key))
        return next(several, "")


@dataclass(frozen=True)
class ControlTable:
    """The condition that is repeated: before, between and after the oscillations in water.

    Attributes
    ----------
    every
        After how many oscillations it is repeated.
    amplitude_m
        **Amplitude** of each strut.
    """

    motion: Motion
    frequency_hz: float
    amplitude_m: float
    every: int
    speed_m_s: float = 0.0
    strut_phase_rad: float | None = None
    drift_rad: float = 0.0
    periods: int | None = None
    settling_periods: int | None = None
    pause_s: float | None = None

    def entry(self) -> PlanEntry:
        """Return it as an entry of one run."""
        return PlanEntry(
            kind=RunKind.CONTROL,
            motion=self.motion,
            name="control",
            frequencies_hz=(self.frequency_hz,),
            amplitudes_m=(self.amplitude_m,),
            speeds_m_s=(self.speed_m_s,),
            strut_phases_rad=() if self.strut_phase_rad is None else (self.strut_phase_rad,),
            drifts_rad=(self.drift_rad,) if self.drift_rad else (),
            periods=self.periods,
            settling_periods=self.settling_periods,
            repeats=1,
            pause_s=self.pause_s,
        )


@dataclass(frozen=True)
class PlanTables:
    """The whole file.

    Attributes
    ----------
    rig
        The rig's file, its path from this one.
    water
        What the tank is filled with on the day; ``None`` where the file does not say.
    grows
        Whether it changes from run to run: each run keeps to what it was made from.
    """

    name: str = ""
    rig: str = "rig.toml"
    operator: str = ""
    defaults: Defaults = field(default_factory=Defaults)
    order: OrderTable = field(default_factory=OrderTable)
    zero: ZeroTable | None = None
    control: ControlTable | None = None
    water: Water | None = None
    grows: bool = False
    runs: tuple[PlanEntry, ...] = ()

    __pydantic_config__ = STRICT_TABLE


def first_of(value: T | None, default: T) -> T:
    """Return what an entry says, or the default where it says nothing."""
    return default if value is None else value
