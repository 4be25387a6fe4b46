"""The guided workflow of swing and bifilar suspension: tare, test, known body, tare again."""

from collections.abc import Mapping, Sequence

from analysis.inertia.bifilar import yaw_gyradius
from analysis.inertia.corrections import yaw_without_lines
from analysis.inertia.elementary_functions import Value
from analysis.inertia.lengthening import bifilar_lengthening
from analysis.inertia.workflow import Step, StepResult, assess_workflow, next_step
from analysis.uncertainty.budget import derived
from analysis.uncertainty.estimate import Estimate, exactly
from hardware.description.errors import ConfigurationError
from hardware.description.flags import Flag
from pmm.inertia.bifilar_tables import BifilarTable
from pmm.inertia.experiment import Experiment
from pmm.inertia.outcome import Finding
from pmm.inertia.stated_values import gravity_of, stated_value
from pmm.inertia.suspension import SuspensionResult

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


def guide(
    measured: Mapping[Step, Estimate],
    tables: Mapping[Step, str],
    known_inertia: Estimate | None,
    axis: str,
    findings: list[Finding],
    flags: list[Flag],
) -> str | None:
    """Say which step is next, or bring all four together.

    Parameters
    ----------
    measured
        Inertia that each step gave, kg m2.
    tables
        The table of the job's file in which a step stands.
    known_inertia
        The known body's inertia, if the file has it.
    axis
        In words, what the inertias are about.

    Raises
    ------
    ConfigurationError
        If all steps are made but the known body's inertia is not given.
    """
    readings = tuple(StepResult(step, measured[step]) for step in Step if step in measured)
    following = next_step(readings)
    if following is not None:
        step, task = following
        return f"{len(readings) + 1} of {len(Step)}, [{tables[step]}]: {task}"
    if known_inertia is None:
        raise ConfigurationError("the workflow has no known-weight check; add [check]")
    result = assess_workflow(readings, known_inertia)
    flags += result.flags
    findings += [
        Finding("workflow_tare_kg_m2", f"both tares: inertia about {axis}", result.tare),
        Finding("workflow_drift_kg_m2", "second less first tare", result.tare_drift),
        Finding("workflow_model_kg_m2", f"test less tare, about {axis}", result.test_less_tare),
        Finding("workflow_check_kg_m2", f"known body, about {axis}", result.check_less_tare),
        Finding(
            "workflow_normalised_error",
            "known body's error over its interval",
            exactly(result.normalised_error),
        ),
    ]
    return None


def workflow(test: Experiment[BifilarTable], hung: Sequence[SuspensionResult]) -> str | None:
    """Read the steps beside the test and bring them together; return what is next.

    All steps hang from the lines of the first suspension, so they share its spacing and length, and
    gravity.
    """
    table = test.table
    if table.tare is None:
        return None
    inertias: dict[Step, Estimate] = {}
    first = hung[0]
    lines = first.table
    lengthens = bifilar_lengthening(lines.half_spacing_m, lines.line_m, gravity_of(table).value)
    if first.yaw is not None:
        inertias[Step.TEST] = _inertia(
            table, first, first.yaw, stated_value(table.model, "mass_kg", "model")
        )
    for step, words in _WORDS.items():
        source = getattr(table, _TABLES[step])
        if source is None:
            continue
        where = f"{_TABLES[step]}.period"
        period = test.period(source.period, where, lengthens=lengthens).period
        inertias[step] = _inertia(table, first, period, stated_value(source, "mass_kg"))
        name = f"{_TABLES[step]}_i_yaw_kg_m2"
        test.findings.append(Finding(name, f"{words}: yaw inertia", inertias[step]))
    known_inertia = (
        None if table.check is None else stated_value(table.check, "known_inertia_kg_m2")
    )
    return guide(inertias, _TABLES, known_inertia, "the vertical axis", test.findings, test.flags)


def _inertia(
    table: BifilarTable, suspension: SuspensionResult, period: Estimate, mass: Estimate
) -> Estimate:
    """Return the inertia of what hangs."""
    lines = suspension.table

    def inertia(
        period_s: Value, mass_kg: Value, half_spacing_m: Value, line_m: Value, gravity_m_s2: Value
    ) -> Value:
        on_lines = yaw_gyradius(period_s, half_spacing_m, line_m, gravity_m_s2)
        share = lines.line_mass_kg / mass_kg
        gyradius = yaw_without_lines(on_lines, share, half_spacing_m, by_sway=False)
        return mass_kg * gyradius**2

    lengths = {key: stated_value(lines, key, lines.name) for key in ("half_spacing_m", "line_m")}
    inputs = {"period_s": period, "mass_kg": mass, "gravity_m_s2": gravity_of(table)}
    return derived("I_yaw", inertia, "kg m2", **inputs, **lengths)
