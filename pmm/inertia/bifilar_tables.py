"""The tables of ``pmm inertia bifilar``'s file."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from pmm.inertia.air import air_rules
from pmm.inertia.bifilar_axes import TiltedTable
from pmm.inertia.hanging import hanging_rules
from pmm.inertia.job_table import JobTable
from pmm.inertia.lines import line_rules
from pmm.inertia.period_source import PeriodSource
from pmm.inertia.reading import one_of, require_together


@dataclass(frozen=True)
class YawTable(PeriodSource):
    """Yaw; ``oscillations`` is 2 where its records show sway as well."""

    oscillations: Literal[1, 2] = 1


@dataclass(frozen=True)
class BeatsTable:
    """Beats of yaw and sway: counted by a person, or in records.

    Attributes
    ----------
    counting_error
        Largest error of the oscillations over all beats, as counted; records tell their own.
    """

    oscillations: float | None = None
    beats: float | None = None
    records: tuple[str, ...] = ()
    channel: str | None = None
    sample_rate_hz: float | None = None
    counting_error: float | None = None
    yaw_slower: bool = True

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """Refuse counted beats beside records, neither of both, and beats without oscillations."""
        yield from one_of(table, "beats", "records")
        if "records" in table:
            yield from one_of(table, "records", "counting_error", needed=False)
        else:
            yield from require_together(table, "beats", "oscillations")


@dataclass(frozen=True)
class PendulumTable:
    """Pitch and surge (roll and sway): records of both oscillations, or each period by itself."""

    both: PeriodSource | None = None
    slow: PeriodSource | None = None
    fast: PeriodSource | None = None

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """Both oscillations, one way or the other."""
        yield from one_of(table, "both", "slow")
        if "slow" in table and "fast" not in table:
            yield "fast", "is missing beside slow"


@dataclass(frozen=True)
class SuspensionTable:
    """One suspension: lines of length ``line_m``, a distance of twice ``half_spacing_m`` apart.

    Attributes
    ----------
    line_mass_kg
        Of all lines together, with what hangs along them; 0 for light ones.
    """

    half_spacing_m: float
    line_m: float
    u_half_spacing_m: float = 0.0
    u_line_m: float = 0.0
    line_mass_kg: float = 0.0
    u_line_mass_kg: float = 0.0
    name: str = "suspension"
    yaw: YawTable | None = None
    sway: PeriodSource | None = None
    beats: BeatsTable | None = None
    pitch: PendulumTable | None = None
    roll: PendulumTable | None = None

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """Pitch and roll hang in other ways."""
        if "pitch" in table and "roll" in table:
            yield "roll", "and pitch are both given; each needs a suspension of its own"


@dataclass(frozen=True)
class FrameTable:
    """Yaw of the empty frame on the lines of the first suspension: a step of the workflow."""

    period: PeriodSource
    mass_kg: float
    u_mass_kg: float = 0.0


@dataclass(frozen=True)
class KnownTable(FrameTable):
    """The frame with a body of known yaw inertia in the model's place; the mass is of both."""

    known_inertia_kg_m2: float = field(kw_only=True)
    u_known_inertia_kg_m2: float = field(default=0.0, kw_only=True)


@dataclass(frozen=True, kw_only=True)
class BifilarTable(JobTable):
    """The file of ``pmm inertia bifilar``."""

    suspensions: tuple[SuspensionTable, ...]
    name: str = "bifilar"
    method: Literal["period", "ratio", "beats"] | None = None
    tilted: tuple[TiltedTable, ...] = ()
    tare: FrameTable | None = None
    check: KnownTable | None = None
    tare_again: FrameTable | None = None

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """At least one suspension, each with a name of its own; the workflow's order is kept."""
        yield from air_rules(table)
        yield from hanging_rules(table)
        yield from line_rules(table)
        yield from _workflow_rules(table)
        rows = table.get("suspensions")
        if rows == []:
            yield "suspensions", "is empty; add a table [[suspensions]]"
        named = rows if isinstance(rows, list) else []
        for number, row in enumerate(named):
            if isinstance(row, dict) and not _measures(row) and "tare" not in table:
                yield f"suspensions[{number + 1}]", _NOTHING
        names = [str(row.get("name")) for row in named if isinstance(row, dict)]
        if len(set(names)) < len(names):
            yield "suspensions", "have to have names of their own, each another one"


_NOTHING = "measures nothing; add one of yaw, beats, pitch, roll"


def _measures(suspension: Mapping[str, Any]) -> bool:
    return bool({"yaw", "beats", "pitch", "roll"} & set(suspension))


def _workflow_rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    if "tare_again" in table:
        yield from require_together(table, "tare_again", "check")
    if "check" in table:
        yield from require_together(table, "check", "tare")
    rows, model = table.get("suspensions"), table.get("model", {})
    first = rows[0] if isinstance(rows, list) and rows else {}
    if "tare" not in table or not isinstance(first, dict):
        return
    if "yaw" not in first and "check" in table:
        yield "suspensions[1].yaw", "is missing: the test comes before the known body"
    if "yaw" in first and isinstance(model, dict) and "mass_kg" not in model:
        yield "model", "needs mass_kg, of all that hung, for the inertia beside the tare's"
