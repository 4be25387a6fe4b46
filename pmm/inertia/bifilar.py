"""``pmm inertia bifilar``: yaw, pitch, roll and depth of a body on two lines."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from analysis.inertia.bifilar import yaw_from_period
from analysis.inertia.lengthening import bifilar_lengthening
from analysis.inertia.spread import SuspensionGyradius, compare_geometries
from analysis.uncertainty.estimate import Estimate, joint
from analysis.uncertainty.monte_carlo import Assessment
from analysis.uncertainty.redundancy import Redundancy, best_fit
from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Plane
from pmm.inertia.air import without_air
from pmm.inertia.bifilar_axes import plane_axes
from pmm.inertia.bifilar_tables import BifilarTable
from pmm.inertia.experiment import Experiment
from pmm.inertia.lines import line_share, yaw_off_lines
from pmm.inertia.outcome import Finding, Outcome, PlaneAxes, assessed
from pmm.inertia.properties import AXES
from pmm.inertia.sketch import on_two_lines
from pmm.inertia.stated_values import gravity_of, stated_value
from pmm.inertia.suspension import SuspensionResult, hang
from pmm.inertia.workflow import workflow

_REMEDY = "; check line length (period), sway record (ratio) and count (beats)"


def run(path: str) -> Outcome:
    """Do what a bifilar suspension's file says.

    Raises
    ------
    ConfigurationError, DataError
        If the file is wrong, or the data do not carry what is asked.
    """
    test = Experiment.of(path, BifilarTable)
    table = test.table
    suspended = [hang(test.job, suspension) for suspension in table.suspensions]
    for suspension in suspended:
        test.findings += _findings(suspension, several=len(suspended) > 1)
        test.flags += suspension.flags
        test.periods += suspension.periods
        depth = suspension.assessments.get("depth")
        below_m = None if depth is None else depth.result.value
        held = suspension.table
        test.sketches.append(on_two_lines(held.name, held.half_spacing_m, held.line_m, below_m))
    gyradii, used = _results(test, suspended)
    test.notes += _air_notes(table, gyradii)
    axes = _tilts(test, gyradii, used)
    step = workflow(test, suspended)
    test.plumb()
    test.weigh(gyradii, [assessment.budget for assessment in used.values()], test.flags)
    if test.body is not None and table.take_off:
        test.findings += _own_findings(test.body.mass, test.body.gyradii)
    return test.outcome("bifilar", _plane(gyradii), next_step=step, axes=axes)


def _air_notes(table: BifilarTable, gyradii: Mapping[str, Estimate]) -> Iterator[str]:
    """Say which results still have their air in them."""
    axes = [axis for axis in ("pitch", "roll") if axis in gyradii]
    if table.tare is not None:
        axes.append("the guided workflow's inertias")
    if table.entrained_air is not None and axes:
        yield f"entrained air is taken off yaw gyradii only; {' and '.join(axes)} still have theirs"


def _plane(gyradii: Mapping[str, Estimate]) -> Plane | None:
    """Return the plane that the gyradii are for, where there is but one."""
    if ("pitch" in gyradii) == ("yaw" in gyradii):
        return None
    return Plane.VERTICAL if "pitch" in gyradii else Plane.HORIZONTAL


def _findings(suspension: SuspensionResult, *, several: bool) -> Iterator[Finding]:
    where = f"{suspension.table.name}: " if several else ""
    prefix = f"{suspension.table.name}_" if several else ""
    for key, assessment in suspension.assessments.items():
        if key == "depth":
            yield assessed(f"{prefix}depth_m", f"{where}CG below the suspension", assessment)
        else:
            axis, _, method = key.partition(" by ")
            ending = f"_by_{method}" if method else ""
            by = f" by {method}" if method else ""
            name = f"{prefix}k_{axis}{ending}_m"
            yield assessed(name, f"{where}{axis} gyradius{by}", assessment)


def _results(
    test: Experiment[BifilarTable], hung: list[SuspensionResult]
) -> tuple[dict[str, Estimate], dict[str, Assessment]]:
    """Return each axis' gyradius: of the chosen method, over all suspensions that have it."""
    gyradii: dict[str, Estimate] = {}
    used: dict[str, Assessment] = {}
    for axis in AXES:
        chosen = [_gyradius(test, suspension, axis) for suspension in hung]
        rows = [row for row in chosen if row is not None]
        if not rows:
            continue
        gyradii[axis], single = rows[0][0].gyradius, rows[0][1]
        if len(rows) > 1:
            spread = compare_geometries([row for row, _ in rows], result=f"k_{axis}_m")
            gyradii[axis], single = spread.gyradius, None
            test.flags += spread.flags
            test.redundancy.append(spread.redundancy)
        if single is not None:
            used[axis] = single
        test.findings = [finding for finding in test.findings if finding.name != f"k_{axis}_m"]
        test.findings.append(Finding(f"k_{axis}_m", f"{axis} gyradius", gyradii[axis], single))
    if len(_by_methods(hung[0])) > 1 and "yaw" in gyradii:
        method = _chosen(test.table, hung[0], "yaw")
        test.notes.append(f"the {method} is the result (method in the file chooses another)")
    return gyradii, used


def _gyradius(
    test: Experiment[BifilarTable], suspension: SuspensionResult, axis: str
) -> tuple[SuspensionGyradius, Assessment | None] | None:
    """Return a suspension's gyradius, and its assessment where that has the same result.

    Where several methods do not agree, their scatter counts beside what is stated, as in
    :func:`analysis.uncertainty.redundancy.best_fit`.
    """
    key = _chosen(test.table, suspension, axis)
    if key is None:
        return None
    assessment: Assessment | None = suspension.assessments[key]
    gyradius, held = suspension.assessments[key].result, suspension.table
    methods = _by_methods(suspension)
    if axis == "yaw" and len(methods) > 1:
        agreement = _agreement(f"{held.name}: yaw gyradius by several methods", methods)
        test.redundancy.append(agreement)
        test.flags += [replace(flag, message=flag.message + _REMEDY) for flag in agreement.flags()]
        if agreement.widening > 1.0:
            scatter = gyradius.uncertainty * math.sqrt(agreement.widening**2 - 1.0)
            gyradius = gyradius.widened(scatter, float(agreement.degrees_of_freedom))
            assessment = None
    row = SuspensionGyradius(held.name, gyradius, held.half_spacing_m, held.line_m)
    return row, assessment


def _by_methods(suspension: SuspensionResult) -> dict[str, Estimate]:
    """Return the yaw gyradii by the methods that the suspension has data for."""
    return {
        key: assessment.result
        for key, assessment in suspension.assessments.items()
        if key.startswith("yaw by")
    }


def _agreement(title: str, methods: Mapping[str, Estimate]) -> Redundancy:
    matrix, measured = np.ones((len(methods), 1)), joint(methods.values())
    return best_fit(matrix, measured, subject=title, results=("k_yaw_m",), data=list(methods))[1]


def _chosen(table: BifilarTable, suspension: SuspensionResult, axis: str) -> str | None:
    """Return the key of the method that the file names, or else of the surest."""
    if axis != "yaw":
        return axis if axis in suspension.assessments else None
    methods = _by_methods(suspension)
    if table.method is not None:
        key = f"yaw by {table.method}"
        return key if key in methods else None
    return min(methods, key=lambda key: methods[key].uncertainty, default=None)


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
    for number, yaw_test in enumerate(table.tilted, 1):
        at = next((s for s in table.suspensions if s.yaw is not None), table.suspensions[0])
        spacing, line = (
            stated_value(at, key, at.name)
            if getattr(yaw_test, key) is None
            else stated_value(yaw_test, key)
            for key in ("half_spacing_m", "line_m")
        )
        gravity = gravity_of(table)
        lengthens = bifilar_lengthening(spacing.value, line.value, gravity.value)
        runs = test.period(yaw_test, f"tilted[{number}]", lengthens=lengthens)
        assessment = yaw_from_period(runs.period, spacing, line, gravity)
        if at.line_mass_kg:
            share = line_share(at, stated_value(table.model, "mass_kg", "model"))
            assessment = yaw_off_lines(
                yaw_test if yaw_test.half_spacing_m else at, share, assessment
            )
        gyradius = without_air(table, assessment).result
        angle = yaw_test.angle
        tilted.append((angle, gyradius))
    seed = table.monte_carlo_seed + 30
    findings, axes, agreement = plane_axes(level, gyradii.get("roll"), tilted, seed)
    test.findings += findings
    test.redundancy += agreement
    test.flags += [flag for redundancy in agreement for flag in redundancy.flags()]
    for row in findings:
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
