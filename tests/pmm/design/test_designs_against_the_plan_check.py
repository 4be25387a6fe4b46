"""``pmm plan design`` on the example against the plan's own check, and bad files against words."""

import json
from dataclasses import replace
from pathlib import Path
from shutil import copy

import pytest
from click.testing import CliRunner, Result

from pmm.cli import cli
from pmm.design.design_file import read_design
from pmm.design.plan_writer import plan_head, run_entry
from pmm.plan.checks import check_plan
from pmm.plan.duration import duration_rows
from pmm.plan.findings import PlanVerdict
from pmm.plan.plan import read_plan_and_rig
from pmm.toml_text import toml_table
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
    assert told["steps"][-1]["time_s"] == pytest.approx(whole_s)
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


CONTROL = """
[control]
motion = "sway"
frequency_hz = 0.15
amplitude_mm = 75.0
speed_m_s = 1.2
every = 2
[zero]
duration_s = 20.0
every = 3
[[runs]]
kind = "dry"
motion = "sway"
frequencies_hz = 0.15
amplitudes_mm = 150.0
"""


@pytest.mark.parametrize("tables", ["", CONTROL])
def test_the_times_are_those_of_the_plan_that_is_written(tmp_path: Path, tables: str) -> None:
    target = tmp_path / "designed.toml"
    text = f"{DESIGN}repeat_relative = 0.02\n[targets]\nY_v = 2.0\nN_r = 1.0\n{tables}"
    result = _design(tmp_path, text, "--output", str(target), "--json")
    assert result.exit_code == 0, result.output
    steps = json.loads(result.stdout)["steps"]
    plan, rig = read_plan_and_rig(target)
    assert steps[-1]["time_s"] == pytest.approx(sum(duration_rows(plan.runs, rig)))
    assert sorted(step["time_s"] for step in steps) == [step["time_s"] for step in steps]


GRID = """
name = "every run"
rig = "rig.toml"
[defaults]
settling_periods = 2
[[grid]]
motion = "yaw-drift"
frequencies_hz = [0.1, 0.15]
amplitudes_mm = 75.0
speeds_m_s = 1.2
drifts_deg = [0.0, 4.0]
periods = [3, 5]
[[grid]]
motion = "sway"
name = "leaned"
frequencies_hz = 0.1
amplitudes_mm = 75.0
speeds_m_s = [0.0, 1.2]
drifts_deg = [-2.0, 0.0]
prompt = "look"
pause_s = 7.0
[[grid]]
motion = "yaw"
frequencies_hz = 0.1
amplitudes_mm = 75.0
speeds_m_s = 1.2
exact = true
[[grid]]
motion = "phase"
frequencies_hz = 0.1
amplitudes_mm = 75.0
strut_phases_deg = [0.0, 90.0]
[noise]
force_n = 1.0
[limits]
time_h = 1.0
advised = false
"""


def test_each_run_of_a_grid_is_the_one_that_is_written(tmp_path: Path) -> None:
    for one in EXAMPLE.glob("*.toml"):
        copy(one, tmp_path)
    (tmp_path / "design.toml").write_text(GRID, encoding="utf-8")
    file = read_design(tmp_path / "design.toml")
    assert len(file.grid.runs) == 8 + 4 + 1 + 2
    target = tmp_path / "plan.toml"
    entries = [
        toml_table("runs", run_entry(file.grid.entry_of[run], run, number), array=True)
        for number, run in enumerate(file.grid.runs)
    ]
    target.write_text("\n".join([*plan_head(file, target), *entries]), encoding="utf-8")
    again = read_plan_and_rig(target)[0].runs
    assert [replace(run, name="", entry="") for run in again] == [
        replace(run, name="", entry="") for run in file.grid.runs
    ]


@pytest.mark.parametrize("time_h", ["", "time_h = 1.0"])
def test_what_no_run_of_the_grid_tells_takes_no_time(tmp_path: Path, time_h: str) -> None:
    first, _, second = DESIGN.partition('[[grid]]\nmotion = "yaw"')
    text = f"{first}[noise]{second.partition('[noise]')[2]}[targets]\nN_r = 1.0\n[limits]\n{time_h}"
    result = _design(tmp_path, text, "--output", str(tmp_path / "none.toml"))
    assert result.exit_code == 1
    said = " ".join(result.stdout.split())
    assert "0 runs of" in said
    assert "cannot be determined" in said
    assert "there is no plan to be written" in said
    assert not (tmp_path / "none.toml").exists()


def test_too_little_time_for_any_run_meets_no_target(tmp_path: Path) -> None:
    result = _design(tmp_path, f"{DESIGN}[targets]\nY_v = 5.0\n[limits]\ntime_h = 0.005\n")
    assert result.exit_code == 1
    assert "1 target cannot be met" in result.stdout


def test_a_target_out_of_reach_takes_no_time_of_the_others(tmp_path: Path) -> None:
    near = f"{DESIGN}repeat_relative = 0.01\n[targets]\nY_v = 2.0\n"
    far = near + "Y_vdot = 0.3\n[stated]\nmass_kg = 0.5\n"
    alone, both = (json.loads(_design(tmp_path, text, "--json").stdout) for text in (near, far))
    assert both["steps"][-1]["time_s"] == pytest.approx(alone["steps"][-1]["time_s"])
    assert [("Y_vdot" in why, "no run lowers" in why) for why in both["unmet"]] == [(True, True)]


def test_what_is_told_at_some_frequencies_is_not_made_better_for_the_others(
    tmp_path: Path,
) -> None:
    """At 0.12 Hz the grid has sway alone, which tells nothing of turning there."""
    target = '[targets]\n"N_r at 0.1 to 0.15 Hz" = 3.0\n'
    sway = (
        "[[grid]]\nmotion = 'sway'\nfrequencies_hz = 0.12\namplitudes_mm = 150.0\n"
        "speeds_m_s = 1.2\n"
    )
    alone, more = (
        json.loads(_design(tmp_path, f"{DESIGN}{grid}{target}", "--json").stdout)
        for grid in ("", sway)
    )
    assert more["steps"][-1]["time_s"] == pytest.approx(alone["steps"][-1]["time_s"])
    assert not alone["unmet"]
    assert [why.startswith("N_r at 0.12 Hz") for why in more["unmet"]] == [True]


def test_runs_of_one_frequency_do_not_meet_a_target_of_two(tmp_path: Path) -> None:
    runs = "".join(
        f"[[runs]]\nmotion = '{motion}'\nname = 'first-{motion}'\nfrequencies_hz = 0.1\n"
        "amplitudes_mm = 150.0\nspeeds_m_s = 1.2\n"
        for motion in ("sway", "yaw")
    )
    text = f'{DESIGN}{runs}[targets]\n"Y_v at 0.1 to 0.15 Hz" = 3.0\n'
    told = json.loads(_design(tmp_path, text, "--json").stdout)
    assert {step["frequency_hz"] for step in told["steps"]} == {0.15}
    assert not told["unmet"]


def test_what_the_runs_made_in_any_case_meet_is_not_made_better_for_what_none_tells(
    tmp_path: Path,
) -> None:
    runs = "".join(
        f"[[runs]]\nmotion = '{motion}'\nname = 'first-{motion}'\nfrequencies_hz = [0.1, 0.15]\n"
        "amplitudes_mm = 150.0\nspeeds_m_s = 1.2\n"
        for motion in ("sway", "yaw")
    )
    sway = (
        "[[grid]]\nmotion = 'sway'\nfrequencies_hz = 0.12\namplitudes_mm = 150.0\n"
        "speeds_m_s = 1.2\n"
    )
    target = '[targets]\n"N_r at 0.1 to 0.15 Hz" = {}\n'
    known = json.loads(_design(tmp_path, f"{DESIGN}{runs}{target.format(30.0)}", "--json").stdout)
    just = 1.05 * max(one["standard_uncertainty"] for one in known["coefficients"])
    text = f"{DESIGN}{runs}{sway}{target.format(just)}"
    told = json.loads(_design(tmp_path, text, "--json").stdout)
    assert told["steps"] == []
    assert [why.startswith("N_r at 0.12 Hz") for why in told["unmet"]] == [True]


SWAYS = (
    "[[runs]]\nmotion = 'sway'\nname = 'first'\nfrequencies_hz = [0.1, 0.15]\n"
    "amplitudes_mm = 150.0\nspeeds_m_s = 1.2\n"
)


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ("rudder_angles_deg = 20.0", "with a laid rudder"),
        ("revolutions_hz = 8.0", "at another rate"),
        ("lines = [3, 5]", "runs of many lines"),
    ],
)
def test_a_run_that_the_analysis_leaves_out_meets_no_target(
    tmp_path: Path, change: str, why: str
) -> None:
    """With such runs besides, the design is that without them."""
    targets = "[targets]\nY_v = 3.0\n"
    alone = json.loads(_design(tmp_path, DESIGN + targets, "--json").stdout)
    runs = SWAYS.replace("[0.1, 0.15]", "0.03") if "lines" in change else SWAYS
    result = _design(tmp_path, f"{DESIGN}{runs}{change}\n{targets}", "--json")
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    assert alone["steps"]
    for key in ("motion", "frequency_hz", "eccentricity_m", "periods", "repeats"):
        assert [step[key] for step in told["steps"]] == [step[key] for step in alone["steps"]]
    assert told["uncounted"]
    assert all(name.startswith("first") for name in told["uncounted"])
    assert all(why in reason for reason in told["uncounted"].values())


def test_a_plan_is_written_where_what_is_made_in_any_case_is_enough(tmp_path: Path) -> None:
    target = tmp_path / "designed.toml"
    text = f"{DESIGN}{SWAYS}[targets]\nY_v = 100.0\n"
    result = _design(tmp_path, text, "--output", str(target), "--json")
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    assert (told["steps"], told["unmet"], told["uncounted"]) == ([], [], {})
    plan, _ = read_plan_and_rig(target)
    assert [run.set_point.frequency_hz for run in plan.runs if run.oscillates] == [0.1, 0.15]


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
        ("[limits]\ntime_h = 0.0", "should be above 0"),
        ("[targets]\nY_v = 1.0\n[limits]\nrotation_deg = -1.0", "should be above 0"),
        (
            "[[grid]]\nmotion = 'sway'\nfrequencies_hz = 0.1\namplitudes_mm = 9.0\n"
            "lines = [1, 3]\n[targets]\nY_v = 1.0",
            "motions of many lines",
        ),
        (
            "[[grid]]\nmotion = 'sway'\nfrequencies_hz = 0.1\namplitudes_mm = 9.0\n"
            "rudder_angles_deg = 20.0\n[targets]\nY_v = 1.0",
            "it oscillates with a laid rudder",
        ),
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
    assert told["steps"][-1]["time_s"] == pytest.approx(whole_s)


def test_a_grid_of_one_motion_is_designed_for_what_it_tells(tmp_path: Path) -> None:
    """Runs in sway alone tell what goes with v, as the analysis of them does, and nothing of r."""
    sway, _, _ = DESIGN.partition('[[grid]]\nmotion = "yaw"')
    targets = '[noise]\nforce_n = 1.0\n[targets]\nY_v = "2 %"\nN_v = "5 %"\nN_r = "2 %"\n'
    told = json.loads(_design(tmp_path, sway + targets, "--json").stdout)
    met = {row["name"]: row["met"] for row in told["coefficients"]}
    assert met["Y_v"]
    assert met["N_v"]
    (why,) = told["unmet"]
    assert "N_r cannot be determined" in why
    assert "add a run in yaw" in why
    assert told["steps"]
