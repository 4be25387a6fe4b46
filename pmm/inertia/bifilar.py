"""``pmm inertia bifilar``: yaw, pitch, roll and depth of a body on two lines."""

from collections.abc import Iterator, Mapping
from itertools import combinations

import numpy as np

from analysis.inertia.bifilar import yaw_from_period
from analysis.inertia.spread import SuspensionGyradius, compare_geometries
from analysis.uncertainty.estimate import Estimate, difference, joint
from analysis.uncertainty.monte_carlo import Assessment
from analysis.uncertainty.redundancy import Redundancy, best_fit
from hardware.description.errors import ConfigurationError
from hardware.description.flags import Flag, Severity
from hardware.description.oscillator import Plane
from pmm.inertia.air import without_air
from pmm.inertia.bifilar_axes import plane_axes
from pmm.inertia.bifilar_tables import BifilarTable
from pmm.inertia.experiment import Experiment
from pmm.inertia.lines import line_share, yaw_off_lines
from pmm.inertia.outcome import Finding, Outcome, PlaneAxes, assessed
from pmm.inertia.properties import AXES
from pmm.inertia.sketch import on_two_lines
from pmm.inertia.stated_values import given, gravity_of
from pmm.inertia.suspension import Suspended, hang
from pmm.inertia.workflow import workflow

_APART = 3.0  # joint standard uncertainties that two methods of one suspension may differ by


def run(path: str) -> Outcome:
    """Do what a bifilar suspension's file says.

    Raises
    ------
    ConfigurationError, DataError
        If the file is wrong, or the data do not carry what is asked.
    """
    test = Experiment.of(path, BifilarTable)
    table = test.table
    suspended = [hang(test.job, one) for one in table.suspensions]
    for one in suspended:
        test.findings += _findings(one, several=len(suspended) > 1)
        test.flags += one.flags
        test.periods += one.periods
        depth = one.found.get("depth")
        below_m = None if depth is None else depth.result.value
        held = one.table
        test.sketches.append(on_two_lines(held.name, held.half_spacing_m, held.line_m, below_m))
    gyradii, used = _results(test, suspended)
    test.notes += _air_notes(table, gyradii)
    axes = _tilts(test, gyradii, used)
    step = workflow(test, suspended)
    test.plumb()
    test.weigh(gyradii, [one.budget for one in used.values()], test.flags)
    if test.body is not None and table.take_off:
        test.findings += _own_findings(test.body.mass, test.body.gyradii)
    return test.outcome("bifilar", _plane(gyradii), next_step=step, axes=axes)


def _air_notes(table: BifilarTable, gyradii: Mapping[str, Estimate]) -> Iterator[str]:
    """Say which gyradii still have their air in them."""
    left = [axis for axis in ("pitch", "roll") if axis in gyradii]
    if table.entrained_air is not None and left:
        yield f"entrained air is taken off yaw only; {' and '.join(left)} still have theirs"


def _plane(gyradii: Mapping[str, Estimate]) -> Plane | None:
    """Return the plane that the gyradii are for, where there is but one."""
    if ("pitch" in gyradii) == ("yaw" in gyradii):
        return None
    return Plane.VERTICAL if "pitch" in gyradii else Plane.HORIZONTAL


def _findings(one: Suspended, *, several: bool) -> Iterator[Finding]:
    where = f"{one.table.name}: " if several else ""
    prefix = f"{one.table.name}_" if several else ""
    for key, assessment in one.found.items():
        if key == "depth":
            yield assessed(f"{prefix}depth_m", f"{where}CG below the suspension", assessment)
        else:
            axis, _, method = key.partition(" by ")
            ending = f"_by_{method}" if method else ""
            by = f" by {method}" if method else ""
            name = f"{prefix}k_{axis}{ending}_m"
            yield assessed(name, f"{where}{axis} gyradius{by}", assessment)


def _results(
    test: Experiment[BifilarTable], hung: list[Suspended]
) -> tuple[dict[str, Estimate], dict[str, Assessment]]:
    """Return each axis' gyradius: of the chosen method, over all suspensions that have it."""
    gyradii: dict[str, Estimate] = {}
    used: dict[str, Assessment] = {}
    for axis in AXES:
        chosen = [
            (one, assessment) for one in hung if (assessment := _chosen(test.table, one, axis))
        ]
        if not chosen:
            continue
        used[axis] = chosen[0][1]
        gyradii[axis] = used[axis].result
        if len(chosen) > 1:
            rows = [
                SuspensionGyradius(
                    one.table.name, found.result, one.table.half_spacing_m, one.table.line_m
                )
                for one, found in chosen
            ]
            spread = compare_geometries(rows, result=f"k_{axis}_m")
            gyradii[axis] = spread.gyradius
            test.flags += spread.flags
            test.redundancy.append(spread.redundancy)
        test.findings = [one for one in test.findings if one.name != f"k_{axis}_m"]
        whole = used[axis] if len(chosen) == 1 else None
        test.findings.append(Finding(f"k_{axis}_m", f"{axis} gyradius", gyradii[axis], whole))
    test.flags += [flag for one in hung for flag in _between_methods(one)]
    test.redundancy += [found for one in hung for found in _methods(one)]
    if len([key for key in hung[0].found if key.startswith("yaw")]) > 1 and "yaw" in used:
        method = next(key for key, one in hung[0].found.items() if one is used["yaw"])
        test.notes.append(f"the {method} is the result (method in the file chooses another)")
    return gyradii, used


def _between_methods(one: Suspended) -> Iterator[Flag]:
    """Flag methods whose yaw gyradii differ by more than three times their joint uncertainty."""
    own = [(key, found.result) for key, found in one.found.items() if key.startswith("yaw by")]
    for (first, a), (second, b) in combinations(own, 2):
        apart = difference(a, b)
        if abs(apart.value) > _APART * apart.uncertainty:
            message = (
                f"{one.table.name}: {first} gives {a.value:.5g} m and {second} {b.value:.5g} m, "
                f"{abs(apart.value):.2g} m apart (limit {_APART * apart.uncertainty:.2g} m, "
                f"{_APART:g} joint standard uncertainties); "
                "check line length (period), sway record (ratio) and count (beats)"
            )
            yield Flag("methods_disagree", Severity.WARNING, message)


def _methods(one: Suspended) -> Iterator[Redundancy]:
    """Yield how the yaw gyradii of several methods agree."""
    own = {key: found.result for key, found in one.found.items() if key.startswith("yaw by")}
    if len(own) > 1:
        ones, whole = np.ones((len(own), 1)), joint(own.values())
        what = f"{one.table.name}: yaw gyradius by several methods"
        yield best_fit(ones, whole, what=what, results=("k_yaw_m",), data=list(own))[1]


def _chosen(table: BifilarTable, one: Suspended, axis: str) -> Assessment | None:
    """Return the method's that the file names, or else the surest."""
    if axis != "yaw":
        return one.found.get(axis)
    if table.method is not None:
        return one.found.get(f"yaw by {table.method}")
    own = [found for key, found in one.found.items() if key.startswith("yaw by")]
    return min(own, key=lambda found: found.result.uncertainty) if own else None


def _tilts(
    test: Experiment[BifilarTable], gyradii: dict[str, Estimate], used: dict[str, Assessment]
) -> PlaneAxes | None:
    """Roll from tilted yaw tests, where it was not measured, and the principal axes."""
    table, level = test.table, gyradii.get("yaw")
    if not table.tilted:
        return None
    if level is None:
        raise ConfigurationError(f"{test.job.path}: tilted needs the level yaw test too; add yaw")
    tilted = []
    for number, one in enumerate(table.tilted, 1):
        runs = test.period(one, f"tilted[{number}]")
        at = next((s for s in table.suspensions if s.yaw is not None), table.suspensions[0])
        spacing, line = (
            given(at, key, at.name) if getattr(one, key) is None else given(one, key)
            for key in ("half_spacing_m", "line_m")
        )
        own = yaw_from_period(runs.period, spacing, line, gravity_of(table))
        if at.line_mass_kg:
            share = line_share(at, given(table.model, "mass_kg", "model"))
            own = yaw_off_lines(one if one.half_spacing_m else at, share, own)
        gyradius = without_air(table, own).result
        angle = one.angle
        tilted.append((angle, gyradius))
    seed = table.monte_carlo_seed + 30
    found, axes, agreement = plane_axes(level, gyradii.get("roll"), tilted, seed)
    test.findings += found
    test.redundancy += agreement
    test.flags += [flag for one in agreement for flag in one.flags()]
    for row in found:
        if row.name == "k_roll_m" and row.assessment is not None:
            gyradii["roll"], used["roll"] = row.estimate, row.assessment
    return axes


def _own_findings(mass: Estimate, gyradii: Mapping[str, Estimate]) -> list[Finding]:
    """Return what is left after taking parts off, under names of their own."""
    rows = [Finding("own_mass_kg", "model alone: mass", mass)]
    rows += [
        Finding(f"own_k_{axis}_m", f"model alone: {axis} gyradius", value)
        for axis, value in gyradii.items()
    ]
    return rows
