"""Free decays: the plan's runs, what an operator is asked, and what a simulated rig records."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analysis.readers import read_recording
from hardware.description.errors import ConfigurationError
from hardware.description.heel import Heel, RollConstraint
from hardware.description.kinds import Motion, RunKind
from hardware.description.setpoint import SetPoint
from pmm.campaign.campaign_file import read_campaign
from pmm.plan.campaign_writer import FinishedRun, write_campaign
from pmm.plan.plan import read_plan, read_plan_and_rig
from pmm.plan.run_plan import RunPlan
from pmm.recorder.line_shapes import read_lines
from pmm.run.surroundings import Surroundings
from sim.acquisition.channels import Acquisition, Digitiser
from sim.model.hull import HullCoefficients
from sim.rig import horizontal_rig
from tests.pmm.plan.plans import HORIZONTAL_TEXT, write_plan
from tests.pmm.run.harness import TABLES, at_rest, bench
from tests.sim.devices.benches import amplifier

INERTIA, GM_M, GRAVITY = 1.4, 0.03, 9.80665
HALF_STEP = 5e-4  # of the amplifier, which counts thousandths: a heel is never at the middle
PLAN = """
[[runs]]
kind = "free-decay"
releases_deg = [6.0, -8.0]
speeds_m_s = [0.0, 0.8]
duration_s = 30.0
"""
TABLE = '[campaign.heel]\nheld = "set"\ngm_m = 0.03\n'


def test_every_release_at_every_speed_and_back_from_the_campaign(tmp_path: Path) -> None:
    plan, rig = read_plan_and_rig(write_plan(tmp_path, PLAN, HORIZONTAL_TEXT + TABLE))
    found = {one.name: round(math.degrees(one.set_point.release_rad)) for one in plan.runs}
    assert found == {
        "free-decay-u0-k6": 6, "free-decay-u0-k-8": -8,
        "free-decay-u0.8-k6": 6, "free-decay-u0.8-k-8": -8,
    }  # fmt: skip
    done = [FinishedRun(one, f"{one.name}/run.nc") for one in plan.runs]
    campaign = read_campaign(write_campaign(tmp_path, plan, rig, done))
    assert [one.set_point for one in campaign.at_rest] == [one.set_point for one in plan.runs]


@pytest.mark.parametrize(
    ("old", "new", "more", "told"),
    [
        ("[6.0, -8.0]", "[0.0]", TABLE, "has 0; a model is let go from a heel"),
        ("releases_deg = [6.0, -8.0]", "", TABLE, "needs releases_deg"),
        ("free-decay", "straight-tow", TABLE, "releases_deg is of no use"),
        ("30.0", "30.0", "", "releases_deg needs [campaign.heel]"),
    ],
)
def test_what_is_no_decay_is_told(tmp_path: Path, old, new, more, told) -> None:
    with pytest.raises(ConfigurationError) as caught:
        read_plan(write_plan(tmp_path, PLAN.replace(old, new), HORIZONTAL_TEXT + more))
    assert told in str(caught.value)


def test_a_model_is_held_let_go_and_held_again() -> None:
    around = Surroundings()
    (hold,) = around.hold(-0.1)
    assert "heel it to port by 0.1000 rad (5.73 deg) and hold it still" in hold
    (go,) = around.let_go(-0.1)
    assert (go.part, go.value) == ("release", -0.1)
    next_run = at_rest("next", RunKind.ZERO)
    (again,) = around.before(next_run, horizontal_rig().oscillator)
    assert (again.part, again.value) == ("release", 0.0)
    assert not list(around.before(next_run, horizontal_rig().oscillator))


@pytest.mark.slow
def test_the_record_has_the_roll_from_its_release(tmp_path: Path) -> None:
    point = SetPoint(0.0, 0.0, release_rad=0.15)
    run = RunPlan("decay", RunKind.FREE_DECAY, Motion.NONE, point, duration_s=4.0)
    simulated = replace(
        horizontal_rig(),
        water=HullCoefficients(),
        acquisition=Acquisition(heel_angle=Digitiser()),
        heel=Heel(RollConstraint.SET, inertia_kg_m2=INERTIA, gm_m=GM_M),
    )
    tables = {**TABLES, "forces": [*TABLES["forces"], amplifier(6, "heel_angle")]}
    with bench(tmp_path, [run], tables=tables, simulated=simulated) as one:
        one.finish()
        assert one.control.outcomes[0].outcome == "complete"
    events, _ = read_lines(tmp_path / "decay" / "events.jsonl")
    assert any("let go of the model" in event["text"] for event in events)
    recording = read_recording(tmp_path / "decay" / "run.nc")
    heel = recording.values("heel_angle")
    free = heel[np.flatnonzero(heel > 0.1)[0] :]
    # Undamped: swings of m g GM about I, longer by the sixteenth of their amplitude squared.
    omega = math.sqrt(simulated.body.mass_kg * GRAVITY * GM_M / INERTIA)
    crossings = np.flatnonzero(np.diff(np.sign(free - HALF_STEP))) / recording.sample_rate_hz
    half_s = np.diff(crossings).mean()
    assert half_s == pytest.approx(math.pi / omega * (1.0 + 0.15**2 / 16.0), rel=1e-2)
    assert np.abs(free[-100:]).max() == pytest.approx(0.15, rel=2e-2)
