"""Free decays that a campaign names, made by ``solve_ivp`` of a hull whose stability bends."""

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.integrate import solve_ivp

from pmm.campaign.campaign_file import read_campaign
from pmm.cli import cli
from pmm.coefficients.decays import decays_of
from tests.pmm.coefficients.test_circles_against_newton import written

MASS_KG, INERTIA_KG_M2, GM_M, BM_M, GRAVITY = 60.0, 4.6, 0.02, 0.115, 9.80665
K_P, K_PDOT = -0.7, -0.9
HEAD = """
name = "let go"
[oscillator]
preset = "horizontal-1963"
[model]
mass_kg = 60.0
inertia_kg_m2 = 20.0
[columns]
time = "t"
[columns.channels]
force_aft = "aft:N"
force_fore = "fore:N"
force_x = "x:N"
heel_angle = "heel:rad"

[[at_rest]]
name = "zero"
kind = "zero"
file = "zero.csv"
duration_s = 8.0

[[at_rest]]
name = "tow"
kind = "straight-tow"
file = "tow.csv"
duration_s = 8.0
carriage_speed_m_s = 1.0
zero_before = "zero"
zero_after = "zero"
"""
HEEL = '[heel]\nheld = "set"\ngm_m = 0.02\nbm_m = 0.115\ninertia_kg_m2 = 4.6\n'
DECAY = """
[[at_rest]]
name = "decay-{0}"
kind = "free-decay"
file = "decay-{0}.csv"
duration_s = 45.0
release_rad = {1}
"""


def let_go(release_rad: float, seed: int) -> np.ndarray:
    """Heel as an inclinometer has it: held for five seconds, then free."""

    def rates(_: float, state: np.ndarray) -> list[float]:
        heel, rate = state
        arm = (GM_M + 0.5 * BM_M * np.tan(heel) ** 2) * np.sin(heel)
        moment = K_P * rate - MASS_KG * GRAVITY * arm
        return [rate, moment / (INERTIA_KG_M2 - K_PDOT)]

    time_s = np.arange(0.0, 40.0, 0.05)
    free = solve_ivp(rates, (0.0, 40.0), [release_rad, 0.0], "DOP853", time_s, rtol=1e-9).y[0]
    heel = np.concatenate((np.full(100, release_rad), free))
    heel += 1e-4 * np.random.default_rng(seed).standard_normal(heel.size)
    nothing = np.zeros((3, heel.size))
    return np.column_stack((np.arange(heel.size) * 0.05, *nothing, heel))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    head = "t,aft,fore,x,heel"
    for name, resistance in (("zero", 0.0), ("tow", 5.0)):
        written(tmp_path / f"{name}.csv", (0.0, 0.0, resistance), 0.0, 3)
        path = tmp_path / f"{name}.csv"
        path.write_text(path.read_text().replace("t,aft,fore,x,r", head), encoding="utf-8")
    text = HEAD + HEEL
    for k, release in enumerate((0.1, -0.12, 0.14)):
        table = let_go(release, 20 + k)
        np.savetxt(tmp_path / f"decay-{k}.csv", table, "%.7f", ",", header=head, comments="")
        text += DECAY.format(k, release)
    (tmp_path / "campaign.toml").write_text(text, encoding="utf-8")
    return tmp_path


def coefficients(folder: Path, status: int = 0) -> dict:
    done = CliRunner().invoke(cli, ["coefficients", str(folder), "--json"])
    assert done.exit_code == status, done.output
    return json.loads(done.stdout)


def test_damping_and_added_inertia_come_back_and_gm_is_in_their_budget(folder: Path) -> None:
    plain = {one["name"]: one for one in coefficients(folder)["recommended"]}
    for name, value in (("K_p", K_P), ("K_pdot", K_PDOT)):
        assert plain[name]["value"] == pytest.approx(value, rel=0.02), name
        off = abs(plain[name]["value"] - value)
        assert off < 3.0 * plain[name]["standard_uncertainty"], name
    (folder / "coefficients.toml").write_text("[decays]\nu_gm_m = 2e-4\n", encoding="utf-8")
    stated = {one["name"]: one for one in coefficients(folder)["recommended"]}
    # K_pdot = I - m g GM / w0^2: 1 % of GM is 1 % of I - K_pdot.
    assert stated["K_pdot"]["standard_uncertainty"] == pytest.approx(0.055, rel=0.05)


def test_decays_that_were_towed_as_fast_are_joined(folder: Path) -> None:
    """A carriage that is set to 1 m/s is measured within 1 % of that; 1.05 m/s is another speed."""
    path = folder / "campaign.toml"
    text = path.read_text()
    for k, speed in enumerate((1.05, 1.0, 1.006)):
        file = f'file = "decay-{k}.csv"\n'
        text = text.replace(file, f"{file}carriage_speed_m_s = {speed}\n")
    path.write_text(text, encoding="utf-8")
    found, failures = decays_of(read_campaign(path), folder)
    assert failures == ()
    assert [(one.speed_m_s, [run.name for run in one.runs]) for one in found] == [
        (1.0, ["decay-1", "decay-2"]),
        (1.05, ["decay-0"]),
    ]


def test_without_stability_period_and_damping_are_all_that_is_told(folder: Path) -> None:
    path = folder / "campaign.toml"
    text = path.read_text().replace("gm_m = 0.02\nbm_m = 0.115\n", "")
    path.write_text(text, encoding="utf-8")
    document = coefficients(folder)
    assert "K_p" not in {one["name"] for one in document["recommended"]}
    shown = CliRunner().invoke(cli, ["coefficients", str(folder)]).output
    assert "state gm_m and inertia_kg_m2 in [heel]" in " ".join(shown.split())


def test_a_decay_without_its_channel_is_told_and_stops_nothing(folder: Path) -> None:
    path = folder / "campaign.toml"
    path.write_text(path.read_text().replace('heel_angle = "heel:rad"\n', ""), encoding="utf-8")
    document = coefficients(folder, status=1)
    assert [one["name"] for one in document["failed"]] == ["decay-0", "decay-1", "decay-2"]
    assert "heel_angle" in document["failed"][0]["message"]
    assert any(one["name"] == "X_0" for one in document["recommended"])
