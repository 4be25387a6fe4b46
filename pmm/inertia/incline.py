"""``pmm inertia incline``: depth of the centre of gravity from an inclining weight."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from analysis.inertia.inclining_test import incline_from_both_ends, incline_from_one_end
from analysis.uncertainty.estimate import Estimate
from hardware.description.errors import DataError
from hardware.description.flags import Flag
from pmm.configuration import STRICT_TABLE
from pmm.inertia.outcome import Outcome, TargetTable, assessed, compare
from pmm.inertia.reading import one_of, read_job
from pmm.inertia.stated_values import stated_value, without_uncertainty

_LARGEST_RAD = 0.7


@dataclass(frozen=True)
class TiltTable:
    """A tilt under the weight, and how deep below the suspension point the weight hangs."""

    drop_m: float
    u_drop_m: float = 0.0
    tilt_deg: float | None = None
    u_tilt_deg: float = 0.0
    tilt_rad: float | None = None
    u_tilt_rad: float = 0.0

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """Refuse a tilt in no unit, or in both."""
        yield from one_of(table, "tilt_deg", "tilt_rad")


@dataclass(frozen=True)
class OneEnd(TiltTable):
    """The weight at one end, a horizontal distance ``lever_m`` from the suspension point."""

    lever_m: float = 0.0
    u_lever_m: float = 0.0

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """Refuse a table without the lever, besides those of its tilt."""
        yield from TiltTable.rules(table)
        if "lever_m" not in table:
            yield "lever_m", "is missing"


@dataclass(frozen=True)
class BothEnds:
    """The weight at the stern and then at the bow, ``length_m`` apart."""

    length_m: float
    stern: TiltTable
    bow: TiltTable
    u_length_m: float = 0.0


@dataclass(frozen=True)
class InclineJob:
    """The file of ``pmm inertia incline``; gravity cancels."""

    mass_kg: float
    weight_kg: float
    u_mass_kg: float = 0.0
    u_weight_kg: float = 0.0
    name: str = "incline"
    one_end: OneEnd | None = None
    both_ends: BothEnds | None = None
    targets: tuple[TargetTable, ...] = ()
    monte_carlo_seed: int = 0

    __pydantic_config__ = STRICT_TABLE

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """Refuse a file of neither one end nor both ends, or of both tables."""
        yield from one_of(table, "one_end", "both_ends")


def run(path: str) -> Outcome:
    """Do what an incline test's file says.

    Raises
    ------
    ConfigurationError, DataError
        If the file is wrong, or a tilt cannot be.
    """
    table = read_job(path, InclineJob).table
    mass, weight, seed = (
        stated_value(table, "mass_kg"),
        stated_value(table, "weight_kg"),
        table.monte_carlo_seed,
    )
    if table.one_end is not None:
        end = table.one_end
        lever, drop = stated_value(end, "lever_m"), stated_value(end, "drop_m")
        assessment = incline_from_one_end(
            weight, mass, lever, drop, _tilt(end, "one_end"), seed=seed
        )
    else:
        ends = table.both_ends
        if ends is None:
            raise DataError("an incline test needs one end or both")
        drops = (stated_value(ends.stern, "drop_m"), stated_value(ends.bow, "drop_m"))
        tilts = (_tilt(ends.stern, "stern"), _tilt(ends.bow, "bow"))
        length = stated_value(ends, "length_m")
        assessment = incline_from_both_ends(weight, mass, length, drops, tilts, seed=seed)
    findings = (assessed("depth_m", "CG below the suspension point", assessment),)
    return Outcome(
        "incline",
        table.name,
        findings,
        _flags(table),
        comparisons=compare(findings, table.targets),
        missing=("a gyradius",),
    )


def _tilt(table: TiltTable, where: str) -> Estimate:
    """Return a tilt in radians.

    Raises
    ------
    DataError
        If it can only be degrees given as radians.
    """
    tilt = stated_value(table, "tilt_deg" if table.tilt_deg is not None else "tilt_rad")
    if abs(tilt.value) > _LARGEST_RAD:
        raise DataError(
            f"{where}: a tilt of {tilt.value:.3g} rad (limit {_LARGEST_RAD:g}): it seems to be "
            "degrees given as radians; use tilt_deg"
        )
    return tilt


def _flags(table: InclineJob) -> tuple[Flag, ...]:
    from hardware.description.flags import Severity

    bare = ", ".join(without_uncertainty(table))
    message = f"taken to be exact, as no uncertainty stands beside: {bare}"
    return (Flag("no_uncertainty", Severity.NOTE, message),) if bare else ()
