"""What is to be done with each recording of a campaign: plain values that go to any process."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

from analysis.attitude import Attitude, RestPosition
from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.corrections import ZeroReading
from analysis.coefficients.steady_turns import SteadyTurn
from analysis.plausibility import RunHarmonics
from analysis.resolver.harmonics import Harmonics
from analysis.resolver.reference_choice import ReferenceChoice
from analysis.resolver.settings import ResolverSettings
from analysis.response.following import Following
from analysis.response.waves import InWaves
from hardware.description.arrays import FloatArray
from hardware.description.attitude import AttitudeSensors
from hardware.description.flags import Flag, Severity
from hardware.description.heel import Heel
from hardware.description.kinds import RunKind
from hardware.description.oscillator import Oscillator
from hardware.description.setpoint import Medium, SetPoint
from pmm.campaign.calibration import Calibration
from pmm.campaign.campaign import Campaign
from pmm.campaign.recording_source import COMPLETE, RecordingSource
from pmm.campaign.runs import AtRest, Run
from pmm.coefficients.settings import AmplifierTable

_BY_STEERING = "`pmm steering FOLDER` takes such runs"
_LAID = f"it oscillates with a laid rudder; {_BY_STEERING}"
_OTHER_RATE = f"its propeller turns at another rate than in most runs; {_BY_STEERING}"
_NO_STEERING = (
    "it states neither rudder_angle_deg nor revolutions_hz in the campaign file; give them where a "
    "propeller turned or a rudder was there"
)
TOWED = tuple(kind for kind in RunKind if kind.towed)


_OVERTONES: Final = 2
"""Of the highest line: what the products of lines make of angles and loads is resolved so far. At 1
the turning of the gauges is short of them: 2 % of a small coefficient at 7 degrees; at 3 the same
as at 2."""


@dataclass(frozen=True, eq=False)
class Zero:
    """What the gauges read at rest.

    Attributes
    ----------
    utc_s
        Middle of the record, seconds since 1970; ``None`` where the recording does not tell.
    number
        Place among all runs of the campaign; ``None`` where the file does not tell.
    reading
        Its ``at_s`` says nothing.
    drift_rad, heel_rad
        Drift (trim) and heel at which the model stood.
    position
        What the sensors of sinkage and trim read; ``None`` without them.
    """

    name: str
    utc_s: float | None
    number: int | None
    reading: ZeroReading
    drift_rad: float = 0.0
    position: RestPosition | None = None
    heel_rad: float = 0.0


@dataclass(frozen=True, eq=False)
class MeasuringChain:
    """What is known of the measuring chain, the same for all runs.

    Attributes
    ----------
    calibration
        Used in place of the one that a recording carries.
    matrix
        The same by hand: force for a reading, aft and fore.
    amplifiers
        By channel.
    """

    calibration: Calibration | None = None
    matrix: FloatArray | None = None
    amplifiers: Mapping[str, AmplifierTable] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Task:
    """One recording, and all that is needed to make a cycle of it.

    Attributes
    ----------
    set_point
        As the campaign file says, measured where it was; ``None`` for a record at rest.
    zeros
        Before and after; either may be missing.
    tared
        Whether the recording's means are forces as they stand.
    hashed
        Whether the file's SHA-256 is wanted.
    sensors
        Of sinkage and trim; ``None`` where the campaign file states none.
    heel
        How the model heels; ``None`` where the campaign file does not say.
    depth_m
        Of the tank; ``None`` for deep water.
    """

    source: RecordingSource
    kind: RunKind
    oscillator: Oscillator
    set_point: SetPoint
    choice: ReferenceChoice
    settings: ResolverSettings
    number: int | None = None
    chain: MeasuringChain = field(default_factory=MeasuringChain)
    zero_names: tuple[str | None, str | None] = (None, None)
    zeros: tuple[Zero | None, Zero | None] = (None, None)
    tared: bool = False
    hashed: bool = False
    sensors: AttitudeSensors | None = None
    heel: Heel | None = None
    depth_m: float | None = None

    @property
    def name(self) -> str:
        """The run's name."""
        return self.source.name or self.source.path.stem

    def with_zeros(self, zeros: Mapping[str, Zero]) -> "Task":
        """Return the task with the readings of its zero runs."""
        before, after = (None if name is None else zeros.get(name) for name in self.zero_names)
        return replace(self, zeros=(before, after))


@dataclass(frozen=True, eq=False)
class Done:
    """A recording that was read.

    Attributes
    ----------
    cycle
        Motion and loads of the model, gross; ``None`` for a zero run.
    zero
        For a zero run.
    periods, sample_rate_hz, duration_s
        What the cycle rests on.
    sha256
        Of the file, where it was wanted.
    calibration
        What made its readings forces; ``None`` where nothing did, or a matrix by hand.
    seen
        What the checks across all runs look at; ``None`` for a record at rest.
    attitude
        Sinkage and trim; ``None`` without their sensors, in a zero run or without a zero.
    lines
        Of a run of many lines, what was resolved of struts and gauges.
    following
        How each strut followed its set-points; empty where one of both was not recorded.
    carriage
        How a carriage that was led followed its path; empty of others.
    speed_age_u_s
        Of a carriage that was led: what is not known of the age of its recorded speed.
    turn
        Of a run on a circle, what was recorded.
    waves
        Of a run in waves, what these did.
    """

    name: str
    file: str
    cycle: BodyCycle | None
    zero: Zero | None
    periods: int
    sample_rate_hz: float
    duration_s: float
    flags: tuple[Flag, ...] = ()
    sha256: str = ""
    calibration: Calibration | None = None
    seen: RunHarmonics | None = None
    attitude: Attitude | None = None
    lines: Harmonics | None = None
    following: tuple[Following, ...] = ()
    carriage: tuple[Following, ...] = ()
    speed_age_u_s: float = 0.0
    turn: SteadyTurn | None = None
    waves: InWaves | None = None


@dataclass(frozen=True)
class Failed:
    """A recording that could not be used, and why."""

    name: str
    file: str
    message: str
    exit_status: int


@dataclass(frozen=True, eq=False)
class Work:
    """A campaign's recordings, sorted by what they are for.

    Attributes
    ----------
    zeros, runs, dry
        Records at rest without load; runs in water and tows; runs in air.
    not_recorded, left_out
        Names, and for the latter why.
    """

    zeros: tuple[Task, ...]
    runs: tuple[Task, ...]
    dry: tuple[Task, ...]
    not_recorded: tuple[str, ...]
    left_out: tuple[Flag, ...]


def work_of(
    campaign: Campaign,
    folder: Path,
    oscillator: Oscillator,
    chain: MeasuringChain,
    *,
    harmonics: int,
    leave_out: Sequence[str] = (),
    hashed: bool = False,
    with_steering: bool = False,
) -> Work:
    """Sort a campaign's runs and records at rest into tasks.

    Parameters
    ----------
    with_steering
        Whether all runs with a propeller or a rudder are wanted, and not those of the ship as it
        mostly ran.
    """
    settings = replace(campaign.analysis, harmonics=harmonics, gate_periods=None)
    zeros: list[Task] = []
    runs: list[Task] = []
    dry: list[Task] = []
    missing: list[str] = []
    flags: list[Flag] = []
    every: tuple[Run | AtRest, ...] = (*campaign.at_rest, *campaign.runs)
    rates = Counter(one.revolutions_hz for one in every if one.kind.oscillates or one.kind in TOWED)
    usual = rates.most_common(1)[0][0] if rates else 0.0
    for one in every:
        why = _why_not(one, leave_out)
        if why is None and one.kind is not RunKind.ZERO:
            why = _other_steering(one, usual, with_steering=with_steering)
        if why is not None:
            flags += [_left_out(one.name, why)] if why else []
            continue
        source = RecordingSource.of(campaign, one, folder.resolve())
        if not source.path.exists() and isinstance(one, Run) and one.file is None:
            missing.append(one.name)
            continue
        own = campaign.as_recorded(one.name)
        overtones = _OVERTONES * max((line.order for line in one.set_point.lines), default=0)
        task = Task(
            source,
            one.kind,
            own.oscillator or oscillator,
            _set_point(one),
            own.reference,
            replace(settings, harmonics=max(harmonics, overtones)),
            one.number,
            chain,
            (one.zero_before, one.zero_after),
            tared=campaign.tared,
            hashed=hashed,
            sensors=campaign.attitude,
            heel=campaign.heel,
            depth_m=None if campaign.water is None else campaign.water.depth_m,
        )
        kept = zeros if one.kind is RunKind.ZERO else dry if _is_dry(one) else runs
        kept.append(task)
    return Work(tuple(zeros), tuple(runs), tuple(dry), tuple(missing), tuple(flags))


def _other_steering(one: Run | AtRest, usual_hz: float, *, with_steering: bool) -> str | None:
    """Say why a run's rudder or propeller is not as it is wanted, as :func:`_why_not` does."""
    if with_steering:
        return None if one.rudder_angle_rad or one.revolutions_hz else _NO_STEERING
    if one.rudder_angle_rad and one.kind.oscillates:
        return _LAID
    return _OTHER_RATE if one.revolutions_hz != usual_hz else None


def _why_not(one: Run | AtRest, leave_out: Sequence[str]) -> str | None:
    """Say why a run is not used; without words where nobody expects it to be."""
    if one.name in leave_out:
        return "it was asked for"
    if one.outcome != COMPLETE:
        return f"its outcome is {one.outcome!r}"
    if isinstance(one, AtRest) and one.kind not in (RunKind.ZERO, *TOWED):
        return ""
    if one.kind is RunKind.KNOWN_MASS:
        return ""
    return None


def _left_out(name: str, why: str) -> Flag:
    return Flag("run_left_out", Severity.NOTE, f"left out: {why}", None, (name,))


def _is_dry(one: Run | AtRest) -> bool:
    return one.kind is RunKind.DRY or one.medium is Medium.AIR


def _set_point(one: Run | AtRest) -> SetPoint:
    if isinstance(one, AtRest):
        return one.set_point
    medium = Medium.AIR if _is_dry(one) else one.medium
    return replace(one.set_point, medium=medium)
