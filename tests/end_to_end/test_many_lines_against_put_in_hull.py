"""Runs of eight lines, simulated and analysed by the commands, against the hull that was put in.

The simulator and the analysis share no equations. Two runs, in sway and in yaw, tell at each line
what takes two runs for each frequency with single sines.
"""

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from pmm.cli import cli

BASE_HZ = 0.1
ORDERS = (3, 5, 7, 9, 11, 13, 15, 17)
HULL = {
    "Y_vdot": -62.0, "Y_v": -120.0, "N_vdot": -2.0, "N_v": -40.0,
    "Y_rdot": -2.0, "Y_r": 15.0, "N_rdot": -18.0, "N_r": -35.0,
}  # fmt: skip
EXAMPLE = Path(__file__).parents[2] / "examples" / "lines" / "campaign.toml"


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("lines") / "made"
    simulated = CliRunner().invoke(cli, ["simulate", str(EXAMPLE), "--output", str(folder)])
    assert simulated.exit_code == 0, simulated.output
    return folder


@pytest.fixture(scope="module")
def told(made: Path) -> dict:  # type: ignore[type-arg]
    shown = CliRunner().invoke(cli, ["coefficients", str(made), "--json"])
    assert shown.exit_code == 0, shown.output
    found: dict = json.loads(shown.stdout)  # type: ignore[type-arg]
    return found


@pytest.mark.slow
def test_eight_coefficients_at_eight_frequencies(told: dict) -> None:  # type: ignore[type-arg]
    linear = [one for one in told["coefficients"]["table"] if one["method"] == "linear"]
    assert len(linear) == len(HULL) * len(ORDERS)
    off = []
    for one in linear:
        assert round(one["frequency_hz"] / BASE_HZ) in ORDERS
        off.append((one["value"] - HULL[one["name"]]) / one["half_width"])
    held = np.mean(np.abs(off) < 1.0)
    assert held > 0.85  # 95 % of 64, and three standard deviations
    assert np.abs(off).max() < 2.0


def test_runs_are_named_by_their_lines(told: dict) -> None:  # type: ignore[type-arg]
    names = {name for one in told["coefficients"]["table"] for name in one["runs"]}
    assert {"sway line 3", "yaw line 17"} <= names


def test_settled_runs_show_no_transient(told: dict) -> None:  # type: ignore[type-arg]
    assert '"transient"' not in json.dumps(told)


def test_recordings_fit_their_set_points(told: dict) -> None:  # type: ignore[type-arg]
    assert "set_point_differs" not in json.dumps(told)


@pytest.mark.slow
def test_a_report_has_responses_and_runs_deliverables(made: Path, tmp_path: Path) -> None:
    page, folder = tmp_path / "page.html", tmp_path / "simman"
    done = CliRunner().invoke(cli, ["report", str(made), "--output", str(page)])
    assert done.exit_code == 0, done.output
    text = page.read_text(encoding="utf-8")
    for run in ("sway", "yaw"):
        section = text.partition(f"Response by lines: {run}</h2>")[2].partition("<h2")[0]
        assert "Response to displacement_aft" in section
        assert section.count("<svg") == 1
        turns = run == "yaw"  # the gauges turn with the model: loads of odd degree in its angle
        assert ("more than noise" in section) == turns, "the hull is linear"
    done = CliRunner().invoke(cli, ["coefficients", str(made), "--simman", str(folder)])
    assert done.exit_code == 0, done.output
    assert sorted(one.name for one in folder.iterdir()) == ["sway", "yaw"]


def test_a_linear_hull_is_linear_all_lines_together(told: dict) -> None:  # type: ignore[type-arg]
    choices = told["coefficients"]["choices"]
    assert {one["load"] for one in choices} == {"force", "moment"}
    assert {one["fitted"] for one in choices} == {"linear"}


def test_a_diagnosis_says_that_it_takes_runs_of_one_frequency(made: Path) -> None:
    done = CliRunner().invoke(cli, ["gap", str(made)])
    assert done.exit_code == 1
    assert "sway: moved at 8 frequencies at once" in done.stderr
    assert "pmm coefficients takes it" in done.stderr
