"""The guided workflow of a swing and of a bifilar suspension: tare, test, known weight, tare."""

from collections.abc import Mapping

from analysis.inertia.workflow import Step, StepResult, assess_workflow, next_step
from analysis.uncertainty.estimate import Estimate, exactly
from hardware.description.errors import ConfigurationError
from hardware.description.flags import Flag
from pmm.inertia.outcome import Finding


def guide(
    measured: Mapping[Step, Estimate],
    tables: Mapping[Step, str],
    known: Estimate | None,
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
    known
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
        step, what = following
        return f"{len(readings) + 1} of {len(Step)}, [{tables[step]}]: {what}"
    if known is None:
        raise ConfigurationError("the workflow has no known-weight check; add [check]")
    found = assess_workflow(readings, known)
    flags += found.flags
    findings += [
        Finding("workflow_tare_kg_m2", f"both tares: inertia about {axis}", found.tare),
        Finding("workflow_drift_kg_m2", "second less first tare", found.tare_drift),
        Finding("workflow_model_kg_m2", f"test less tare, about {axis}", found.test_less_tare),
        Finding("workflow_check_kg_m2", f"known body, about {axis}", found.check_less_tare),
        Finding(
            "workflow_normalised_error",
            "known body's error over its interval",
            exactly(found.normalised_error),
        ),
    ]
    return None
