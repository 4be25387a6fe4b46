"""A design that is carried out in two parts on the simulated rig, against the rig's own hull."""

import json
import tomllib
from pathlib import Path
from shutil import copy
from typing import Any

import pytest
from click.testing import CliRunner

from pmm.cli import cli

EXAMPLE = Path("examples/vertical")
DESIGN = """
name = "heave-pitch"
rig = "rig.toml"
[defaults]
settling_periods = 1
[zero]
duration_s = 2.0
every = 10
[[grid]]
motion = "heave"
frequencies_hz = 1.0
amplitudes_mm = [10.0, 20.0]
periods = [4, 8]
[[grid]]
motion = "pitch"
frequencies_hz = 1.0
amplitudes_mm = [10.0, 20.0]
periods = [4, 8]
[noise]
force_n = 0.5
repeat_relative = 0.01
[targets]
Z_w = "3 %"
M_q = "3 %"
"""


def _pmm(status: int, *words: object) -> Any:
    done = CliRunner().invoke(cli, [*map(str, words), "--json"])
    assert done.exit_code == status, done.output
    return json.loads(done.stdout)


@pytest.mark.slow
def test_two_parts_meet_the_targets_and_find_the_hull(tmp_path: Path) -> None:
    for one in EXAMPLE.glob("*.toml"):
        copy(one, tmp_path)
    design, first, second = (tmp_path / f"{one}.toml" for one in ("design", "first", "second"))
    design.write_text(DESIGN, encoding="utf-8")
    planned = _pmm(0, "plan", "design", design, "--output", first)
    runs = [one for one in _pmm(0, "plan", "show", first)["runs"] if one["kind"] == "oscillation"]
    zeros = ["zero-01", "zero-02"]
    half = [one["name"] for one in runs[:2]]
    only = [word for name in (*half, *zeros) for word in ("--only", name)]
    _pmm(0, "run", first, "--output", tmp_path / "c1", *only)

    after = ("--after", tmp_path / "c1")
    going_on = _pmm(0, "plan", "design", design, *after, "--output", second)
    assert going_on["runs_made"] == 2
    left = sum(step["repeats"] for step in going_on["steps"])
    assert 0 < left <= 2 * sum(step["repeats"] for step in planned["steps"])
    names = {one["name"] for one in _pmm(0, "plan", "show", second)["runs"]}
    assert not names & set(half)
    _pmm(0, "run", second, "--output", tmp_path / "c2")

    known = _pmm(0, "plan", "design", design, *after, "--after", tmp_path / "c2")["known"]
    hull = tomllib.loads((EXAMPLE / "rig.toml").read_text(encoding="utf-8"))["hull"]["damping"]
    truth = {"Z_w": -hull[0][0], "M_q": -hull[1][1]}
    for one in known:
        assert abs(one["value"] - truth[one["name"]]) < 3.0 * one["standard_uncertainty"]


def test_a_folder_of_another_rig_is_refused(tmp_path: Path) -> None:
    for one in EXAMPLE.glob("*.toml"):
        copy(one, tmp_path)
    design = tmp_path / "design.toml"
    design.write_text(DESIGN, encoding="utf-8")
    words = ["plan", "design", str(design), "--after", str(tmp_path / "none")]
    done = CliRunner().invoke(cli, words)
    assert done.exit_code == 2
    assert "no such folder" in str(done.exception) + done.output
