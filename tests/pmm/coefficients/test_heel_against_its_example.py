"""The example of a heeled model: what it was made of comes out, in the table, figure and report."""

import json
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.integrate import solve_ivp

from analysis.attitude import AttitudeChannel
from analysis.readers import read_recording, write_recording
from pmm.cli import cli
from pmm.report.attitude import HeelRow
from pmm.report.attitude_figure import heel_figure

EXAMPLE = Path(__file__).parents[3] / "examples" / "roll" / "campaign.toml"
SPEED_M_S = 1.2


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("roll") / "heeled"
    done = CliRunner().invoke(cli, ["simulate", str(EXAMPLE), "--output", str(out)])
    assert done.exit_code == 0, done.stderr
    return out


@pytest.fixture(scope="module")
def found(folder: Path) -> dict[str, Any]:
    ran = CliRunner().invoke(cli, ["coefficients", str(folder), "--json"])
    assert ran.exit_code == 0, ran.stderr
    return dict(json.loads(ran.stdout))


@pytest.mark.slow
def test_terms_of_heel_and_roll_come_out(found: dict[str, Any]) -> None:
    made = tomllib.loads(EXAMPLE.read_text(encoding="utf-8"))
    rows = {row["name"]: row for row in found["recommended"]}
    put_in = {
        name.replace("_uu", "_"): value * (SPEED_M_S**2 if "_uu" in name else 1.0)
        for name, value in made["heel_loads"].items()
    }
    told = [name for name in put_in if name in rows]
    assert {"Y_phi", "N_phi", "K_phi", "X_phiphi", "K_v", "K_r", "K_vdot", "Y_vphiphi"} <= set(told)
    for name in told:
        row = rows[name]
        # At -10 degrees uu is less than the carriage's speed squared under drift: 1 %.
        allowed = 1.5 * row["half_width"] + 0.015 * abs(put_in[name])
        assert row["value"] == pytest.approx(put_in[name], abs=allowed), name
    assert rows["K_v"]["unit"] == "N s"
    assert rows["K_phi"]["unit"] == "N m"


@pytest.mark.slow
def test_the_surge_terms_come_out_of_a_resistance_that_swings(found: dict[str, Any]) -> None:
    made = tomllib.loads(EXAMPLE.read_text(encoding="utf-8"))["surge"]
    rows = {row["name"]: row for row in found["recommended"]}
    put_in = {"X_0": made["x_uu"] * SPEED_M_S**2} | {
        name: made[name.lower()] for name in ("X_rr", "X_vr")
    }
    for name, value in put_in.items():
        assert rows[name]["value"] == pytest.approx(value, abs=1.5 * rows[name]["half_width"]), name
        assert rows[name]["misfit"] < 1.5  # X_rr was 3.7 off, and this 7.9, by a constant one
    said = [c["message"] for c in found["coefficients"]["choices"] if c["load"] == "surge force"]
    assert any("a resistance that goes with u^2 as the model turns" in one for one in said)


def row_of(row: dict[str, Any]) -> HeelRow:
    told = {key: row[key] for key in ("run", "speed_m_s", "drift_rad", "frequency_hz", "held")}
    return HeelRow(
        **told, heel=AttitudeChannel(**row["heel"]), moment=AttitudeChannel(**row["moment"])
    )


@pytest.mark.slow
def test_every_run_has_its_heel_and_moment(found: dict[str, Any]) -> None:
    rows = {row["run"]: row for row in found["heel"]}
    assert len(rows) == 14
    assert rows["tow-h-10-b0"]["heel"]["mean"] == pytest.approx(-0.17453, abs=1e-5)
    k_phi = -0.4502 * SPEED_M_S**2  # N m
    moment = rows["tow-h-10-b0"]["moment"]
    assert moment["mean"] == pytest.approx(-0.17453 * k_phi, abs=4.0 * moment["mean_u"])
    drawn = heel_figure([row_of(row) for row in found["heel"]])
    assert [axes.get_ylabel() for axes in drawn.axes] == ["K (N m)"] * 2  # the heel was set
    marks = [part for axes in drawn.axes for part in axes.containers]
    assert len(marks) == 2 * 14


@pytest.mark.slow
def test_what_is_missing_gets_a_sentence(folder: Path, tmp_path: Path) -> None:
    text = EXAMPLE.read_text(encoding="utf-8")
    settings = tmp_path / "coefficients.toml"
    settings.write_text('wanted = ["K_v"]\n', encoding="utf-8")
    campaign = folder / "campaign.toml"
    kept = campaign.read_text(encoding="utf-8")

    def said(changed: str) -> str:
        campaign.write_text(changed, encoding="utf-8")
        try:
            more = ["--settings", str(settings)]
            ran = CliRunner().invoke(cli, ["coefficients", str(folder), *more])
        finally:
            campaign.write_text(kept, encoding="utf-8")
        assert ran.exit_code != 0
        return str(ran.stderr)

    heel = text[text.index("[heel]") : text.index("[hull]")]
    loads = text[text.index("[heel_loads]") : text.index("[acquisition]")]
    bare = (
        text.replace(heel, "")
        .replace(loads, "")
        .replace("roll_moment = { noise_rms = 0.02, offset = 0.15 }\n", "")
    )
    upright = "\n".join(line for line in bare.splitlines() if "heel_deg" not in line)
    assert "a missing roll gauge: K terms need the channel roll_moment" in said(upright)
    turned = text.replace("half_spacing_m = 0.8", 'half_spacing_m = 0.8\ngauges = "rig"')
    assert 'heel needs gauges = "model" in [oscillator]' in said(turned)


@pytest.mark.slow
def test_a_campaign_that_heels_without_a_roll_gauge_is_told_so(
    folder: Path, found: dict[str, Any], tmp_path: Path
) -> None:
    assert "roll_gauge_missing" not in {one["code"] for one in found["left_out"]}
    text = (folder / "campaign.toml").read_text(encoding="utf-8")
    head, *records = text.split("[[at_rest]]")
    few = ("zero-h0", "tow-h0-b-6", "tow-h0-b0", "tow-h0-b6")
    wanted = [f'name = "{name}"\n' for name in few]
    kept = [one.split("[[runs]]")[0] for one in records if any(name in one for name in wanted)]
    (tmp_path / "campaign.toml").write_text("[[at_rest]]".join((head, *kept)), encoding="utf-8")
    for name in few:
        read = read_recording(folder / f"{name}.nc")
        channels = tuple(one for one in read.channels if one.name != "roll_moment")
        rows = np.array([read.values(one.name) for one in channels])
        write_recording(replace(read, channels=channels, samples=rows), tmp_path / f"{name}.nc")
    ran = CliRunner().invoke(cli, ["coefficients", str(tmp_path), "--json"])
    assert ran.exit_code == 0, ran.stderr
    told = {one["code"]: one for one in json.loads(ran.stdout)["left_out"]}
    assert set(told["roll_gauge_missing"]["runs"]) == set(few[1:])
    assert "no term of K is told" in told["roll_gauge_missing"]["message"]


@pytest.mark.slow
def test_a_recorded_decay_puts_the_roll_damping_into_the_same_table(
    folder: Path, tmp_path: Path
) -> None:
    """Let go at speed, afloat: the roll is that of ``solve_ivp`` with the example's numbers."""
    made = tomllib.loads(EXAMPLE.read_text(encoding="utf-8"))
    loads, heel = made["heel_loads"], made["heel"]
    put_in = {"K_p": loads["K_p"], "K_pdot": loads["K_pdot"]}
    stiff = made["model"]["mass_kg"] * 9.80665 * heel["gm_m"] - loads["K_uuphi"] * SPEED_M_S**2
    inertia = heel["inertia_kg_m2"] - put_in["K_pdot"]

    def rates(_: float, state: np.ndarray) -> list[float]:
        return [state[1], (put_in["K_p"] * state[1] - stiff * state[0]) / inertia]

    time_s, generator = np.arange(0.0, 60.0, 0.05), np.random.default_rng(29)
    for k in range(3):
        start = [0.10 + 0.01 * k, 0.0]
        rolled = solve_ivp(rates, (0.0, 60.0), start, "DOP853", time_s, rtol=1e-9)
        read = rolled.y[0] + 1e-4 * generator.standard_normal(time_s.size)
        np.savetxt(tmp_path / f"roll-{k}.csv", np.column_stack((time_s, read)), "%.7f", ",",
                   header="time [s],heel [rad]", comments="")  # fmt: skip
    job = tmp_path / "roll.toml"
    job.write_text(
        'name = "roll, towed"\naxis = "roll"\n[period]\nchannel = "heel"\n'
        'records = ["roll-0.csv", "roll-1.csv", "roll-2.csv"]\n'
    )
    ran = CliRunner().invoke(cli, ["inertia", "pendulum", str(job), "--json"])
    assert ran.exit_code == 0, ran.stderr
    (tmp_path / "roll.json").write_text(ran.stdout, encoding="utf-8")
    settings = tmp_path / "coefficients.toml"
    settings.write_text(
        f'[[roll_decays]]\nspeed_m_s = {SPEED_M_S}\nresult = "roll.json"\n'
        "u_gm_m = 1e-5\nu_inertia_kg_m2 = 0.01\n[ship]\nlength_m = 3.5\n"
    )
    more = ["--settings", str(settings), "--json"]
    ran = CliRunner().invoke(cli, ["coefficients", str(folder), *more])
    assert ran.exit_code == 0, ran.stderr
    told = json.loads(ran.stdout)
    rows = {row["name"]: row for row in told["recommended"]}
    for name, value in put_in.items():
        assert rows[name]["value"] == pytest.approx(value, abs=1.5 * rows[name]["half_width"]), name
        assert rows[name]["half_width"] < 0.2 * abs(value), name
    for row in told["heel"]:
        assert row["froude_number"] == pytest.approx(SPEED_M_S / np.sqrt(9.80665 * 3.5))
        assert row["reynolds_number"] is None, "no [water] is stated"
