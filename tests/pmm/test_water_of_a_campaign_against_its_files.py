"""A campaign's water: read, handed on from the plan, divided by, stated, refused."""

import json
import math
import tomllib
from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner

from analysis.water import SEA_WATER_G_KG, Water
from hardware.description.errors import ConfigurationError
from pmm.campaign.campaign_file import read_campaign
from pmm.campaign.water import TankWater, common_water
from pmm.cli import cli
from pmm.plan.campaign_writer import write_campaign
from pmm.plan.plan import read_plan_and_rig
from pmm.report.coefficients_document import SCHEMA
from tests.pmm.plan.plans import EXAMPLES

LENGTH_M, SPEED_M_S, DEPTH_M = 2.5, 0.8, 1.6
CAMPAIGN = """\
[oscillator]
preset = "horizontal-1963"
[model]
mass_kg = 70.0
inertia_kg_m2 = 27.5
[hull]
added_mass = [[75.0, 0.0], [0.0, 22.0]]
damping = [[190.0, 0.0], [0.0, 55.0]]
[[runs]]
name = "sway"
frequency_hz = 0.2
eccentricity_mm = 100.0
carriage_speed_m_s = 0.8
periods = 4
"""


def _told(folder: Path, *options: str) -> dict:  # type: ignore[type-arg]
    ran = CliRunner().invoke(cli, ["coefficients", str(folder), *options, "--json"])
    assert ran.exit_code == 0, ran.output
    found = json.loads(ran.stdout)
    assert found["schema"] == SCHEMA
    return dict(found)


def _campaign(folder: Path, water: str) -> Path:
    (folder / "campaign.toml").write_text(CAMPAIGN + water)
    (folder / "coefficients.toml").write_text(f"nonlinear = false\n[ship]\nlength_m = {LENGTH_M}\n")
    ran = CliRunner().invoke(
        cli, ["simulate", str(folder / "campaign.toml"), "--output", str(folder)]
    )
    assert ran.exit_code == 0, ran.output
    return folder


def _value(found: dict, name: str) -> float:  # type: ignore[type-arg]
    return next(float(row["value"]) for row in found["recommended"] if row["name"] == name)


def test_coefficients_are_divided_by_the_density_of_the_water(tmp_path: Path) -> None:
    water = f"[water]\ntemperature_deg_c = 12.5\nsalinity_g_kg = 35.16504\ndepth_m = {DEPTH_M}\n"
    folder = _campaign(tmp_path, water)
    sea = Water(12.5, SEA_WATER_G_KG)
    plain, prime = _told(folder), _told(folder, "--system", "prime")
    unit = 0.5 * sea.density_kg_m3 * LENGTH_M**2 * SPEED_M_S
    assert _value(prime, "Y_v") == pytest.approx(_value(plain, "Y_v") / unit, rel=1e-12)
    assert "density_assumed" not in {one["code"] for one in prime["left_out"]}
    (row,) = prime["conditions"]
    assert row == {
        "speed_m_s": SPEED_M_S,
        "froude_number": pytest.approx(SPEED_M_S / math.sqrt(9.80665 * LENGTH_M)),
        "reynolds_number": pytest.approx(SPEED_M_S * LENGTH_M / 1.2702e-6, rel=2e-3),
        "depth_froude_number": pytest.approx(SPEED_M_S / math.sqrt(9.80665 * DEPTH_M)),
    }


def test_a_density_that_nobody_stated_is_said(tmp_path: Path) -> None:
    found = _told(_campaign(tmp_path, ""), "--system", "prime")
    assert "density_assumed" in {one["code"] for one in found["left_out"]}
    (row,) = found["conditions"]
    assert row["reynolds_number"] is None
    assert row["depth_froude_number"] is None


def test_water_outside_the_tables_is_refused_with_the_file(tmp_path: Path) -> None:
    path = tmp_path / "campaign.toml"
    path.write_text("[water]\ntemperature_deg_c = 63.0\n")
    said = r"campaign.toml: water: temperature_deg_c = 63 is outside 0 to 40 degrees Celsius"
    with pytest.raises(ConfigurationError, match=said):
        read_campaign(path)


def test_the_plans_water_is_the_campaigns_with_the_depth_of_the_tank(tmp_path: Path) -> None:
    plan, rig = read_plan_and_rig(EXAMPLES / "horizontal" / "plan.toml")
    assert plan.water == Water(15.0)
    assert rig.tank is not None
    tank = replace(rig.tank, depth_m=DEPTH_M)
    written = write_campaign(tmp_path, plan, replace(rig, tank=tank), [])
    assert tomllib.loads(written.read_text())["water"]["depth_m"] == DEPTH_M
    assert read_campaign(written).water == TankWater(15.0, 0.0, DEPTH_M)


def test_campaigns_that_are_one_have_their_mean_temperature() -> None:
    one, other = TankWater(14.0, 0.0, 3.0), TankWater(15.0, 0.0, 3.0)
    assert common_water([one, other]) == TankWater(14.5, 0.0, 3.0)
    assert common_water([None, None]) is None
    with pytest.raises(ConfigurationError, match=r"only some of the campaigns have a table"):
        common_water([one, None])
    with pytest.raises(ConfigurationError, match=r"differ in salinity_g_kg"):
        common_water([one, replace(other, salinity_g_kg=20.0)])
