"""``pmm steering`` on examples/steering: simulated, recorded, read, and told what was put in."""

import json
import math
import re
import shutil
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from click.testing import CliRunner, Result

from analysis.readers import read_recording, write_recording
from pmm.cli import cli
from pmm.report.steering_document import steering_story
from pmm.steering.workflow import CampaignSteering, steering_of
from tests.analysis.manoeuvring.published import kvlcc2 as paper

EXAMPLE = Path(__file__).parents[3] / "examples" / "steering"
SETTINGS = EXAMPLE / "steering.toml"
pytestmark = pytest.mark.usefixtures("reads_once")
DEPTH_M = 4.0
WATER = f"""\
[water]
temperature_deg_c = 15.0
depth_m = {DEPTH_M}

"""
PUT_IN = {
    "1-t_P": 1.0 - paper.T_P, "w_P0": paper.W_P0, "t_R": paper.T_R, "a_H": paper.A_H,
    "x_H'": paper.X_H, "epsilon": paper.EPSILON, "kappa": paper.KAPPA, "gamma_R+": paper.GAMMA[0],
    "gamma_R-": paper.GAMMA[1], "l_R'": paper.L_R, "delta_0": 0.005,
}  # fmt: skip


def pmm(*arguments: object) -> Result:
    return CliRunner().invoke(cli, [str(one) for one in arguments])


@pytest.fixture(scope="module")
def tows(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("steering") / "tows"
    made = pmm("simulate", EXAMPLE / "campaign.toml", "--output", folder)
    assert made.exit_code == 0, made.output
    campaign = folder / "campaign.toml"
    text = campaign.read_text(encoding="utf-8")
    campaign.write_text(text.replace("[oscillator]", f"{WATER}[oscillator]"), encoding="utf-8")
    return folder


class Told(NamedTuple):
    """One run of the command on the whole example."""

    document: dict[str, Any]
    figures: Path
    found: CampaignSteering


@pytest.fixture(scope="module")
def told(tows: Path, tmp_path_factory: pytest.TempPathFactory) -> Told:
    kept: list[CampaignSteering] = []

    def keeping(folder: Path, given: Path) -> CampaignSteering:
        kept.append(steering_of(folder, given))
        return kept[0]

    figures = tmp_path_factory.mktemp("figures")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("pmm.steering.workflow.steering_of", keeping)
        ran = pmm("steering", tows, "--settings", SETTINGS, "--plot", figures, "--json")
    assert ran.exit_code == 0, ran.output
    return Told(json.loads(ran.stdout), figures, kept[0])


def changed(folder: Path, place: Path, *changes: tuple[str, str]) -> Path:
    place.mkdir()
    for one in folder.glob("*.nc"):
        (place / one.name).symlink_to(one)
    text = (folder / "campaign.toml").read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    (place / "campaign.toml").write_text(text, encoding="utf-8")
    return place


@pytest.mark.slow
def test_the_parameters_are_those_put_in(told: Told) -> None:
    found = told.document
    rows = {one["name"]: one for one in found["parameters"]}
    assert list(rows) == list(PUT_IN)
    for name, value in PUT_IN.items():
        off = abs(rows[name]["value"] - value) / rows[name]["standard_uncertainty"]
        assert off < 3.5, name  # of eleven: beyond it once in 200 seeds
        assert rows[name]["standard_uncertainty"] < 0.01 * max(abs(value), 0.1)
    assert (found["missing"], found["doubts"]) == ({}, [])
    turns = {one["run"]: one["motion"] for one in found["tows"] if one["run"].startswith("yaw")}
    rate = 2.0 * math.pi * 0.1 * 2.0 * 0.06  # opposite struts, a metre apart
    for side, sign in (("starboard", 1.0), ("port", -1.0)):
        assert turns[f"yaw-n8-d20 {side}"] == pytest.approx([paper.U0, 0.0, sign * rate], abs=2e-4)
    (point,) = found["self_propulsion"]
    resistance = -paper.hull(paper.U0, 0.0, 0.0)[0]
    assert point["rate_hz"] == pytest.approx(paper.N, rel=1e-3)
    assert point["resistance_n"] == pytest.approx(resistance, rel=2e-3)
    assert {one.suffix for one in told.figures.iterdir()} == {".svg", ".png"}


@pytest.mark.slow
def test_the_torque_is_that_of_the_open_water_table(told: Told) -> None:
    """By hand: J of the paper's wake, K_Q between the example's own numbers."""
    made = tomllib.loads((EXAMPLE / "campaign.toml").read_text(encoding="utf-8"))["steering"]
    table = made["propeller"]["open_water"]
    rows = {one["run"]: one for one in told.document["tows"]}
    for rate in (8.0, 10.0, 12.0):
        pace = rate * paper.D_P
        k_q = np.interp(paper.U0 * (1.0 - paper.W_P0) / pace, table["advance"], table["torque"])
        row = rows[f"straight-tow-b0-n{rate:g}-d0"]
        expected = 1000.0 * rate**2 * paper.D_P**5 * k_q
        assert row["torque_n_m"] == pytest.approx(expected, abs=4.0 * row["torque_u"])
        assert row["torque_u"] < 0.01 * expected


@pytest.mark.slow
def test_what_has_a_speed_has_its_froude_and_reynolds_number(told: Told) -> None:
    rows = [*told.document["self_propulsion"], *told.document["wakes"]]
    assert len(rows) > 3
    for row in rows:
        speed = row["speed_m_s"]
        assert row["froude_number"] == pytest.approx(speed / math.sqrt(9.80665 * paper.L))
        assert row["depth_froude_number"] == pytest.approx(speed / math.sqrt(9.80665 * DEPTH_M))
        assert row["reynolds_number"] == pytest.approx(speed * paper.L / 1.1386e-6, rel=1e-4)


@pytest.mark.slow
def test_people_read_names_intervals_and_the_numbers_that_are_known(
    told: Told, monkeypatch: pytest.MonkeyPatch
) -> None:
    def shown(found: CampaignSteering) -> str:
        monkeypatch.setattr("pmm.steering.workflow.steering_of", lambda *_: found)
        return pmm("steering", EXAMPLE, "--level", "0.9").stdout

    text = shown(told.found)
    assert "thrust deduction factor" in text
    assert "90 % interval" in text
    assert "lever of the inflow in a turn" in text
    assert all(re.search(rf" {head}(?! =)\s", text) for head in ("Fn", "Re", "w_P"))
    text = shown(replace(told.found, water=None))
    assert re.search(r" Fn(?! =)\s", text)
    assert not re.search(r" Re(?! =)\s", text)


@pytest.mark.slow
def test_what_is_left_out_is_named_and_what_would_tell_the_rest(tows: Path, tmp_path: Path) -> None:
    """Sway in place of yaw, and a tow that states no rudder and no revolutions."""
    ahead = "drift_deg = 0.0\n"
    stated = f"{ahead}rudder_angle_deg = -20\nrevolutions_hz = 8.0\n"
    still = ("strut_phase_deg = 180.0", "strut_phase_deg = 0.0")
    ran = pmm("steering", changed(tows, tmp_path / "a", still, (stated, ahead)),
              "--settings", SETTINGS)  # fmt: skip
    assert ran.exit_code == 0, ran.output
    told = " ".join(ran.stdout.split())
    assert "l_R is not told by these runs; it takes: yaw with rudder" in told
    assert "it sways without a turn" in told
    assert "straight-tow-b0-n8-d-20: left out: it states neither rudder_angle_deg nor" in told


@pytest.mark.slow
def test_the_report_has_them_where_the_folder_has_the_file(
    tows: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("pmm.document.page.drawn", lambda figure: figure.caption)
    folder = _of_few_runs(tows, tmp_path / "told")
    shutil.copy(SETTINGS, folder)
    (folder / "ship.toml").write_text("speed_m_s = 1.0\n", encoding="utf-8")
    ran = pmm("report", folder)
    assert ran.exit_code == 0, ran.output
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert "flow straightening, bow to port" in page
    assert "slope is 1 - t_P" in page
    assert "propeller is missing" in page
    (folder / "steering.toml").write_text("length_m = 0.0\n", encoding="utf-8")
    (section,) = steering_story(folder, 0.95)
    (notes,) = section.contents
    assert "should be above 0" in notes.data[0]


def _of_few_runs(tows: Path, place: Path) -> Path:
    """The tows alone, without the oscillations."""
    text = (tows / "campaign.toml").read_text(encoding="utf-8")
    return changed(tows, place, (text[text.index("[[runs]]") :], ""))


def test_coefficients_have_the_rudders_derivatives(tows: Path) -> None:
    found = json.loads(pmm("coefficients", tows, "--json").stdout)
    why = [one["message"] for one in found["left_out"]]
    assert sum("oscillates with a laid rudder; `pmm steering FOLDER`" in one for one in why) == 4
    # Of 21 tows and 6 oscillations the tows at 10 1/s stay: what most have.
    assert sum("takes such runs" in one for one in why) == 16
    codes = {one["code"] for one in found["coefficients"]["flags"]}
    assert "propeller_turns" in codes
    assert "arrangement_doubted" not in codes, "no form describes these runs: they tell no rig"
    rows = {one["name"]: one for one in found["recommended"]}
    step = 1e-4

    def by_rudder(load: str, u: float, v: float, at: float = 0.0) -> float:
        ends = [
            getattr(paper.steering(u, v, 0.0, at + side * step - 0.005, 10.0), load)
            for side in (1, -1)
        ]
        return (ends[0] - ends[1]) / (2.0 * step)

    for name, load in (("Y_d", "y"), ("N_d", "n")):
        slope = by_rudder(load, paper.U0, 0.0)
        assert rows[name]["value"] == pytest.approx(slope, rel=0.02)
        assert rows[name]["unit"] == {"y": "N", "n": "N m"}[load]
    bend = by_rudder("x", paper.U0, 0.0, step) - by_rudder("x", paper.U0, 0.0, -step)
    assert rows["X_dd"]["value"] == pytest.approx(bend / (4.0 * step), rel=0.1)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("channel", "of", "said"),
    [
        ("rudder_angle", "zero", "the channel rudder_angle has no neutral; make a zero run with"),
        ("propeller_thrust", "zero", "the channel propeller_thrust has no zero; make a zero run"),
        (
            "revolutions",
            "tow",
            "no revolutions (0 1/s); where it turned, record the channel revolutions",
        ),
        ("rudder_normal_force", "tow", "no channel rudder_normal_force; thrust, the rudder's"),
    ],
)
def test_a_channel_without_its_neutral_or_its_revolutions_is_refused(
    tows: Path, tmp_path: Path, channel: str, of: str, said: str
) -> None:
    text = (tows / "campaign.toml").read_text(encoding="utf-8")
    head, *records = text.split("[[at_rest]]")
    tow = records[1].replace("revolutions_hz = 8.0", "")
    zeros = [one for one in records if 'kind = "zero"' in one]
    text = "[[at_rest]]".join((head, *(one.split("[[runs]]")[0] for one in (*zeros, tow))))
    (tmp_path / "campaign.toml").write_text(text, encoding="utf-8")
    for name in ("zero-1", "zero-2", "straight-tow-b0-n8-d-20"):
        read = read_recording(tows / f"{name}.nc")
        spared = name.startswith("zero") != (of == "zero")
        kept = [one for one in read.channels if spared or one.name != channel]
        rows = np.array([read.values(one.name) for one in kept])
        made = replace(read, channels=tuple(kept), samples=rows)
        write_recording(made, tmp_path / f"{name}.nc")
    ran = pmm("steering", tmp_path, "--settings", SETTINGS)
    assert ran.exit_code == 1
    assert said in " ".join(ran.stderr.split())


def test_what_is_wrong_is_said(tows: Path, tmp_path: Path) -> None:
    bad = tmp_path / "bad.toml"
    bad.write_text("length_m = 0.0\n", encoding="utf-8")
    ran = pmm("steering", tows, "--settings", bad)
    assert ran.exit_code == 2
    assert "propeller" in ran.stderr
    bad.write_text(re.sub("(?m)^density_kg_m3.*$", "", SETTINGS.read_text(encoding="utf-8")))
    ran = pmm("steering", changed(tows, tmp_path / "b", (WATER, "")), "--settings", bad)
    assert ran.exit_code == 2
    assert "the water's density is not stated: write [water]" in " ".join(ran.stderr.split())
    zeros = ('zero_before = "zero-1"\nzero_after = "zero-2"', "")
    no_zero = changed(_of_few_runs(tows, tmp_path / "few"), tmp_path / "a", zeros)
    ran = pmm("steering", no_zero, "--settings", SETTINGS)
    assert ran.exit_code == 1
    assert "no zero run is named" in ran.stderr
    ran = pmm("steering", EXAMPLE, "--settings", SETTINGS)
    assert ran.exit_code == 2
    assert "no such file" in ran.stderr


@pytest.mark.slow
@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        ("diameter_m = 0.216", "diameter_m = 216.0", "above rudder.height_m = 0.345"),
        ("towing_force_n = 0.0", "towing_force_n = 100.0", "nothing is left for the propeller"),
    ],
)
def test_numbers_that_cannot_belong_together_are_refused(
    tows: Path, tmp_path: Path, before: str, after: str, said: str
) -> None:
    text = SETTINGS.read_text(encoding="utf-8")
    assert before in text
    (tmp_path / "steering.toml").write_text(text.replace(before, after), encoding="utf-8")
    ran = pmm("steering", tows, "--settings", tmp_path / "steering.toml")
    assert ran.exit_code in {1, 2}
    assert said in " ".join(ran.stderr.split())
