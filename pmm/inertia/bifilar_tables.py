"""The tables of ``pmm inertia bifilar``'s file."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal

from hardware.description.oscillator import Plane
from pmm.inertia.bifilar_axes import TiltedTable
from pmm.inertia.outcome import TargetTable
from pmm.inertia.properties import ModelTable, PartTable
from pmm.inertia.reading import one_of
from pmm.inertia.sources import PeriodSource


@dataclass(frozen=True)
class YawTable(PeriodSource):
    """Yaw; ``oscillations`` is 2 where its records show sway as well."""

    oscillations: Literal[1, 2] = 1


@dataclass(frozen=True)
class BeatsTable:
    """Counted beats of yaw and sway."""

    oscillations: float
    beats: float
    counting_error: float = 0.5
    yaw_slower: bool = True


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
    """One suspension: lines of length ``line_m``, a distance of twice ``half_spacing_m`` apart."""

    half_spacing_m: float
    line_m: float
    u_half_spacing_m: float = 0.0
    u_line_m: float = 0.0
    name: str = "suspension"
    yaw: YawTable | None = None
    sway: PeriodSource | None = None
    beats: BeatsTable | None = None
    pitch: PendulumTable | None = None
    roll: PendulumTable | None = None

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """Something has to be measured."""
        if not {"yaw", "beats", "pitch", "roll"} & set(table):
            yield "", "measures nothing; add one of yaw, beats, pitch, roll"
        if "pitch" in table and "roll" in table:
            yield "roll", "and pitch are both given; each needs a suspension of its own"


@dataclass(frozen=True)
class BifilarTable:
    """The file of ``pmm inertia bifilar``."""

    suspensions: tuple[SuspensionTable, ...]
    name: str = "bifilar"
    gravity_m_s2: float | None = None
    u_gravity_m_s2: float = 0.0
    air_density_kg_m3: float = 0.0
    body_density_kg_m3: float | None = None
    method: Literal["period", "ratio", "beats"] | None = None
    tilted: tuple[TiltedTable, ...] = ()
    model: ModelTable = field(default_factory=ModelTable)
    take_off: tuple[PartTable, ...] = ()
    targets: tuple[TargetTable, ...] = ()
    plane: Plane | None = None
    monte_carlo_seed: int = 0

    __pydantic_config__: ClassVar = {"extra": "forbid", "allow_inf_nan": False}

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """At least one suspension, each with a name of its own."""
        rows = table.get("suspensions")
        if rows == []:
            yield "suspensions", "is empty; add a table [[suspensions]]"
        named = rows if isinstance(rows, list) else []
        names = [str(one.get("name")) for one in named if isinstance(one, dict)]
        if len(set(names)) < len(names):
            yield "suspensions", "have to have names of their own, each another one"
