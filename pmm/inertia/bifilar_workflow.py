"""Tare, test, known body and tare again on two lines: inertias about the vertical axis."""

import math
from collections.abc import Sequence

from analysis.inertia.bifilar import yaw_gyradius
from analysis.inertia.corrections import yaw_without_lines
from analysis.inertia.workflow import Step
from analysis.uncertainty.budget import linear_budget
from analysis.uncertainty.estimate import Estimate
from hardware.description.flags import Flag
from pmm.inertia.bifilar_tables import BifilarTable
from pmm.inertia.outcome import Finding
from pmm.inertia.reading import Job
from pmm.inertia.sources import PeriodRuns, read_period
from pmm.inertia.stated_values import given, gravity_of
from pmm.inertia.suspension import Suspended
from pmm.inertia.workflow import guide

_TABLES = {
    Step.TARE: "tare",
    Step.TEST: "suspensions.yaw",
    Step.CHECK: "check",
    Step.TARE_AGAIN: "tare_again",
}
_WORDS = {
    Step.TARE: "empty frame",
    Step.CHECK: "frame with the known body",
    Step.TARE_AGAIN: "empty frame again",
}


def workflow(
    job: Job[BifilarTable],
    hung: Sequence[Suspended],
    findings: list[Finding],
    flags: list[Flag],
    periods: list[PeriodRuns],
) -> str | None:
    """Read the steps beside the test and bring them together; return what is next.

    All steps hang from the lines of the first suspension, so its spacing and length and gravity are
    a scale that they share.
    """
    table = job.table
    if table.tare is None:
        return None
    inertias: dict[Step, Estimate] = {}
    first = hung[0]
    if first.yaw is not None:
        inertias[Step.TEST] = _inertia(job, first, first.yaw, given(table.model, "mass_kg"))
    for step, words in _WORDS.items():
        source = getattr(table, _TABLES[step])
        if source is None:
            continue
        runs = read_period(job, source.period, f"{_TABLES[step]}.period")
        periods.append(runs)
        flags += runs.flags
        inertias[step] = _inertia(job, first, runs.period, given(source, "mass_kg"))
        name = f"{_TABLES[step]}_i_yaw_kg_m2"
        findings.append(Finding(name, f"{words}: yaw inertia", inertias[step]))
    known = None if table.check is None else given(table.check, "known_inertia_kg_m2")
    return guide(
        inertias,
        _TABLES,
        known,
        "the vertical axis",
        findings,
        flags,
        scale_relative=_scale(table, first),
    )


def _inertia(job: Job[BifilarTable], one: Suspended, period: Estimate, mass: Estimate) -> Estimate:
    """Return the inertia of what hangs; only period and mass are in its uncertainty."""
    spacing, line = one.table.half_spacing_m, one.table.line_m
    gravity = gravity_of(job.table).value

    lines_kg = one.table.line_mass_kg

    def inertia(period_s: float, mass_kg: float) -> float:
        on_lines = yaw_gyradius(period_s, spacing, line, gravity)
        own = yaw_without_lines(on_lines, lines_kg / mass_kg, spacing, by_sway=False)
        return mass_kg * own**2

    inputs = {"period_s": period, "mass_kg": mass}
    return linear_budget("I_yaw", inertia, inputs, unit="kg m2").result


def _scale(table: BifilarTable, one: Suspended) -> float:
    """Return what spacing, lines and gravity leave open of every inertia, relative."""
    spacing, line = given(one.table, "half_spacing_m"), given(one.table, "line_m")
    return math.hypot(2.0 * spacing.relative, line.relative, gravity_of(table).relative)
