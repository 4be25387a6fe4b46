"""Circles in a plan, against radii, rates and turns worked out by hand."""

from dataclasses import replace
from math import pi, radians
from pathlib import Path

import pytest

from hardware.carriage_settings import CarriageRegisters, ModbusCarriageSettings
from hardware.description.errors import ConfigurationError
from hardware.description.kinds import RunKind
from hardware.description.oscillator import HORIZONTAL_1963
from hardware.modbus_frames import ModbusPortSettings
from hardware.modbus_registers import Register
from pmm.campaign.campaign_file import read_campaign
from pmm.plan.campaign_writer import FinishedRun, write_campaign
from pmm.plan.limits import limit_findings
from pmm.plan.plan import read_plan, read_plan_and_rig
from tests.pmm.plan.plans import HORIZONTAL_TEXT, RIG_TEXT, rig_file, write_plan

CIRCLES = """
[zero]
duration_s = 2.0
[[runs]]
kind = "circle"
speeds_m_s = 0.8
radii_m = [-8.0, 5.0]
drifts_deg = [0.0, 4.0]
duration_s = 20.0
"""


def test_every_radius_at_every_drift_with_its_own_rate(tmp_path: Path) -> None:
    runs = [one for one in read_plan(write_plan(tmp_path, CIRCLES, HORIZONTAL_TEXT)).runs
            if one.kind is RunKind.CIRCLE]  # fmt: skip
    found = {one.name: (one.set_point.turn_rate_rad_s, one.set_point.drift_rad) for one in runs}
    assert found == {
        "circle-b0-c-8": (-0.1, 0.0),
        "circle-b0-c5": (0.16, 0.0),
        "circle-b4-c-8": (-0.1, radians(4.0)),
        "circle-b4-c5": (0.16, radians(4.0)),
    }
    assert all(one.zero_before and one.duration_s == 20.0 for one in runs)


def test_the_campaign_that_is_left_has_them_again(tmp_path: Path) -> None:
    plan, rig = read_plan_and_rig(write_plan(tmp_path, CIRCLES, HORIZONTAL_TEXT))
    done = [FinishedRun(one, f"{one.name}/run.nc") for one in plan.runs]
    campaign = read_campaign(write_campaign(tmp_path, plan, rig, done))
    circles = [one for one in campaign.at_rest if one.kind is RunKind.CIRCLE]
    planned = [one for one in plan.runs if one.kind is RunKind.CIRCLE]
    assert [one.set_point for one in circles] == [one.set_point for one in planned]


@pytest.mark.parametrize(
    ("old", "new", "rig", "told"),
    [
        ("radii_m = [-8.0, 5.0]", "", HORIZONTAL_TEXT, "needs radii_m for a run of kind circle"),
        ("5.0]", "0.0]", HORIZONTAL_TEXT, "has 0; a circle has a radius, below 0 to port"),
        ("= 0.8", "= 0.0", HORIZONTAL_TEXT, "has 0; a tow needs a speed above 0"),
        ("circle", "straight-tow", HORIZONTAL_TEXT, "radii_m is of no use to a run of kind"),
        ("[zero]", "[zero]", RIG_TEXT, '"circle" is for the horizontal oscillator'),
    ],
)
def test_what_makes_no_circle_is_told(tmp_path: Path, old, new, rig, told) -> None:
    with pytest.raises(ConfigurationError) as caught:
        read_plan(write_plan(tmp_path, CIRCLES.replace(old, new, 1), rig))
    assert told in str(caught.value)


@pytest.mark.parametrize(
    ("key", "told"),
    [
        ('kind = "circle"\n', "needs carriage_speed_m_s and turn_rate_deg_s"),
        ('kind = "straight-tow"\nturn_rate_deg_s = 3.0\n', "is of no use to a run of kind"),
    ],
)
def test_a_campaign_file_has_circles_whole(tmp_path: Path, key: str, told: str) -> None:
    path = tmp_path / "campaign.toml"
    path.write_text(f'[[at_rest]]\nname = "a"\nfile = "a.csv"\nduration_s = 5.0\n{key}')
    with pytest.raises(ConfigurationError, match=told):
        read_campaign(path)


def test_a_tank_has_its_radii_and_one_turn_is_enough(tmp_path: Path) -> None:
    plan, _ = read_plan_and_rig(write_plan(tmp_path, CIRCLES, HORIZONTAL_TEXT))
    run = next(one for one in plan.runs if one.set_point.turn_rate_rad_s > 0.0)
    rig = rig_file(HORIZONTAL_1963)
    assert not list(limit_findings(run, rig))  # 100 m of tank are no limit of a circle
    narrow = replace(rig, tank=replace(rig.tank, radius_m=(6.0, 18.0)))
    (found,) = limit_findings(run, narrow)
    assert (found.quantity, found.value, found.limit) == ("radius of the circle [m]", 5.0, 6.0)
    # One turn takes 2 pi / 0.16 = 39.27 s.
    (long,) = limit_findings(replace(run, duration_s=40.0), rig)
    assert long.value == pytest.approx(0.16 * 40.0 / (2.0 * pi))
    assert not list(limit_findings(replace(run, duration_s=39.0), rig))


SPEED = {"set_speed": Register(100, "mm/s", "int32"), "speed": Register(0, "m/s", "float32")}
TURN = {"set_turn_rate": Register(104, "deg/s", scale=0.01), "turn_rate": Register(6, "rad/s")}
PORT = ModbusPortSettings("socket://plc:502")


def settings(most: float, **registers: Register) -> ModbusCarriageSettings:
    own = CarriageRegisters(**SPEED, **registers)
    return ModbusCarriageSettings(
        port=PORT, registers=own, highest_speed_m_s=2.0, acceleration_m_s2=0.5,
        tolerance_m_s=0.01, highest_turn_rate_rad_s=most,
    )  # fmt: skip


@pytest.mark.parametrize(("most", "registers"), [(0.0, TURN), (0.3, {}), (-0.3, TURN)])
def test_a_carriage_drives_circles_whole_or_not_at_all(most, registers) -> None:
    assert settings(0.3, **TURN).highest_turn_rate_rad_s == 0.3
    with pytest.raises(ConfigurationError, match="belong together"):
        settings(most, **registers)
