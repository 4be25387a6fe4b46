"""The guided workflow: tare, test, known-weight check, tare again."""

import math
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from analysis.uncertainty.estimate import Estimate, difference, joint
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity


class Step(StrEnum):
    """One step, in the order in which they are made."""

    TARE = "tare"
    TEST = "test"
    CHECK = "check"
    TARE_AGAIN = "tare_again"


_PROMPTS = {
    Step.TARE: "Swing the empty rig three times; nothing on it but what stays for the test.",
    Step.TEST: "Mount the model and swing it three times; note its place on the rig.",
    Step.CHECK: "Swing the known body in the model's place; its inertia is on its certificate.",
    Step.TARE_AGAIN: "Take everything off and swing the empty rig again, as at the beginning.",
}


@dataclass(frozen=True)
class StepResult:
    """Result of a step: pivot inertia or first moment, from repeated runs."""

    step: Step
    value: Estimate


@dataclass(frozen=True)
class WorkflowResult:
    """Result of all four steps.

    Attributes
    ----------
    tare
        Mean of both tares; half their difference is in its uncertainty.
    tare_drift
        Second less first tare.
    test_less_tare
        The model's.
    check_less_tare, normalised_error
        The known body's, and its difference from the certificate over the joint interval of 95 %;
        within -1 to 1 it passes.
    passes
        Whether check and drift are in order.
    """

    tare: Estimate
    tare_drift: Estimate
    test_less_tare: Estimate
    check_less_tare: Estimate
    normalised_error: float
    passes: bool
    flags: tuple[Flag, ...]


def next_step(readings: tuple[StepResult, ...]) -> tuple[Step, str] | None:
    """Return the step to make next with what to do, or ``None`` when all are made.

    Raises
    ------
    DataError
        If the steps were made in another order.
    """
    order = tuple(Step)
    made = tuple(reading.step for reading in readings)
    if made != order[: len(made)]:
        raise DataError(
            f"steps made: {', '.join(made)}; the order is {', '.join(order)}: start again at the "
            "first that differs"
        )
    if len(made) == len(order):
        return None
    return order[len(made)], _PROMPTS[order[len(made)]]


def assess_workflow(readings: tuple[StepResult, ...], known_body: Estimate) -> WorkflowResult:
    """Return the result of the four steps.

    Parameters
    ----------
    known_body
        The known body's, on its certificate.

    Raises
    ------
    DataError
        If a step is missing or out of order; the message says what is next.
    """
    following = next_step(readings)
    if following is not None:
        raise DataError(f"the workflow is not done; next: {following[0]}: {following[1]}")
    first, test, check, second = (reading.value for reading in readings)
    drift = difference(second, first)
    mean = Estimate(joint((first, second)).mapped(np.array([[0.5, 0.5]])), first.unit)
    # a drift between the tares may have happened at any time: evenly spread over its half
    tare = mean.widened(abs(0.5 * drift.value) / math.sqrt(3.0))
    model, body = difference(test, tare), difference(check, tare)
    deviation = difference(body, known_body)
    error = deviation.value / deviation.half_width()
    drifted = abs(drift.value) > drift.half_width()
    flags = _flags(drift, drifted, error, body, known_body)
    return WorkflowResult(tare, drift, model, body, error, abs(error) <= 1.0, flags)


def _flags(
    drift: Estimate, drifted: bool, error: float, body: Estimate, known_body: Estimate
) -> tuple[Flag, ...]:
    flags = []
    if drifted:
        message = (
            f"the tares differ by {drift.value:.3g} +- {drift.uncertainty:.2g} {drift.unit} "
            "(1 sigma): something moved on the rig between them; half of it is in the uncertainty"
        )
        flags.append(Flag("tare_drift", Severity.WARNING, message))
    if abs(error) > 1.0:
        message = (
            f"the known body reads {body.value:.5g} for {known_body.value:.5g} {known_body.unit}, "
            f"{abs(error):.2g} times the joint interval (limit 1): lever, mass or timing is wrong; "
            "the test's numbers are not to be used before that is found"
        )
        flags.append(Flag("known_weight_failed", Severity.VOID, message))
    return tuple(flags)
