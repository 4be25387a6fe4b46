"""``pmm evaluate`` on a campaign of tests: tables, document, figures, files and exit status."""

import json
import shutil
import tomllib
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from pmm.campaign.calibrated_recording import APPLIED, CARRIED
from pmm.campaign.calibration import read_calibration
from pmm.cli import cli
from pmm.plan.rig_file import read_rig_file
from pmm.recorder.files import HARMONICS
from tests.pmm.plan.plans import EXAMPLES

# Of noise by which no chart raises one of its false alarms (docs/run-control.md has their rate).
PLAN = """
name = "tests"
rig = "rig.toml"
[defaults]
periods = 3
settling_periods = 1
pause_s = 0.6
duration_s = 2.0
[zero]
duration_s = 2.0
every = 4
[control]
motion = "heave"
frequency_hz = 1.4
amplitude_mm = 20.0
every = 1
[[runs]]
kind = "check-weight"
loads_n = [0.0, 50.0, 100.0]
[[runs]]
kind = "restoring"
motion = "heave"
amplitudes_mm = 20.0
[[runs]]
kind = "straight-tow"
speeds_m_s = [0.6, 1.2]
[[runs]]
motion = "heave"
frequencies_hz = [1.2, 1.3, 1.4, 1.5, 1.6, 1.7]
amplitudes_mm = 10.0
"""


def made(folder: Path) -> Path:
    """Run the plan on the simulated rig of the example."""
    for name in ("rig.toml", "simulated.toml"):
        shutil.copy(EXAMPLES / "vertical" / name, folder / name)
    (folder / "plan.toml").write_text(PLAN, encoding="utf-8")
    done = pmm("run", folder / "plan.toml", "--output", folder / "campaign")
    assert done.exit_code == 0, done.stderr
    return folder / "campaign"


@pytest.fixture(scope="module")
def campaign(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return made(tmp_path_factory.mktemp("rig"))


@pytest.fixture
def copy(campaign: Path, tmp_path: Path) -> Path:
    shutil.copytree(campaign, tmp_path / "campaign")
    return tmp_path / "campaign"


def pmm(*words: str | Path) -> Result:
    return CliRunner().invoke(cli, [str(one) for one in words])


@pytest.mark.slow
def test_every_test_has_its_table_and_its_figure(copy: Path, tmp_path: Path) -> None:
    said = pmm("evaluate", copy, "--plot", tmp_path / "plots", "--valid-days", "30")
    assert said.exit_code == 0, said.output
    for title in ("Zeros", "Calibration of", "Restoring", "Towed"):
        assert title in said.stdout
    assert "control force_aft amplitude" in said.stdout
    names = {one.name for one in (tmp_path / "plots").iterdir()}
    wanted = ("control-chart", "restoring", "straight-tow")
    assert names == {f"{name}.{kind}" for name in wanted for kind in ("svg", "png")}
    one = read_calibration(copy / "calibration.toml")
    assert (one.expires - one.made).days == 30


@pytest.mark.slow
def test_the_document_says_the_same(copy: Path) -> None:
    said = pmm("evaluate", copy, "--json")
    assert said.exit_code == 0, said.output
    document = json.loads(said.stdout)
    assert document["schema"] == "pmm-evaluation-1"
    (one,) = document["restoring"]
    assert (one["motion"], one["hydrostatic_force"]) == ("heave", 6900.0)
    assert abs(one["force"] - 6900.0) < 2.0 * one["force_half_width"]
    assert [tow["speed_m_s"] for tow in document["tows"]] == [0.6, 1.2]
    assert document["tows"][0]["resistance_n"] is None, "this rig has no surge gauge"
    assert len(document["control"]) == 4, "amplitude and phase of two forces"
    assert document["in_control"] is True
    assert (document["notes"], document["failed"]) == ([], [])
    matrix = document["calibration"]["matrix"]
    assert matrix[0][0] == pytest.approx(1.0, abs=1e-3)
    assert tomllib.loads((copy / "calibration.toml").read_text())["matrix"] == matrix


@pytest.mark.slow
def test_a_step_of_the_control_condition_is_status_1(copy: Path) -> None:
    for run in sorted(copy.glob("control-*"))[4:]:
        path = run / HARMONICS
        lines = [json.loads(one) for one in path.read_text(encoding="utf-8").splitlines()]
        row = lines[-1]["channels"].index("force_aft")
        lines[-1]["coefficients"][row] = [1.1 * x for x in lines[-1]["coefficients"][row]]
        path.write_text("".join(json.dumps(one) + "\n" for one in lines), encoding="utf-8")
    said = pmm("evaluate", copy)
    assert said.exit_code == 1
    (line,) = [one for one in said.stdout.splitlines() if "a step of" in one]
    assert line.startswith("control force_aft amplitude")
    assert "before control-05" in line


@pytest.mark.slow
def test_too_few_repeats_are_said_to_be_too_few(copy: Path) -> None:
    for run in sorted(copy.glob("control-*"))[3:]:
        shutil.rmtree(run)
    said = pmm("evaluate", copy)
    assert said.exit_code == 0, said.output
    assert "control condition: 3 of the 4 repeats that a chart needs" in said.stderr
    assert "control force_aft" not in said.stdout


@pytest.mark.slow
def test_a_test_that_shows_nothing_fails_alone(copy: Path) -> None:
    for run in sorted(copy.glob("check-weight-force_aft-*"))[2:]:
        shutil.rmtree(run)
    said = pmm("evaluate", copy)
    assert said.exit_code == 1
    assert "force_aft: 2 check weights" in said.stderr
    assert "Restoring" in said.stdout
    assert not (copy / "calibration.toml").exists()


def test_wrong_usage_is_status_2(tmp_path: Path) -> None:
    assert pmm("evaluate", tmp_path / "nowhere").exit_code == 2
    empty = pmm("evaluate", tmp_path)
    assert empty.exit_code == 1
    assert "no complete run that `pmm run` made" in empty.stderr


@pytest.mark.slow
def test_a_calibration_goes_from_check_weights_to_the_next_analysis(
    copy: Path, tmp_path: Path
) -> None:
    """Its matrix is made wrong by 2 % here, so that it can be seen where it is applied."""
    assert pmm("evaluate", copy).exit_code == 0
    rig = tmp_path / "rig"
    rig.mkdir()
    for name in ("rig.toml", "simulated.toml"):
        shutil.copy(EXAMPLES / "vertical" / name, rig / name)
    text = (rig / "rig.toml").read_text(encoding="utf-8")
    (rig / "rig.toml").write_text(f'calibration_file = "calibration.toml"\n{text}')
    table = (copy / "calibration.toml").read_text(encoding="utf-8").splitlines()
    table = ["matrix = [[1.02, 0.0], [0.0, 1.0]]" if one.startswith("matrix") else one
             for one in table]  # fmt: skip
    table = ['made = "2024-01-01"' if one.startswith("made") else one for one in table]
    table = ['expires = "2025-01-01"' if one.startswith("expires") else one for one in table]
    (rig / "calibration.toml").write_text("\n".join(table), encoding="utf-8")
    assert read_rig_file(rig / "rig.toml").calibration is not None
    (rig / "plan.toml").write_text(
        'name = "next"\nrig = "rig.toml"\n[defaults]\nperiods = 3\npause_s = 0.0\n'
        '[[runs]]\nmotion = "heave"\nfrequencies_hz = 1.0\namplitudes_mm = 20.0\n'
    )
    done = pmm("run", rig / "plan.toml", "--output", rig / "next")
    assert done.exit_code == 0, done.stderr
    assert "expired on 2025-01-01" in " ".join(done.stderr.split())
    amplitudes = {}
    for how in ((), ("--calibration", "none"), ("--calibration", rig / "calibration.toml")):
        said = pmm("analyse", rig / "next", "--json", *how)
        assert said.exit_code == 0, said.output
        (run,) = json.loads(said.stdout)["runs"]
        codes = [flag["code"] for flag in run["flags"]]
        assert ("calibration_expired" in codes) == (how[1:] != ("none",))
        (gate,) = run["gates"]
        amplitudes[how] = {
            one["name"]: one["harmonics"][0]["amplitude"]["value"] for one in gate["channels"]
        }
    own, raw, given = amplitudes.values()
    assert own == given
    assert raw["force_aft"] / own["force_aft"] == pytest.approx(1.02, rel=1e-9)
    assert raw["force_fore"] == pytest.approx(own["force_fore"], rel=1e-9)
    saved = tmp_path / "saved"
    assert pmm("analyse", rig / "next", "--save", saved).exit_code == 0
    again = pmm("analyse", next(saved.glob("*.nc")), "--calibration", rig / "calibration.toml")
    assert again.exit_code == 1
    assert "applied to it already" in " ".join(again.stderr.split())
    assert CARRIED != APPLIED
