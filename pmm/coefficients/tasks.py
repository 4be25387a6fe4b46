"""What is to be done with each recording of a campaign: plain values that go to any process."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from analysis.attitude import Attitude, RestPosition
from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.phasors import Phasors
from analysis.coefficients.steady_turns import SteadyTurn
from analysis.resolver.harmonics import Harmonics
from analysis.resolver.reference_choice import ReferenceChoice
from analysis.resolver.settings import ResolverSettings
from analysis.response.following import Following
from analysis.response.waves import InWaves
from analysis.run_harmonics import RunHarmonics
from hardware.description.arrays import FloatArray
from hardware.description.attitude import AttitudeSensors
from hardware.description.flags import Flag
from hardware.description.heel import Heel
from hardware.description.kinds import RunKind
from hardware.description.oscillator import Oscillator
from hardware.description.setpoint import SetPoint
from pmm.campaign.calibration import Calibration
from pmm.campaign.recording_source import RecordingSource
from pmm.coefficients.settings import AmplifierTable


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
        Means of the channels, as :func:`analysis.coefficients.corrections.zero_reading` has them.
    drift_rad, heel_rad
        Drift (trim) and heel at which the model stood.
    position
        What the sensors of sinkage and trim read; ``None`` without them.
    """

    name: str
    utc_s: float | None
    number: int | None
    reading: Phasors
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
class ReadRecording:
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
    run_harmonics
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
    run_harmonics: RunHarmonics | None = None
    attitude: Attitude | None = None
    lines: Harmonics | None = None
    following: tuple[Following, ...] = ()
    carriage: tuple[Following, ...] = ()
    speed_age_u_s: float = 0.0
    turn: SteadyTurn | None = None
    waves: InWaves | None = None


@dataclass(frozen=True)
class FailedRecording:
    """A recording that could not be used, and why."""

    name: str
    file: str
    message: str
    exit_status: int
