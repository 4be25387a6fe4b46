"""Through the command: a repeat that stands off is named; the MMG system; Capytaine's tables."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analysis.coefficients.normalisation import mmg
from hardware.description.setpoint import SetPoint
from sim.rig import horizontal_rig, vertical_rig
from tests.pmm.coefficients.campaigns import head, pair, record
from tests.pmm.coefficients.test_command_against_put_in_values import done, linear, run


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


def test_the_mmg_system_divides_by_length_and_draught(tmp_path: Path) -> None:
    """KVLCC2's way of writing, at the model's size: rho/2 L^2 d and rho/2 L d U."""
    rig = horizontal_rig()
    text = head(rig)
    for k, (name, point) in enumerate(pair(0.4, eccentricity_m=0.1)):
        text += record(tmp_path, rig, name, point, seed=k)
    (tmp_path / "campaign.toml").write_text(text)
    ship = tmp_path / "ship.toml"
    ship.write_text("[ship]\nlength_m = 2.5\ndraught_m = 0.13\ndensity_kg_m3 = 1000.0\n")
    found = done(tmp_path, "--system", "mmg", "--settings", ship)
    assert "MMG" in found["coefficients"]["normalisation"]
    system = mmg(2.5, 0.13, 1.2, 1000.0)
    put_in = {
        "Y_vdot": -62.0 / system.mass_kg,
        "Y_v": -120.0 / system.mass_per_second,
        "N_v": -40.0 / (system.mass_per_second * 2.5),
        "N_r": -35.0 / (system.mass_per_second * 2.5**2),
        "N_rdot": -18.0 / (system.mass_kg * 2.5**2),
    }
    rows = {row["name"]: row for row in linear(found)}
    for name, value in put_in.items():
        assert rows[name]["value"] == pytest.approx(value, abs=1.5 * rows[name]["half_width"])


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
