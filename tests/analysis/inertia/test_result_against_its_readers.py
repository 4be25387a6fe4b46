"""What comes out: the workflow, the comparison with a target, JSON and a model's table."""

import json
import math
import tomllib

import pytest

from analysis.inertia.result import MassProperties, compare_with_target, model_toml
from analysis.inertia.workflow import Step, StepResult, assess_workflow, next_step
from analysis.uncertainty.budget import linear_budget
from analysis.uncertainty.estimate import Estimate, exactly
from hardware.description.body import Body
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.oscillator import Plane

BUDGET = linear_budget("k", lambda k: k, {"k": Estimate.of(0.62, 0.002, "m", 5.0)}, unit="m")
RESULT = MassProperties(
    "hull 7",
    Estimate.of(70.0, 0.02, "kg"),
    Estimate.of(-0.02, 0.001, "m"),
    Estimate.of(0.05, 0.001, "m"),
    {"pitch": Estimate.of(0.62, 0.002, "m", 5.0), "yaw": Estimate.of(0.60, 0.002, "m")},
    budgets=(BUDGET,),
)


def test_model_table_reads_back_as_the_body() -> None:
    for plane in Plane:
        read = tomllib.loads(model_toml(RESULT, plane))
        inertia = RESULT.about_midpoint(plane).value
        assert Body(**read["model"]) == Body(70.0, inertia, -0.02, 0.05)
        assert set(read["model_uncertainty"]) >= set(read["model"])
    vertical = tomllib.loads(model_toml(RESULT, Plane.VERTICAL))
    expected = 70.0 * (0.62**2 + 0.02**2 + 0.05**2)
    assert vertical["model"]["inertia_kg_m2"] == pytest.approx(expected)
    pitch, ahead, below = RESULT.gyradii["pitch"], RESULT.cg_x, RESULT.cg_z
    parts = [expected / 70.0 * RESULT.mass.uncertainty]
    parts += [140.0 * one.value * one.uncertainty for one in (pitch, ahead, below)]
    freedom = 5.0 * (math.fsum(part**2 for part in parts) / parts[1] ** 2) ** 2
    found = vertical["model_uncertainty"]["inertia_degrees_of_freedom"]
    assert found == pytest.approx(freedom)


def test_uncertainty_about_the_midpoint() -> None:
    inertia = RESULT.about_midpoint(Plane.HORIZONTAL)
    by_hand = linear_budget(
        "I",
        lambda m, k, x: m * (k * k + x * x),
        {"m": RESULT.mass, "k": RESULT.gyradii["yaw"], "x": RESULT.cg_x},
    )
    assert inertia.uncertainty == pytest.approx(by_hand.result.uncertainty, rel=1e-6)


def test_correlations_enter_the_inertia() -> None:
    from dataclasses import replace

    mass, yaw = RESULT.mass, RESULT.gyradii["yaw"]
    common = exactly(yaw.value, "m").widened(-yaw.uncertainty, label="scale")
    heavy = exactly(mass.value, "kg").widened(mass.uncertainty, label="scale")
    tied = replace(RESULT, mass=heavy, gyradii={"yaw": common})
    loose, stiff = RESULT.inertia("yaw"), tied.inertia("yaw")
    expected = loose.value * abs(mass.relative - 2.0 * yaw.relative)
    assert stiff.uncertainty == pytest.approx(expected)
    assert tied.about_midpoint(Plane.HORIZONTAL).uncertainty < loose.uncertainty


def test_json_has_every_number_and_no_nan() -> None:
    numbers = json.loads(json.dumps(RESULT.numbers(), allow_nan=False))
    assert numbers["quantities"]["k_pitch_m"]["degrees_of_freedom"] == pytest.approx(5.0)
    assert numbers["quantities"]["mass_kg"]["degrees_of_freedom"] is None
    assert numbers["quantities"]["i_yaw_kg_m2"]["value"] == pytest.approx(70.0 * 0.36)
    assert numbers["budgets"]["k"][0]["share_percent"] == pytest.approx(100.0)


def test_an_axis_not_measured_is_refused() -> None:
    with pytest.raises(ConfigurationError, match="no roll gyradius was measured"):
        RESULT.inertia("roll")


def test_target_passes_fails_or_is_undecided() -> None:
    k = Estimate.of(0.62, 0.002, "m")
    assert compare_with_target("k", k, 0.62, 0.01).verdict == "pass"
    assert compare_with_target("k", k, 0.60, 0.01).verdict == "fail"
    found = compare_with_target("k", k, 0.61, 0.01)
    assert found.verdict == "undecided"
    assert "0.61 +- 0.01" in found.message
    with pytest.raises(ConfigurationError, match="above 0"):
        compare_with_target("k", k, 0.61, 0.0)


def steps(tare: float, again: float, check: float) -> tuple[StepResult, ...]:
    values = (tare, 50.0, check, again)
    return tuple(
        StepResult(step, Estimate.of(value, 0.05, "kg m2", 2.0))
        for step, value in zip(Step, values, strict=True)
    )


def test_workflow_in_order() -> None:
    assert next_step(()) == (
        Step.TARE,
        "Swing the empty rig three times; nothing on it but what stays for the test.",
    )
    made = steps(40.0, 40.02, 42.0)
    following = next_step(made[:2])
    assert following is not None
    assert following[0] is Step.CHECK
    found = assess_workflow(made, Estimate.of(2.0, 0.002, "kg m2"))
    assert found.passes
    assert found.flags == ()
    assert found.test_less_tare.value == pytest.approx(9.99)
    expected = math.hypot(0.05, found.tare.uncertainty)
    assert found.test_less_tare.uncertainty == pytest.approx(expected)


def test_workflow_catches_drift_and_a_failed_check() -> None:
    known = exactly(2.0, "kg m2")
    drifted = assess_workflow(steps(40.0, 40.6, 42.3), known)
    assert "tare_drift" in {flag.code for flag in drifted.flags}
    assert drifted.tare.uncertainty > 0.15
    failed = assess_workflow(steps(40.0, 40.0, 44.0), known)
    assert not failed.passes
    assert abs(failed.normalised_error) > 1.0
    assert "known_weight_failed" in {flag.code for flag in failed.flags}


def test_workflow_out_of_order_or_undone() -> None:
    made = steps(40.0, 40.0, 42.0)
    with pytest.raises(DataError, match="next: check"):
        assess_workflow(made[:2], exactly(2.0))
    with pytest.raises(DataError, match="the order is tare, test, check, tare_again"):
        next_step((made[1], made[0]))
