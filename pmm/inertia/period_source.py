"""What a file says of a period: records, light gates, a stopwatch, or a number."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from analysis.inertia.repeats import KnownScatter
from analysis.inertia.stopwatch import StopwatchReading
from analysis.uncertainty.estimate import Estimate
from pmm.inertia.reading import one_of
from pmm.inertia.stated_values import stated_value


@dataclass(frozen=True)
class PeriodSource:
    """A period, from one of ``records``, ``gates``, ``stopwatch`` and ``period_s``.

    Attributes
    ----------
    records, channel, sample_rate_hz
        Recordings of the same set-up, one per release, and which channel of them swings.
    inclinometer_radius_m
        Depth below the pivot of the gravity-referenced inclinometer that the records are of: it
        feels the motion too and reads ``alpha (1 - omega^2 r/g)``, which is put right.
    gates, gate_columns, time_column
        Text files of light gates' edges, one per release, and their columns.
    remove_modulation
        Whether to take the sway's modulation out of a single gate's periods (eq 14); the period is
        then that at the record's mean amplitude, not at none.
    stopwatch, reaction_s
        Counted swings, and the standard deviation of a person's start and stop together.
    amplitude_deg, u_amplitude_deg
        Mean amplitude of the swings that were counted, or freed of their modulation: what geometry
        does to their period is taken out.
    period_s, u_period_s, period_degrees_of_freedom
        Known otherwise.
    known_scatter_s, known_scatter_degrees_of_freedom
        Standard deviation of single releases, known from earlier repeats.
    """

    records: tuple[str, ...] = ()
    channel: str | None = None
    sample_rate_hz: float | None = None
    inclinometer_radius_m: float | None = None
    gates: tuple[str, ...] = ()
    gate_columns: tuple[str, ...] = ("State at A", "State at B")
    time_column: str = "Time"
    remove_modulation: bool = False
    stopwatch: tuple[StopwatchReading, ...] = ()
    reaction_s: float = 0.1
    amplitude_deg: float | None = None
    u_amplitude_deg: float = 0.0
    period_s: float | None = None
    u_period_s: float = 0.0
    period_degrees_of_freedom: float | None = None
    known_scatter_s: float | None = None
    known_scatter_degrees_of_freedom: float | None = None

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """Exactly one way; a period known otherwise has an uncertainty."""
        if "inclinometer_radius_m" in table and "records" not in table:
            yield "inclinometer_radius_m", "is for records; there are none"
        is_mean = "stopwatch" in table or table.get("remove_modulation")
        if "amplitude_deg" in table and not is_mean:
            yield (
                "amplitude_deg",
                "is for a stopwatch or remove_modulation; whatever else tells it by itself",
            )
        yield from one_of(table, "records", "gates", "stopwatch", "period_s")
        if "period_s" in table and not table.get("u_period_s"):
            yield (
                "u_period_s",
                "is missing: a period's standard uncertainty, runs' scatter included",
            )

    @property
    def known_scatter(self) -> KnownScatter | None:
        """The scatter of single releases known from earlier."""
        if self.known_scatter_s is None:
            return None
        freedom = self.known_scatter_degrees_of_freedom or float("inf")
        return KnownScatter(self.known_scatter_s, freedom)


@dataclass(frozen=True)
class AngledPeriod(PeriodSource):
    """The period of a body that hangs turned, and its angle."""

    angle_deg: float | None = None
    u_angle_deg: float = 0.0
    angle_rad: float | None = None
    u_angle_rad: float = 0.0

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """One angle, one way to the period."""
        yield from PeriodSource.rules(table)
        yield from one_of(table, "angle_deg", "angle_rad")

    @property
    def angle(self) -> Estimate:
        """The angle in radians, in whichever unit it was stated."""
        return stated_value(self, "angle_deg" if self.angle_deg is not None else "angle_rad")
