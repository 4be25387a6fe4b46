"""What every job ends in: findings with their budgets, checks against targets, and the body."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

from analysis.inertia.parts import BodyPart
from analysis.inertia.result import Comparison, MassProperties, compare_with_target
from analysis.inertia.swing_static import LeverSeries, StaticResult
from analysis.uncertainty.estimate import Estimate
from analysis.uncertainty.monte_carlo import Assessment
from analysis.uncertainty.redundancy import Redundancy
from hardware.description.errors import ConfigurationError
from hardware.description.flags import Flag, Severity
from hardware.description.oscillator import Plane
from pmm.inertia.sketch import Sketch
from pmm.inertia.sources import PeriodRuns


@dataclass(frozen=True)
class TargetTable:
    """A target or a design value: which finding it is for, and how far off is near enough."""

    quantity: str
    value: float
    tolerance: float


@dataclass(frozen=True)
class Finding:
    """One result.

    Attributes
    ----------
    name
        Unique in its outcome, the unit at its end.
    what
        In words.
    assessment
        Its budget and Monte Carlo, where it has them.
    """

    name: str
    what: str
    estimate: Estimate
    assessment: Assessment | None = None


@dataclass(frozen=True)
class PlaneAxes:
    """Principal axes in the centre plane, for the inertia ellipse.

    Attributes
    ----------
    roll_m, yaw_m, angle_rad
        Principal gyradii, and the angle of the principal x axis to the body's.
    measured
        Angle of each axis to body z and gyradius about it, with its uncertainty.
    """

    roll_m: float
    yaw_m: float
    angle_rad: float
    measured: tuple[tuple[float, Estimate], ...]


@dataclass(frozen=True)
class StaticTest:
    """Tilts under weights and what was fitted to them; ``where`` is its place in the file."""

    where: str
    series: tuple[LeverSeries, ...]
    result: StaticResult


@dataclass(frozen=True)
class Outcome:
    """What a job ended in.

    Attributes
    ----------
    job
        ``swing``, ``bifilar`` ...
    periods
        Where the periods come from.
    body
        Mass properties, where all of them are known; otherwise ``missing`` says what is not.
    plane
        For which a campaign's ``[model]`` is written.
    notes
        Lines to be read beside the tables.
    redundancy
        How data agree that are more than the unknowns, beside what the periods have.
    tensor
        Of bodies put together: mass, centre of gravity and all six inertias with their covariance.
    next_step
        Of the guided workflow.
    statics
        Of a swing: its tilts under weights.
    placements
        Of ballast: each weight's name, mass and place.
    line_errors
        Of a plan: line lengths in m, and the gyradius' error per period error by each reading.
    sketches, photo
        The set-up: its geometry, and a picture's file.
    """

    job: str
    name: str
    findings: tuple[Finding, ...]
    flags: tuple[Flag, ...] = ()
    periods: tuple[PeriodRuns, ...] = ()
    body: MassProperties | None = None
    missing: tuple[str, ...] = ()
    plane: Plane | None = None
    comparisons: tuple[Comparison, ...] = ()
    notes: tuple[str, ...] = ()
    next_step: str | None = None
    axes: PlaneAxes | None = None
    line_errors: Mapping[str, Sequence[tuple[float, float]]] | None = None
    statics: tuple[StaticTest, ...] = ()
    placements: tuple[tuple[str, float, float, float, float], ...] = ()
    redundancy: tuple[Redundancy, ...] = ()
    tensor: BodyPart | None = None
    sketches: tuple[Sketch, ...] = ()
    photo: Path | None = None

    @property
    def agreements(self) -> tuple[Redundancy, ...]:
        """How data agree, those of each period first; where more are there than are needed."""
        redundancies = (
            *(redundancy for runs in self.periods for redundancy in runs.redundancy),
            *self.redundancy,
        )
        return tuple(redundancy for redundancy in redundancies if redundancy.degrees_of_freedom)

    @property
    def budgeted(self) -> tuple[tuple[Finding, Assessment], ...]:
        """Findings with an assessment, each assessment once."""
        first: dict[int, tuple[Finding, Assessment]] = {}
        for finding in self.findings:
            if finding.assessment is not None:
                first.setdefault(id(finding.assessment), (finding, finding.assessment))
        return tuple(first.values())

    @property
    def said_no(self) -> bool:
        """Whether a target is missed or a number is not to be used."""
        void = any(flag.severity is Severity.VOID for flag in self.flags)
        return void or any(comparison.verdict == "fail" for comparison in self.comparisons)


def assessed(name: str, words: str, assessment: Assessment) -> Finding:
    """Return a finding with the assessment's own choice of linear budget or Monte Carlo."""
    return Finding(name, words, assessment.result, assessment)


def without_repeats(flags: Sequence[Flag]) -> tuple[Flag, ...]:
    """Return flags without repetitions, what matters most first."""
    order = {Severity.VOID: 0, Severity.WARNING: 1, Severity.NOTE: 2}
    return tuple(sorted(dict.fromkeys(flags), key=lambda flag: order[flag.severity]))


def compare(findings: Sequence[Finding], targets: Sequence[TargetTable]) -> tuple[Comparison, ...]:
    """Compare findings with targets or design values.

    Raises
    ------
    ConfigurationError
        If there is no such finding; the message names the nearest.
    """
    by_name = {finding.name: finding for finding in findings}
    comparisons = []
    for target in targets:
        if target.quantity not in by_name:
            near = get_close_matches(target.quantity, by_name, n=1, cutoff=0.4)
            hint = f"did you mean {near[0]}?" if near else f"found: {', '.join(by_name)}"
            raise ConfigurationError(f"target {target.quantity!r}: nothing of that name; {hint}")
        measured = by_name[target.quantity].estimate
        comparisons.append(
            compare_with_target(target.quantity, measured, target.value, target.tolerance)
        )
    return tuple(comparisons)
