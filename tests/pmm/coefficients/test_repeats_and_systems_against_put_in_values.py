"""Through the command: a repeat that stands off; KVLCC2; restoring; Capytaine's tables."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from analysis.coefficients.campaign_nonlinear import HIGHER_ORDER
from analysis.coefficients.normalisation import mmg
from hardware.description.setpoint import SetPoint
from sim.rig import horizontal_rig, vertical_rig
from tests.analysis.coefficients.kvlcc2 import DERIVATIVES
from tests.analysis.coefficients.test_nonlinear_against_put_in_values import put_in_prime
from tests.pmm.coefficients.campaigns import head, pair, record
from tests.pmm.coefficients.test_command_against_put_in_values import done, run

KVLCC2 = {name: one for name, one in DERIVATIVES.items() if name[0] in "YN"}


@pytest.mark.slow
def test_a_repeat_with_another_load_is_named(tmp_path: Path) -> None:
    """One of five repeats carries 1 kg that nobody wrote down."""
    rig = vertical_rig()
    heavier = replace(rig, body=replace(rig.body, mass_kg=rig.body.mass_kg + 1.0))
    text = head(rig)
    for k in range(5):
        point = SetPoint(0.8, 0.02, 0.0, 1.2)
        own = heavier if k == 3 else rig
        text += record(tmp_path, own, f"heave-{k}", point, seed=k)
    (tmp_path / "campaign.toml").write_text(text)
    found = done(tmp_path)["coefficients"]["outliers"]
    assert {one["run"] for one in found} == {"heave-3"}
    assert "leave it out if there is a reason" in found[0]["message"]
    shown = run(tmp_path)
    assert shown.exit_code == 0
    assert "heave-3" in shown.output
    assert done(tmp_path, "--leave-out", "heave-3")["coefficients"]["outliers"] == []


@pytest.mark.slow
def test_kvlcc2_comes_back_in_the_mmg_system(tmp_path: Path) -> None:
    """Published derivatives, linear and cubic, of a 2.9 m model on a rig with noise."""
    length_m, speed_m_s = 2.9091, 0.76
    draught_m = 20.8 * length_m / 320.0
    system = mmg(length_m, draught_m, speed_m_s, 1000.0)
    hull = put_in_prime(KVLCC2, system.term_factor)
    rig = replace(horizontal_rig(), water=hull.water, cross_flow=hull.cross_flow)
    motions = ((0.05, 0.0), (0.15, 0.0), (0.05, math.pi), (0.1, math.pi), (0.12, 2.0))
    text = head(rig)
    for k, (eccentricity_m, phase_rad) in enumerate(motions):
        point = SetPoint(0.2, eccentricity_m, phase_rad, speed_m_s)
        text += record(tmp_path, rig, f"run-{k}", point, seed=k)
    (tmp_path / "campaign.toml").write_text(text)
    ship = f"length_m = {length_m}\ndraught_m = {draught_m}\ndensity_kg_m3 = 1000.0\n"
    (tmp_path / "coefficients.toml").write_text(f'system = "mmg"\n[ship]\n{ship}')
    found = done(tmp_path)["coefficients"]
    assert "MMG" in found["normalisation"]
    assert {one["verdict"] for one in found["choices"]} == {"cubic"}
    rows = {row["name"]: row for row in found["table"] if row["method"] == HIGHER_ORDER}
    assert set(rows) == {*KVLCC2, "Y_rdot", "N_vdot"}
    for name, row in rows.items():
        assert abs(row["value"] - KVLCC2.get(name, 0.0)) <= row["half_width"], row


@pytest.mark.slow
def test_measured_restoring_is_held_against_hydrostatics(tmp_path: Path) -> None:
    """Heave and pitch at rest, three frequencies: what is left at none is what was put in."""
    rig = vertical_rig()
    text = head(rig)
    for k, frequency_hz in enumerate((0.2, 0.35, 0.5)):
        for name, point in pair(frequency_hz, 0.0):
            text += record(tmp_path, rig, name, point, seed=k)
    (tmp_path / "campaign.toml").write_text(text)
    checks = restoring_checks(tmp_path)
    assert set(checks) == {"C33", "C35", "C53", "C55"}
    for name, one in checks.items():
        row, column = ("35".index(letter) for letter in name[1:])
        assert one["agrees"], one
        assert one["second_value"] == rig.water.restoring[row][column]
        assert (
            abs(one["first_value"] - one["second_value"])
            < 1e-3 * rig.water.restoring[column][column]
        )
    wrong = tmp_path / "wrong.toml"
    stiffer = [[1.02 * value for value in row] for row in rig.water.restoring]
    wrong.write_text(f"restoring = {stiffer}\n")
    held = restoring_checks(tmp_path, "--settings", wrong)
    assert {name for name, one in held.items() if not one["agrees"]} >= {"C33", "C55"}
    shown = " ".join(run(tmp_path, "--settings", wrong).output.split())
    assert "hydrostatics" in shown
    assert "DIFFER" in shown


def restoring_checks(*words: object) -> dict[str, dict[str, Any]]:
    checks = done(*words)["coefficients"]["checks"]
    return {one["name"]: one for one in checks if one["kind"] == "restoring"}


def test_a_table_of_capytaine_stands_beside_the_values(tmp_path: Path) -> None:
    import xarray as xr

    rig = vertical_rig()
    text = head(rig)
    for k, (name, point) in enumerate(pair(0.8, 0.0)):
        text += record(tmp_path, rig, name, point, seed=k)
    (tmp_path / "campaign.toml").write_text(text)
    omega = 2.0 * np.pi * np.array([0.7, 0.9])
    dofs = ["Heave", "Pitch"]
    water = {
        name: (("omega", "influenced_dof", "radiating_dof"), np.stack([np.array(matrix)] * 2))
        for name, matrix in (
            ("added_mass", rig.water.added_mass),
            ("radiation_damping", rig.water.damping),
        )
    }
    table = tmp_path / "hull.nc"
    xr.Dataset(
        water, coords={"omega": omega, "influenced_dof": dofs, "radiating_dof": dofs}
    ).to_netcdf(table, engine="h5netcdf")
    options = ("--form", "seakeeping", "--reference", table)
    beside = done(tmp_path, *options)["coefficients"]["references"]
    assert {row["name"] for row in beside} >= {"a33", "b33", "a55", "b55"}, json.dumps(beside)
    direct = [row for row in beside if row["name"] in ("a33", "b33", "a55", "b55")]
    for row in direct:
        assert row["measured"] == pytest.approx(row["expected"], abs=1.5 * row["half_width"])
