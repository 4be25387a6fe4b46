"""``pmm inertia pendulum``: a body swinging about one axis, or about two a known distance apart."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal

from analysis.inertia.compound import compound_pendulum, lamboley
from hardware.description.oscillator import Plane
from pmm.inertia.given import flags_of, given, gravity_of
from pmm.inertia.outcome import Outcome, TargetTable, assessed, compare, once
from pmm.inertia.properties import ModelTable, PartTable, properties
from pmm.inertia.reading import one_of, read_job
from pmm.inertia.sources import PeriodSource, read_period


@dataclass(frozen=True)
class SecondAxis:
    """The same body about an axis ``apart_m`` above the first (Lamboley)."""

    period: PeriodSource
    apart_m: float
    u_apart_m: float = 0.0


@dataclass(frozen=True)
class PendulumJob:
    """The file of ``pmm inertia pendulum``.

    Attributes
    ----------
    depth_m
        Of the centre of gravity below the axis.
    pendulum
        Whether the channel is the pendulum's own angle, whose period must lengthen with amplitude.
    """

    period: PeriodSource
    name: str = "pendulum"
    gravity_m_s2: float | None = None
    u_gravity_m_s2: float = 0.0
    air_density_kg_m3: float = 0.0
    body_density_kg_m3: float | None = None
    axis: Literal["roll", "pitch", "yaw"] = "pitch"
    depth_m: float | None = None
    u_depth_m: float = 0.0
    second: SecondAxis | None = None
    model: ModelTable = field(default_factory=ModelTable)
    take_off: tuple[PartTable, ...] = ()
    targets: tuple[TargetTable, ...] = ()
    plane: Plane | None = None
    monte_carlo_seed: int = 0

    __pydantic_config__: ClassVar = {"extra": "forbid", "allow_inf_nan": False}

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """The depth, or a second axis that gives it."""
        yield from one_of(table, "depth_m", "second")


def run(path: str) -> Outcome:
    """Do what a pendulum's file says.

    Raises
    ------
    ConfigurationError, DataError
        If the file is wrong, or the data do not carry what is asked.
    """
    job = read_job(path, PendulumJob)
    table = job.table
    gravity, seed = gravity_of(table), table.monte_carlo_seed
    periods = [read_period(job, table.period, "period", pendulum=True)]
    name, words = f"k_{table.axis}_m", f"{table.axis} gyradius"
    if table.second is None:
        depth = given(table, "depth_m")
        own = compound_pendulum(periods[0].period, depth, gravity, seed=seed)
        findings = [assessed(name, words, own)]
    else:
        periods.append(read_period(job, table.second.period, "second.period", pendulum=True))
        apart = given(table.second, "apart_m")
        below, own = lamboley(periods[0].period, periods[1].period, apart, gravity, seed=seed)
        findings = [assessed("depth_m", "CG below the first axis", below)]
        findings.append(assessed(name, words, own))
    flags = once([*flags_of(table), *(flag for one in periods for flag in one.flags)])
    body, missing = properties(
        table.name,
        table.model,
        {table.axis: own.result},
        take_off=table.take_off,
        budgets=[own.budget],
        flags=flags,
    )
    planes = {"pitch": Plane.VERTICAL, "yaw": Plane.HORIZONTAL}
    return Outcome(
        "pendulum",
        table.name,
        tuple(findings),
        flags,
        tuple(periods),
        body,
        missing,
        table.plane or planes.get(table.axis),
        compare(findings, table.targets),
    )
