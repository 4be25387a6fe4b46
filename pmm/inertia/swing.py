"""``pmm inertia swing``: the empty swing, the swing with a model, and what shows it can be trusted.

Static fits give first moments, records give periods; :mod:`analysis.inertia.swing` does the rest.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from analysis.inertia.hanging import HangingCentre
from analysis.inertia.result import InertiaResult
from analysis.inertia.swing import (
    SwingInertia,
    SwingState,
    model_on_swing,
    swing_inertia,
)
from analysis.inertia.swing_static import distance
from analysis.inertia.two_pivots import PivotTest, check_two_pivots
from analysis.inertia.workflow import Step
from analysis.uncertainty.estimate import difference, exactly
from analysis.uncertainty.redundancy import Redundancy
from hardware.description.flags import Flag, Severity
from hardware.description.oscillator import Plane
from pmm.inertia.air import without_air
from pmm.inertia.hanging import hung
from pmm.inertia.outcome import Finding, Outcome, StaticTest, assessed, compare, once
from pmm.inertia.properties import properties
from pmm.inertia.reading import Job, read_job
from pmm.inertia.sources import PeriodRuns, read_period
from pmm.inertia.stated_values import flags_of, given, given_or_none, gravity_of
from pmm.inertia.swing_moment import Moment, first_moment
from pmm.inertia.swing_tables import StateTable, SwingTable
from pmm.inertia.workflow import guide


@dataclass(frozen=True)
class _Measured:
    """One state, measured."""

    key: str
    state: SwingState
    runs: PeriodRuns
    inertia: SwingInertia
    moment: Moment
    flags: tuple[Flag, ...]
    static: StaticTest | None = None


def run(path: str) -> Outcome:
    """Do what a swing's file says.

    Raises
    ------
    ConfigurationError, DataError
        If the file is wrong, or the data do not carry what is asked.
    """
    job = read_job(path, SwingTable)
    table = job.table
    states = {key: _measure(job, key) for key in _STATES if getattr(table, key) is not None}
    findings = [one for measured in states.values() for one in _state_findings(measured)]
    flags = [*flags_of(table), *(flag for one in states.values() for flag in one.flags)]
    notes: list[str] = []
    _two_pivots(table, states, findings, notes, flags)
    centre = hung(table, findings, flags)
    body, missing = _model(table, states, findings, flags, centre)
    step = _workflow(table, states, findings, flags)
    return Outcome(
        "swing",
        table.name,
        tuple(findings),
        once(flags),
        tuple(one.runs for one in states.values()),
        body,
        missing,
        table.plane or _PLANES.get(table.model.axis),
        compare(findings, table.targets),
        (*notes, *(line for one in states.values() for line in _lever_notes(one))),
        step,
        statics=tuple(one.static for one in states.values() if one.static is not None),
        redundancy=(
            *(found for one in states.values() for found in _agreements(one)),
            *((centre.redundancy,) if centre else ()),
        ),
    )


def _agreements(one: _Measured) -> Iterator[Redundancy]:
    """Yield how a state's tilts and levers agree."""
    for found in one.static.result.redundancy if one.static is not None else ():
        yield replace(found, what=f"{one.key}: {found.what}")


def _lever_notes(one: _Measured) -> Iterator[str]:
    """Say what each lever alone gives."""
    for alone in one.static.result.alone if one.static is not None else ():
        cg, offset = distance(alone.moment, one.state.mass), alone.offset_rad
        yield (
            f"{one.key}, {alone.series[0]} alone: CG {1e3 * cg.value:.2f} +- "
            f"{1e3 * cg.uncertainty:.2g} mm below the pivot, offset {offset.value:.5f} +- "
            f"{offset.uncertainty:.1g} rad, residual {alone.residual_rms_rad:.1g} rad"
        )


_STATES = ("tare", "loaded", "second_pivot", "check", "tare_again")
_WORDS = {
    "tare": "empty swing",
    "loaded": "swing with model",
    "second_pivot": "empty swing, upper pivot",
    "check": "swing with the known body",
    "tare_again": "empty swing again",
}
_PLANES = {"pitch": Plane.VERTICAL, "yaw": Plane.HORIZONTAL}


def _measure(job: Job[SwingTable], key: str) -> _Measured:
    table: StateTable = getattr(job.table, key)
    runs = read_period(job, table.period, f"{key}.period", pendulum=True)
    mass, gravity = given(table, "mass_kg"), gravity_of(job.table)
    moment = first_moment(table, mass)
    state = SwingState(runs.period, mass, moment.estimate, gravity)
    inertia = swing_inertia(state, seed=job.table.monte_carlo_seed)
    static = moment.static
    flags = (*runs.flags, *(static.flags if static else ()))
    series = tuple(one.series() for one in table.levers)
    test = StaticTest(f"{key}.levers", series, static) if static is not None else None
    return _Measured(key, state, runs, inertia, moment, flags, test)


def _state_findings(one: _Measured) -> Iterator[Finding]:
    words = _WORDS[one.key]
    yield Finding(f"{one.key}_period_s", f"{words}: period", one.runs.period)
    yield Finding(f"{one.key}_cg_below_pivot_m", f"{words}: CG below the pivot", one.moment.cg)
    yield assessed(
        f"{one.key}_i_pivot_kg_m2", f"{words}: inertia about the pivot", one.inertia.about_pivot
    )
    yield assessed(f"{one.key}_i_cg_kg_m2", f"{words}: inertia about its CG", one.inertia.about_cg)


def _two_pivots(
    table: SwingTable,
    states: Mapping[str, _Measured],
    findings: list[Finding],
    notes: list[str],
    flags: list[Flag],
) -> None:
    if table.second_pivot is None:
        return
    first, second = states["tare"], states["second_pivot"]
    found = check_two_pivots(
        PivotTest(first.runs.period, first.moment.cg),
        PivotTest(second.runs.period, second.moment.cg),
        first.state.mass,
        given(table.second_pivot, "pivot_distance_m"),
        first.state.gravity,
    )
    findings.append(
        Finding("two_pivots_excess_m", "two pivots: distance too long by", found.distance_excess)
    )
    findings.append(
        Finding(
            "two_pivots_difference_kg_m2", "two pivots: inertia differs", found.inertia_difference
        )
    )
    notes.append(
        f"two pivots: {'pass' if found.passes else 'fail'}; by the periods alone the CG lies "
        f"{found.from_periods_m:.5f} m below the lower one"
    )
    if not found.passes:
        message = "the two pivots disagree; it points to: " + "; or ".join(found.points_to)
        flags.append(Flag("two_pivots_disagree", Severity.WARNING, message))


def _model(
    table: SwingTable,
    states: Mapping[str, _Measured],
    findings: list[Finding],
    flags: list[Flag],
    centre: HangingCentre | None,
) -> tuple[InertiaResult | None, tuple[str, ...]]:
    if "loaded" not in states:
        return None, ("a table [loaded]",)
    model, loaded = table.model, states["loaded"]
    mass = given(model, "mass_kg", "model")
    found = model_on_swing(
        states["tare"].state,
        loaded.state,
        mass,
        seed=table.monte_carlo_seed + 10,
    )
    axis = model.axis
    flags += found.flags
    own = without_air(table, found.gyradius, depth=found.cg_below_pivot.budget.result)
    in_air = "_in_air" if table.entrained_air is not None else ""
    with_air = ", with its air" if in_air else ""
    findings += [
        assessed("cg_below_pivot_m", "model: CG below the pivot", found.cg_below_pivot),
        assessed(
            f"i_{axis}{in_air}_kg_m2",
            f"model: {axis} inertia about its CG{with_air}",
            found.about_cg,
        ),
        assessed(f"k_{axis}{in_air}_m", f"model: {axis} gyradius{with_air}", found.gyradius),
        *([assessed(f"k_{axis}_m", f"model: {axis} gyradius", own)] if in_air else []),
        Finding("share", "model's part of the total inertia", exactly(found.share)),
    ]
    cg_z = None
    above = given_or_none(model, "pivot_above_midpoint_m")
    if above is not None:
        cg_z = difference(found.cg_below_pivot.result, above)
        findings.append(Finding("cg_z_m", "model: CG below the struts' midpoint", cg_z))
    parts = (found.cg_below_pivot, found.about_cg, found.gyradius)
    return properties(
        table.name,
        model,
        {axis: own.result},
        take_off=table.take_off,
        budgets=[one.budget for one in parts],
        flags=found.flags,
        centre=centre,
        cg_z=cg_z,
    )


_STEPS = {
    Step.TARE: "tare",
    Step.TEST: "loaded",
    Step.CHECK: "check",
    Step.TARE_AGAIN: "tare_again",
}


def _workflow(
    table: SwingTable,
    states: Mapping[str, _Measured],
    findings: list[Finding],
    flags: list[Flag],
) -> str | None:
    """Say which step is next, or bring all four together."""
    measured = {
        step: states[key].inertia.about_pivot.result
        for step, key in _STEPS.items()
        if key in states
    }
    known = None if table.check is None else given(table.check, "known_inertia_kg_m2")
    return guide(measured, _STEPS, known, "the pivot", findings, flags)
