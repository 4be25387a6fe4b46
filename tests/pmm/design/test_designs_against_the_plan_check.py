"""``pmm plan design`` on the example against the plan's own check, and bad files against words."""

import json
from pathlib import Path
from shutil import copy

import pytest
from click.testing import CliRunner, Result

from pmm.cli import cli
from pmm.plan.checks import check_plan
from pmm.plan.duration import duration_rows
from pmm.plan.findings import PlanVerdict
from pmm.plan.plan import read_plan_and_rig
from tests.pmm.sequential.campaigns import written

EXAMPLE = Path("examples/horizontal")
DESIGN = """
name = "small"
rig = "rig.toml"
[defaults]
pause_s = 60.0
[[grid]]
motion = "sway"
frequencies_hz = [0.1, 0.15]
amplitudes_mm = [75.0, 150.0]
speeds_m_s = 1.2
periods = [3, 6]
[[grid]]
motion = "yaw"
frequencies_hz = [0.1, 0.15]
amplitudes_mm = [75.0, 150.0]
speeds_m_s = 1.2
[noise]
force_n = 1.0
"""


def _design(folder: Path, text: str, *more: str) -> Result:
    for one in EXAMPLE.glob("*.toml"):
        copy(one, folder)
    file = folder / "design.toml"
    file.write_text(text, encoding="utf-8")
    return CliRunner().invoke(cli, ["plan", "design", str(file), *more])


@pytest.mark.slow
def test_the_example_makes_a_plan_that_the_check_passes(tmp_path: Path) -> None:
    text = (EXAMPLE / "design.toml").read_text(encoding="utf-8")
    target = tmp_path / "designed.toml"
    result = _design(tmp_path, text, "--output", str(target), "--json", "--plot", str(tmp_path))
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    assert told["possible"]
    assert not told["unmet"]
    plan, rig = read_plan_and_rig(target)
    verdicts = {one.verdict for one in check_plan(plan, rig)}
    assert verdicts == {PlanVerdict.NOTE}
    made = [run for run in plan.runs if run.oscillates]
    assert len(made) == sum(step["repeats"] for step in told["steps"])
    assert [run.set_point.frequency_hz for run in made if run.repeat == 1] == [
        step["frequency_hz"] for step in told["steps"]
    ]
    whole_s = sum(duration_rows(plan.runs, rig))
    assert told["steps"][-1]["time_s"] == pytest.approx(whole_s, rel=0.03)
    assert (tmp_path / "horizontal-designed-uncertainty.png").stat().st_size > 10_000


@pytest.mark.slow
def test_less_time_leaves_targets_and_says_why(tmp_path: Path) -> None:
    targets = "repeat_relative = 0.03\n[targets]\nY_v = 1.0\nN_r = 0.5\n"
    whole = _design(tmp_path, DESIGN + targets, "--json")
    assert whole.exit_code == 0, whole.output
    used_h = json.loads(whole.stdout)["steps"][-1]["time_s"] / 3600.0
    less = _design(tmp_path, f"{DESIGN}{targets}[limits]\ntime_h = {0.6 * used_h}\n", "--json")
    assert less.exit_code == 1
    told = json.loads(less.stdout)
    assert told["steps"][-1]["time_s"] <= 0.6 * 3600.0 * used_h
    assert any("raise limits.time_h" in one for one in told["unmet"])


def test_what_no_run_lowers_is_named(tmp_path: Path) -> None:
    text = DESIGN + "[targets]\nY_vdot = 0.3\n[stated]\nmass_kg = 0.5\n[limits]\ntime_h = 2.0\n"
    result = _design(tmp_path, text)
    assert result.exit_code == 1
    assert "is mass_kg, which no run lowers" in " ".join(result.stdout.split())


def test_without_targets_the_time_is_used(tmp_path: Path) -> None:
    result = _design(tmp_path, DESIGN + "[limits]\ntime_h = 0.5\n", "--json")
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    assert 0.7 * 1800.0 < told["steps"][-1]["time_s"] <= 1800.0
    assert all(one["standard_uncertainty"] is not None for one in told["coefficients"])


def test_own_limits_leave_runs_out(tmp_path: Path) -> None:
    text = DESIGN + "[targets]\nY_v = 5.0\n[limits]\nw_u_g = 0.09\n"
    told = json.loads(_design(tmp_path, text, "--json").stdout)
    assert told["left_out"] == {"w U / g": 6}
    assert {step["frequency_hz"] for step in told["steps"]} == {0.1}


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ("[targets]\nY_w = 1.0", "did you mean"),
        ("[targets]\nQ_zz = 1.0", "that nothing is believed of"),
        ('[targets]\nY_v = "-2 %"', "should be a number above 0"),
        ("[targets]\nY_v = 0.0", "should be a number above 0"),
        ('[targets]\n"Y_v at 0.3 to 0.1 Hz" = 1.0', "from low to high"),
        ('[targets]\n"Y_v at 1 to 2 Hz" = 1.0', "no frequency of the grid"),
        ('[targets]\nY_r = "2 %"\n[believed]\nY_v = -120.0\nY_r = 1e-3', "a value near zero"),
        ("[targets]\nY_v = 1.0\n[believed]\nY_v = -120.0\nX_vv = 1.0", "not for X"),
        ("[targets]\nY_v = 1.0\n[believed]\nY_q = 1.0", "Y_q"),
        ("", "targets are missing"),
        ("[limits]\ntime_hours = 1.0", "did you mean time_h"),
        ("[[grid]]\nkind = 'zero'\n[targets]\nY_v = 1.0", "only oscillations in water"),
        ("[[grid]]\nmotion = 'heave'\nfrequencies_hz = 1.0\namplitudes_mm = 1.0", "grid[3]"),
        ("[targets]\nY_v = 1.0\n[limits]\nw_u_g = 1e-3", "has no run that may be made"),
    ],
)
def test_bad_files_are_one_sentence_each(tmp_path: Path, change: str, words: str) -> None:
    result = _design(tmp_path, f"{DESIGN}\n{change}\n")
    assert result.exit_code != 0
    said = str(result.exception) + result.output
    assert words in said
    assert "design.toml" in said
    assert "Traceback" not in said


@pytest.mark.slow
def test_many_short_runs_of_two_settings_take_the_time_of_their_plan(tmp_path: Path) -> None:
    target = tmp_path / "designed.toml"
    design = written(tmp_path, repeat=0.02)
    words = ["plan", "design", str(design), "--output", str(target), "--json"]
    told = json.loads(CliRunner().invoke(cli, words).stdout)
    plan, rig = read_plan_and_rig(target)
    assert len(plan.runs) > 30
    whole_s = sum(duration_rows(plan.runs, rig))
    assert told["steps"][-1]["time_s"] == pytest.approx(whole_s, rel=0.03)
