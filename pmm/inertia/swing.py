"""``pmm inertia swing``: the empty swing, the swing with a model, and what shows it can be trusted.

Static fits give first moments, records give periods; :mod:`analysis.inertia.swing` does the rest.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from analysis.inertia.lengthening import pendulum_lengthening
from analysis.inertia.swing import SwingInertia, SwingState, model_on_swing, swing_inertia
from analysis.inertia.swing_static import StaticResult, distance
from analysis.inertia.two_pivots import PivotTest, check_two_pivots
from analysis.inertia.workflow import Step
from analysis.uncertainty.estimate import Estimate, difference, exactly
from analysis.uncertainty.redundancy import Redundancy
from hardware.description.flags import Flag, Severity
from hardware.description.oscillator import Plane
from pmm.inertia.air import without_air
from pmm.inertia.experiment import Experiment
from pmm.inertia.first_moment import Moment, displaced_share, first_moment, in_air
from pmm.inertia.outcome import Finding, Outcome, StaticTest, assessed
from pmm.inertia.sketch import about_axis
from pmm.inertia.stated_values import given_or_none, plain_gravity_of, stated_value
from pmm.inertia.swing_tables import StateTable, SwingTable
from pmm.inertia.workflow import guide


@dataclass(frozen=True)
class _MeasuredState:
    """One state, measured."""

    key: str
    state: SwingState
    inertia: SwingInertia
    moment: Moment


def run(path: str) -> Outcome:
    """Do what a swing's file says.

    Raises
    ------
    ConfigurationError, DataError
        If the file is wrong, or the data do not carry what is asked.
    """
    test = Experiment.of(path, SwingTable)
    table = test.table
    states: dict[str, _MeasuredState] = {}
    for key in _STATES:
        if getattr(table, key) is not None:
            states[key] = _measure(test, key, states["tare"].moment if key == "loaded" else None)
    _two_pivots(test, states)
    test.plumb()
    _model(test, states)
    step = _workflow(test, states)
    for measured in states.values():
        if measured.moment.static is not None:
            test.redundancy += _agreements(measured.key, measured.moment.static)
            test.notes += _lever_notes(measured, measured.moment.static)
    upper = table.second_pivot
    test.sketches.append(
        about_axis(
            table.name,
            {_WORDS[key]: states[key].moment.cg.value for key in _DRAWN if key in states},
            {lever.name: (lever.lever_m, lever.drop_m) for lever in table.tare.levers},
            None if upper is None else upper.pivot_distance_m,
        )
    )
    return test.outcome("swing", _PLANES.get(table.model.axis), next_step=step)


def _agreements(key: str, static: StaticResult) -> Iterator[Redundancy]:
    """Yield how a state's tilts and levers agree."""
    for redundancy in static.redundancy:
        yield replace(redundancy, what=f"{key}: {redundancy.what}")


def _lever_notes(measured: _MeasuredState, static: StaticResult) -> Iterator[str]:
    """Say what each lever alone gives."""
    for alone in static.alone:
        cg, offset = distance(alone.moment, measured.state.mass), alone.offset_rad
        yield (
            f"{measured.key}, {alone.series[0]} alone: CG {1e3 * cg.value:.2f} +- "
            f"{1e3 * cg.uncertainty:.2g} mm below the pivot, offset {offset.value:.5f} +- "
            f"{offset.uncertainty:.1g} rad, residual {alone.residual_rms_rad:.1g} rad"
        )


_APART = 3.0  # joint standard uncertainties by which masses may differ
_ROUNDING = 1e-9  # of masses that are stated to be exact
_STATES = ("tare", "loaded", "second_pivot", "check", "tare_again")
_DRAWN = ("tare", "loaded")
_WORDS = {
    "tare": "empty swing",
    "loaded": "swing with model",
    "second_pivot": "empty swing, upper pivot",
    "check": "swing with the known body",
    "tare_again": "empty swing again",
}
_PLANES = {"pitch": Plane.VERTICAL, "yaw": Plane.HORIZONTAL}


def _measure(test: Experiment[SwingTable], key: str, tare: Moment | None) -> _MeasuredState:
    """Read a state; ``tare`` is the empty swing's moment where the model hangs on it."""
    table: StateTable = getattr(test.table, key)
    period = test.period(table.period, f"{key}.period", lengthens=pendulum_lengthening).period
    mass, gravity = stated_value(table, "mass_kg"), plain_gravity_of(test.table)
    moment = first_moment(table, mass)
    if moment.static is not None:
        series = tuple(lever.series() for lever in table.levers)
        test.statics.append(StaticTest(f"{key}.levers", series, moment.static))
        test.flags += moment.static.flags
    displaced = displaced_share(test.table)
    if tare is not None and displaced:
        moment, gravity = in_air(moment, tare, mass, gravity, displaced)
    state = SwingState(period, mass, moment.estimate, gravity)
    inertia = swing_inertia(state, seed=test.table.monte_carlo_seed)
    words = _WORDS[key]
    test.findings += [
        Finding(f"{key}_period_s", f"{words}: period", period),
        Finding(f"{key}_cg_below_pivot_m", f"{words}: CG below the pivot", moment.cg),
        assessed(f"{key}_i_pivot_kg_m2", f"{words}: inertia about the pivot", inertia.about_pivot),
        assessed(f"{key}_i_cg_kg_m2", f"{words}: inertia about its CG", inertia.about_cg),
    ]
    return _MeasuredState(key, state, inertia, moment)


def _two_pivots(test: Experiment[SwingTable], states: Mapping[str, _MeasuredState]) -> None:
    table = test.table
    if table.second_pivot is None:
        return
    first, second = states["tare"], states["second_pivot"]
    result = check_two_pivots(
        PivotTest(first.state.period, first.moment.cg),
        PivotTest(second.state.period, second.moment.cg),
        first.state.mass,
        stated_value(table.second_pivot, "pivot_distance_m"),
        first.state.gravity,
    )
    test.findings += [
        Finding("two_pivots_excess_m", "two pivots: distance too long by", result.distance_excess),
        Finding(
            "two_pivots_difference_kg_m2", "two pivots: inertia differs", result.inertia_difference
        ),
    ]
    test.notes.append(
        f"two pivots: {'pass' if result.passes else 'fail'}; by the periods alone the CG lies "
        f"{result.from_periods_m:.5f} m below the lower one"
    )
    if not result.passes:
        message = "the two pivots disagree; it points to: " + "; or ".join(result.points_to)
        test.flags.append(Flag("two_pivots_disagree", Severity.WARNING, message))


def _model(test: Experiment[SwingTable], states: Mapping[str, _MeasuredState]) -> None:
    """Take the empty swing off the loaded one."""
    if "loaded" not in states:
        test.missing = ("a table [loaded]",)
        return
    table = test.table
    model, loaded = table.model, states["loaded"]
    mass = stated_value(model, "mass_kg", "model")
    result = model_on_swing(
        states["tare"].state,
        loaded.state,
        mass,
        displaced=displaced_share(table),
        seed=table.monte_carlo_seed + 10,
    )
    axis = model.axis
    test.flags += [*result.flags, *_mass_flags(states["tare"].state.mass, loaded.state.mass, mass)]
    gyradius = without_air(table, result.gyradius, depth=result.cg_below_pivot.budget.result)
    in_air = "_in_air" if table.entrained_air is not None else ""
    with_air = ", with its air" if in_air else ""
    test.findings += [
        assessed("cg_below_pivot_m", "model: CG below the pivot", result.cg_below_pivot),
        assessed(
            f"i_{axis}{in_air}_kg_m2",
            f"model: {axis} inertia about its CG{with_air}",
            result.about_cg,
        ),
        assessed(f"k_{axis}{in_air}_m", f"model: {axis} gyradius{with_air}", result.gyradius),
        *([assessed(f"k_{axis}_m", f"model: {axis} gyradius", gyradius)] if in_air else []),
        Finding("share", "model's part of the total inertia", exactly(result.share)),
    ]
    cg_z = None
    above = given_or_none(model, "pivot_above_midpoint_m")
    if above is not None:
        cg_z = difference(result.cg_below_pivot.result, above)
        test.findings.append(Finding("cg_z_m", "model: CG below the struts' midpoint", cg_z))
    parts = (result.cg_below_pivot, result.about_cg, result.gyradius)
    test.weigh({axis: gyradius.result}, [part.budget for part in parts], result.flags, cg_z)


def _mass_flags(tare: Estimate, loaded: Estimate, model: Estimate) -> Iterator[Flag]:
    """Flag a loaded swing whose mass is not the empty one's and the model's."""
    over = difference(difference(loaded, tare), model)
    limit = max(_APART * over.uncertainty, _ROUNDING * loaded.value)
    if abs(over.value) > limit:
        message = (
            f"loaded.mass_kg = {loaded.value:g} kg is {over.value:+.3g} kg off tare.mass_kg = "
            f"{tare.value:g} kg and model.mass_kg = {model.value:g} kg together (limit "
            f"{limit:.2g} kg): loaded is all that hangs, the model included"
        )
        yield Flag("masses_disagree", Severity.WARNING, message)


_STEPS = {
    Step.TARE: "tare",
    Step.TEST: "loaded",
    Step.CHECK: "check",
    Step.TARE_AGAIN: "tare_again",
}


def _workflow(test: Experiment[SwingTable], states: Mapping[str, _MeasuredState]) -> str | None:
    """Say which step is next, or bring all four together."""
    measured = {
        step: states[key].inertia.about_pivot.result
        for step, key in _STEPS.items()
        if key in states
    }
    check = test.table.check
    known_inertia = None if check is None else stated_value(check, "known_inertia_kg_m2")
    return guide(measured, _STEPS, known_inertia, "the pivot", test.findings, test.flags)
