"""Rudder and propeller over the rig's protocols: a tow's recording, against the MMG paper."""

import math
from dataclasses import replace
from pathlib import Path

import pytest

from analysis.readers import read_recording
from hardware.description.kinds import RunKind
from hardware.description.oscillator import HORIZONTAL_1963
from hardware.description.setpoint import SetPoint
from pmm.plan.plan import read_plan
from pmm.run.surroundings import Surroundings
from tests.analysis.manoeuvring.published import kvlcc2 as paper
from tests.pmm.plan.plans import HORIZONTAL_TEXT, write_plan
from tests.pmm.run.harness import TABLES, at_rest, bench
from tests.sim.devices.benches import amplifier
from tests.sim.test_steering_against_the_paper import RATE_HZ, rig

PLAN = """
[[runs]]
kind = "straight-tow"
name = "rudder"
speeds_m_s = 1.0
rudder_angles_deg = [-10, 0]
revolutions_hz = [8.0, 9.0]
[[runs]]
kind = "static-drift"
speeds_m_s = 1.0
drifts_deg = 5
rudder_angles_deg = 10
revolutions_hz = 9.0
[zero]
"""


@pytest.mark.slow
def test_a_tow_with_rudder_records_what_the_paper_says(tmp_path: Path) -> None:
    run = at_rest("tow", RunKind.STRAIGHT_TOW, speed_m_s=paper.U0)
    point = replace(run.set_point, rudder_angle_rad=math.radians(15.0), revolutions_hz=RATE_HZ)
    behind = amplifier(6, "propeller_thrust", "rudder_normal_force")
    tables = {**TABLES, "forces": [*TABLES["forces"], behind]}
    with bench(tmp_path, [replace(run, set_point=point)], tables=tables, simulated=rig()) as one:
        one.finish(40000)
    recording = read_recording(tmp_path / "tow" / "run.nc")
    told = paper.steering(paper.U0, 0.0, 0.0, point.rudder_angle_rad, RATE_HZ)
    assert recording.set_point == point
    for name, value in (("propeller_thrust", told.thrust), ("rudder_normal_force", told.normal)):
        assert float(recording.values(name)[-20:].mean()) == pytest.approx(value, abs=0.02)


def test_a_plan_has_every_combination_and_zeros_amidships(tmp_path: Path) -> None:
    plan = read_plan(write_plan(tmp_path, PLAN, HORIZONTAL_TEXT))
    towed = [run for run in plan.runs if run.kind.towed]
    zeros = [run for run in plan.runs if run.kind is RunKind.ZERO]
    settings = [
        (
            run.name,
            round(math.degrees(run.set_point.rudder_angle_rad)),
            run.set_point.revolutions_hz,
        )
        for run in towed
    ]
    assert settings == [
        ("rudder-n8-d-10", -10, 8.0),
        ("rudder-n8-d0", 0, 8.0),
        ("rudder-n9-d-10", -10, 9.0),
        ("rudder-n9-d0", 0, 9.0),
        ("static-drift", 10, 9.0),
    ]
    assert {(one.set_point.rudder_angle_rad, one.set_point.revolutions_hz) for one in zeros} == {
        (0.0, 0.0)
    }


def test_an_operator_is_asked_once_for_each_change() -> None:
    around = Surroundings()

    def asked(angle: float, rate: float) -> list[tuple[str, object]]:
        point = SetPoint(0.0, 0.0, rudder_angle_rad=angle, revolutions_hz=rate)
        run = replace(at_rest("tow", RunKind.STRAIGHT_TOW), set_point=point)
        return [(one.part, str(one)) for one in around.before(run, HORIZONTAL_1963)]

    (rudder, propeller) = asked(math.radians(-10.0), 8.0)
    assert rudder[0] == "rudder"
    assert "to turn to port by 0.1745 rad (10.00 deg)" in str(rudder[1])
    assert propeller == (
        "propeller",
        "propeller: turn it at 8 Hz (480 rpm); press Enter when the rate is steady",
    )
    assert asked(math.radians(-10.0), 8.0) == []
    assert [text for _, text in asked(0.0, 0.0)] == [
        "rudder: lay it amidships; press Enter when it is so",
        "propeller: stop it; press Enter when it stands",
    ]
