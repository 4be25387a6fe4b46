"""A turntable's text recordings, by the exact rig: what it has put in, and units planted wrong."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result

from analysis.coefficients.campaign_nonlinear import HIGHER_ORDER
from pmm.cli import cli
from tests.analysis.coefficients import kvlcc2
from tests.exact.run import record

HEAD = f"""name = "turntable"
tared = true
photocell = false

[oscillator]
plane = "horizontal"
joint = "yaw_table"
drift_by = "struts_offset"
half_spacing_m = 0.5
frequency_hz = {{ low = 0.01, high = 2.0 }}
eccentricity_m = {{ low = 0.0, high = 2.5 }}
force_per_strut_n = 1e4

[model]
mass_kg = {kvlcc2.MASS_KG}
inertia_kg_m2 = {kvlcc2.INERTIA_KG_M2}
cg_x_m = {kvlcc2.CG_X_M}
"""
RUN = """
[[runs]]
name = "{name}"
file = "{name}.csv"
frequency_hz = {hertz}
eccentricity_m = {sway_m}
carriage_speed_m_s = {speed}
drift_rad = {drift}
"""
UNITS = {
    "displacement_aft": "m", "displacement_fore": "rad",
    "force_aft": "N", "force_fore": "N m", "force_x": "N",
}  # fmt: skip
FACTORS = {"deg": math.degrees(1.0), "kNm": 1e-3, "mm": 1e3}


def campaign(folder: Path, **units: str) -> Path:
    """Write yaw with and without drift; each column in its unit, or in another that is given.

    A unit of the column's own quantity goes with its factor; any other is a slip of the header.
    """
    heads = UNITS | units
    text = HEAD
    for amplitude_m in kvlcc2.YAW_M:
        for drift_rad in kvlcc2.DRIFTS_RAD[:4]:
            rig = kvlcc2.turntable(amplitude_m, kvlcc2.YAW_HZ, drift_rad, yaws=True)
            made = record(rig, 4.0, 4.0, tared=True)
            count = len(made.channels["force_aft"])
            columns = [FACTORS.get(heads[name], 1.0) * made.channels[name] for name in UNITS]
            table = np.column_stack([np.arange(count) / made.sample_rate_hz, *columns])
            names = ",".join(["time [s]", *(f"{name} [{unit}]" for name, unit in heads.items())])
            run = f"yaw-{amplitude_m}{drift_rad:+.2f}"
            np.savetxt(folder / f"{run}.csv", table, delimiter=",", header=names, comments="")
            text += RUN.format(
                name=run, hertz=kvlcc2.YAW_HZ, sway_m=amplitude_m, speed=kvlcc2.SPEED_M_S,
                drift=drift_rad,
            )  # fmt: skip
    (folder / "campaign.toml").write_text(text)
    ship = f"length_m = {kvlcc2.LENGTH_M}\ndraught_m = {kvlcc2.DRAUGHT_M}\n"
    density = f"density_kg_m3 = {kvlcc2.DENSITY_KG_M3}\n"
    (folder / "coefficients.toml").write_text(f'system = "mmg"\n[ship]\n{ship}{density}')
    return folder


def run(folder: Path) -> Result:
    return CliRunner().invoke(cli, ["coefficients", str(folder), "--json"])


def done(folder: Path) -> dict[str, Any]:
    result = run(folder)
    assert result.exit_code == 0, result.output
    found: dict[str, Any] = json.loads(result.stdout)
    return found


@pytest.mark.parametrize(
    "units", [{}, {"displacement_aft": "mm", "displacement_fore": "deg", "force_fore": "kNm"}]
)
def test_force_moment_and_angle_give_the_derivatives(tmp_path: Path, units: dict[str, str]) -> None:
    found = done(campaign(tmp_path, **units))
    rows = {
        row["name"]: row["value"]
        for row in found["coefficients"]["table"]
        if row["method"] == HIGHER_ORDER
    }
    assert set(rows) >= {name for name in kvlcc2.PRINTED if name[0] in "YN"}
    for name, value in rows.items():
        expected = kvlcc2.DERIVATIVES.get(name, 0.0)
        assert value == pytest.approx(expected, abs=kvlcc2.ROUNDING.get(name, 5e-4)), name
    codes = {flag["code"] for one in found["runs"] for flag in one["flags"]}
    assert codes.isdisjoint({"units_implausible", "sign_opposite", "set_point_differs"}), codes


@pytest.mark.parametrize(
    ("channel", "unit", "said"),
    [
        ("force_fore", "N", "force_fore is in N, not in N m"),
        ("force_aft", "N m", "force_aft is in N m, not in N"),
        ("displacement_fore", "m", "displacement_fore is in m, not in rad"),
    ],
)
def test_a_unit_that_a_turntable_has_not(
    tmp_path: Path, channel: str, unit: str, said: str
) -> None:
    result = run(campaign(tmp_path, **{channel: unit}))
    assert result.exit_code == 1
    text = " ".join(result.stderr.split())
    assert said in text
    assert 'joint = "yaw_table"' in text
    assert "[columns.channels]" in text


def test_struts_have_forces_and_no_moment(tmp_path: Path) -> None:
    path = campaign(tmp_path) / "campaign.toml"
    path.write_text(path.read_text().replace('joint = "yaw_table"\n', ""))
    result = run(tmp_path)
    assert result.exit_code == 1
    assert "force_fore is in N m, not in N" in " ".join(result.stderr.split())


def test_a_table_whose_angle_was_not_recorded(tmp_path: Path) -> None:
    for path in campaign(tmp_path).glob("*.csv"):
        path.write_text(path.read_text().replace("displacement_fore", "heading"))
    result = run(tmp_path)
    assert result.exit_code == 1
    assert "no channel displacement_fore" in " ".join(result.stderr.split())
