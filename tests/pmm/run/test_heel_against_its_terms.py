"""Heel over the rig's protocols: a tow's recording against the terms of its hull, and the plan's
runs."""

import math
from dataclasses import replace
from pathlib import Path

import pytest

from analysis.readers import read_recording
from hardware.description.errors import ConfigurationError
from hardware.description.heel import Heel, RollConstraint
from hardware.description.kinds import RunKind
from hardware.description.oscillator import HORIZONTAL_1963
from hardware.description.setpoint import SetPoint
from pmm.campaign.campaign_file import read_campaign
from pmm.plan.campaign_writer import FinishedRun, write_campaign
from pmm.plan.plan import read_plan
from pmm.plan.rig_file import read_rig_file
from pmm.run.surroundings import Surroundings
from sim.acquisition.channels import Acquisition, Digitiser
from sim.model.hull import HullCoefficients
from sim.rig import horizontal_rig
from tests.pmm.plan.plans import HORIZONTAL_TEXT, write_plan
from tests.pmm.run.harness import TABLES, at_rest, bench
from tests.sim.devices.benches import amplifier

PLAN = """
[[runs]]
kind = "static-drift"
speeds_m_s = 1.0
heels_deg = [-5, 5]
drifts_deg = [0, 4]
[zero]
every = 2
"""
TABLE = """
[campaign.heel]
held = "set"
gm_m = 0.03
"""


@pytest.mark.slow
def test_a_heeled_tow_records_its_moment(tmp_path: Path) -> None:
    run = at_rest("tow", RunKind.STRAIGHT_TOW, speed_m_s=1.2)
    point = replace(run.set_point, heel_rad=0.1)
    tables = {**TABLES, "forces": [*TABLES["forces"], amplifier(6, "roll_moment", "heel_angle")]}
    made = replace(
        horizontal_rig(),
        water=HullCoefficients(),
        acquisition=Acquisition(roll_moment=Digitiser(), heel_angle=Digitiser()),
        heel=Heel(RollConstraint.SET, gm_m=0.03),
        heel_loads={"K_phi": -40.0, "Y_uphi": 25.0},
    )
    with bench(tmp_path, [replace(run, set_point=point)], tables=tables, simulated=made) as one:
        one.finish(40000)
    recording = read_recording(tmp_path / "tow" / "run.nc")
    assert recording.set_point == point
    assert float(recording.values("roll_moment")[-20:].mean()) == pytest.approx(4.0, abs=0.02)
    forces = recording.values("force_aft") + recording.values("force_fore")
    assert float(forces[-20:].mean()) == pytest.approx(-25.0 * 1.2 * 0.1, abs=0.05)


def test_a_plan_makes_zero_runs_at_each_heel(tmp_path: Path) -> None:
    plan = read_plan(write_plan(tmp_path, PLAN, HORIZONTAL_TEXT + TABLE))
    made = [(run.name, round(math.degrees(run.set_point.heel_rad))) for run in plan.runs]
    assert made == [
        ("zero-01", -5), ("static-drift-h-5-b0", -5), ("static-drift-h-5-b4", -5), ("zero-02", -5),
        ("zero-03", 5), ("static-drift-h5-b0", 5), ("static-drift-h5-b4", 5), ("zero-04", 5),
    ]  # fmt: skip
    rig = read_rig_file(tmp_path / "rig.toml")
    done = [FinishedRun(one, f"{one.name}.nc") for one in plan.runs]
    campaign = read_campaign(write_campaign(tmp_path, plan, rig, done))
    assert campaign.heel == Heel(RollConstraint.SET, gm_m=0.03)
    assert [one.set_point.heel_rad for one in campaign.at_rest] == [
        run.set_point.heel_rad for run in plan.runs
    ]


def test_a_rig_that_says_nothing_of_heel_refuses_it(tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match=r"heels_deg needs \[campaign.heel\] in the rig's"):
        read_plan(write_plan(tmp_path, PLAN, HORIZONTAL_TEXT))


def test_an_operator_is_asked_for_each_heel() -> None:
    around = Surroundings()

    def asked(heel_rad: float) -> list[tuple[str, str]]:
        point = SetPoint(0.0, 0.0, heel_rad=heel_rad)
        run = replace(at_rest("tow", RunKind.STRAIGHT_TOW), set_point=point)
        return [(one.part, str(one)) for one in around.before(run, HORIZONTAL_1963)]

    ((part, text),) = asked(-0.1)
    assert (part, text) == (
        "heel",
        "heel: heel the model to port by 0.1000 rad (5.73 deg); press Enter when it is so",
    )
    assert asked(-0.1) == []
    assert asked(0.0) == [("heel", "heel: set the model upright; press Enter when it is so")]
