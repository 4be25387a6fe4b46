"""``pmm inertia combine`` and ``ballast``: bodies put together, taken off, and weights placed."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from analysis.inertia.ballast import BallastTarget, Weight, place_ballast
from analysis.inertia.parts import PRODUCTS, BodyPart, combine, part
from analysis.inertia.plane_inertia import inertias_at
from analysis.inertia.result import MassProperties
from analysis.inertia.second_moments import impossible_moments
from analysis.uncertainty.estimate import Estimate, exactly
from analysis.uncertainty.monte_carlo import Assessment
from hardware.description.arrays import FloatArray
from hardware.description.flags import Flag, Severity
from hardware.description.oscillator import Plane
from pmm.configuration import STRICT_TABLE
from pmm.inertia.combine_budget import combined_budgets
from pmm.inertia.outcome import Finding, Outcome, PlaneAxes, TargetTable, assessed, compare
from pmm.inertia.properties import AXES, PartTable
from pmm.inertia.reading import one_of, read_job
from pmm.inertia.stated_values import without_uncertainty

Triple = tuple[float, float, float]


@dataclass(frozen=True)
class CombineJob:
    """The file of ``pmm inertia combine``; the datum is the midpoint between the struts."""

    parts: tuple[PartTable, ...]
    without: tuple[PartTable, ...] = ()
    name: str = "combined"
    targets: tuple[TargetTable, ...] = ()
    plane: Plane | None = None

    __pydantic_config__ = STRICT_TABLE

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """Refuse an empty list of parts."""
        if table.get("parts") == []:
            yield "parts", "is empty; add a table [[parts]]"


@dataclass(frozen=True)
class WeightTable:
    """A weight to place: the corners of the box for its centre, or its fixed place."""

    name: str
    mass_kg: float
    low_m: Triple | None = None
    high_m: Triple | None = None
    position_m: Triple | None = None
    gyradii_m: Triple = (0.0, 0.0, 0.0)

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """A box with both corners, or a place."""
        yield from one_of(table, "low_m", "position_m")
        if ("low_m" in table) != ("high_m" in table):
            yield "low_m" if "high_m" in table else "high_m", "is missing: a box has two corners"

    def weight(self) -> Weight:
        """Return it as the solver knows it."""
        low = self.position_m or self.low_m or (0.0, 0.0, 0.0)
        high = self.position_m or self.high_m or low
        return Weight(self.name, self.mass_kg, low, high, self.gyradii_m)


@dataclass(frozen=True)
class WantedTable:
    """What the ballasted model shall have; anything will do where a key is left out."""

    mass_kg: float | None = None
    cg_x_m: float | None = None
    cg_y_m: float | None = None
    cg_z_m: float | None = None
    k_roll_m: float | None = None
    k_pitch_m: float | None = None
    k_yaw_m: float | None = None
    tolerance_kg: float = 0.01
    tolerance_m: float = 0.001

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """Refuse a target that states tolerances alone."""
        if not set(table) - {"tolerance_kg", "tolerance_m"}:
            yield "", "asks for nothing; give mass_kg, cg_x_m ... or k_yaw_m"


@dataclass(frozen=True)
class BallastJob:
    """The file of ``pmm inertia ballast``."""

    base: PartTable
    weights: tuple[WeightTable, ...]
    wanted: WantedTable
    name: str = "ballasted"
    plane: Plane | None = None
    seed: int = 0

    __pydantic_config__ = STRICT_TABLE


def run_combine(path: str) -> Outcome:
    """Put parts together and take others off.

    Raises
    ------
    ConfigurationError, DataError
        If the file is wrong, or no mass would be left.
    """
    table = read_job(path, CombineJob).table
    parts, without = ([row.part() for row in tables] for tables in (table.parts, table.without))
    combined = combine(table.name, parts, without=without)
    findings = _budgeted(_findings(combined), combined_budgets(table.parts, table.without))
    bare = sorted(without_uncertainty(table))
    centres = (row.centre for row in (*table.parts, *table.without))
    redundancies = tuple(centre.redundancy for centre in centres if centre is not None)
    flags = (
        *_exact(bare),
        *(flag for redundancy in redundancies for flag in redundancy.flags()),
        *_impossible([*parts, *without], combined),
    )
    body = _body(table.name, combined, flags)
    checks = compare(findings, table.targets)
    return Outcome(
        "combine",
        table.name,
        findings,
        flags,
        body=body,
        plane=table.plane,
        comparisons=checks,
        axes=_axes(combined),
        redundancy=redundancies,
        tensor=combined,
    )


def _impossible(parts: Sequence[BodyPart], combined: BodyPart) -> tuple[Flag, ...]:
    """Flag parts, or else the whole, with moments that no body has.

    Where some moments of a part were not given the whole lacks them too.
    """
    masks = [body.parameters[4:7] > 0.0 for body in parts]
    flags = tuple(flag for body in parts for flag in impossible_moments(body))
    if flags or any(mask.any() and not mask.all() for mask in masks):
        return flags
    return impossible_moments(combined)


def _budgeted(
    findings: tuple[Finding, ...], budgets: Mapping[str, Assessment]
) -> tuple[Finding, ...]:
    return tuple(
        assessed(finding.name, finding.what, budgets[finding.name])
        if finding.name in budgets
        else finding
        for finding in findings
    )


def _axes(body: BodyPart) -> PlaneAxes | None:
    """Return the principal axes in the centre plane, where the body has an extent in it."""
    mass, xx, zz, xz = (float(body.parameters[k]) for k in (0, 4, 6, 8))
    if min(xx, zz) <= 0.0 or xx == zz:
        return None
    angle = 0.5 * math.atan(2.0 * xz / (zz - xx))
    near_x, near_z = inertias_at(xx, zz, xz, angle)
    if min(near_x, near_z) <= 0.0:
        return None
    roll, _, yaw = body.gyradii
    measured = ((0.0, yaw), (0.5 * math.pi, roll))
    return PlaneAxes(math.sqrt(near_x / mass), math.sqrt(near_z / mass), angle, measured)


def run_ballast(path: str) -> Outcome:
    """Find where the weights go.

    Raises
    ------
    ConfigurationError
        If the file is wrong.
    """
    table = read_job(path, BallastJob).table
    wanted, base = table.wanted, table.base.part()
    target = BallastTarget(
        wanted.mass_kg,
        (wanted.cg_x_m, wanted.cg_y_m, wanted.cg_z_m),
        (wanted.k_roll_m, wanted.k_pitch_m, wanted.k_yaw_m),
        wanted.tolerance_kg,
        wanted.tolerance_m,
    )
    weights = [row.weight() for row in table.weights]
    placement = place_ballast(base, weights, target, seed=table.seed)
    rows = [placement.positions_m[k] for k in range(len(weights))]
    placed = [
        part(
            weight.name,
            exactly(weight.mass_kg, "kg"),
            _exact_place(place),
            _exact_place(weight.gyradii_m),
        )
        for weight, place in zip(weights, rows, strict=True)
    ]
    combined = combine(table.name, [base, *placed])
    findings = _findings(combined)
    flags = () if placement.feasible else (_infeasible(placement.message),)
    return Outcome(
        "ballast",
        table.name,
        findings,
        flags,
        body=_body(table.name, combined, flags) if placement.feasible else None,
        missing=() if placement.feasible else ("a feasible ballasting",),
        plane=table.plane,
        tensor=combined if placement.feasible else None,
        notes=(placement.message,) if placement.feasible else (),
        placements=tuple(
            (weight.name, weight.mass_kg, float(place[0]), float(place[1]), float(place[2]))
            for weight, place in zip(weights, rows, strict=True)
        ),
    )


def _exact_place(triple: Sequence[float] | FloatArray) -> tuple[Estimate, Estimate, Estimate]:
    x, y, z = (exactly(float(value), "m") for value in triple)
    return x, y, z


def _infeasible(message: str) -> Flag:
    return Flag("not_feasible", Severity.VOID, message)


def _exact(bare: list[str]) -> tuple[Flag, ...]:
    if not bare:
        return ()
    message = f"taken to be exact, as no uncertainty stands beside: {', '.join(bare)}"
    return (Flag("no_uncertainty", Severity.NOTE, message),)


def _findings(body: BodyPart) -> tuple[Finding, ...]:
    rows = [Finding("mass_kg", "mass", body.mass)]
    places = zip("xyz", ("forward", "to starboard", "down"), body.centre_of_gravity, strict=True)
    rows += [Finding(f"cg_{axis}_m", f"CG {words}", value) for axis, words, value in places]
    for axis, value in zip(AXES, body.gyradii, strict=True):
        rows.append(Finding(f"k_{axis}_m", f"{axis} gyradius", value))
    for axis, value in zip(AXES, body.inertia, strict=True):
        rows.append(Finding(f"i_{axis}_kg_m2", f"{axis} inertia about the CG", value))
    for key, value in zip(PRODUCTS, body.products, strict=True):
        rows.append(
            Finding(key, f"product of inertia about the CG, sum m {key[1]} {key[2]}", value)
        )
    return tuple(rows)


def _body(name: str, body: BodyPart, flags: tuple[Flag, ...]) -> MassProperties:
    """Return the mass properties; what has no gyradius there was given none."""
    x, y, z = body.centre_of_gravity
    gyradii: dict[str, Estimate] = {
        axis: value for axis, value in zip(AXES, body.gyradii, strict=True) if value.value > 0.0
    }
    if not gyradii:
        gyradii = {"yaw": exactly(0.0, "m")}
    side = abs(y.value) > 2.0 * y.uncertainty + 1e-6
    flag = Flag(
        "cg_off_centre",
        Severity.WARNING,
        f"the centre of gravity lies {1e3 * y.value:.3g} mm off the centre plane; a campaign's "
        "model lies in it",
    )
    return MassProperties(name, body.mass, x, z, gyradii, (), (*flags, *((flag,) if side else ())))
