"""``pmm plan`` and its pages: numbers printed and in JSON, exit statuses, documented keys."""

import json
import re
from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

from hardware.description.body import ShipModel
from hardware.description.errors import ConfigurationError
from hardware.description.kinds import Motion, RunKind
from hardware.description.known_loads import KnownMass
from hardware.rig_configuration import TABLES
from pmm.cli import cli
from pmm.plan.duration import duration_rows
from pmm.plan.findings import PlanFinding
from pmm.plan.plan import read_plan, read_plan_and_rig
from pmm.plan.plan_tables import (
    ControlTable,
    Defaults,
    OrderTable,
    PlanEntry,
    PlanTables,
    Scheme,
    ZeroTable,
)
from pmm.plan.plan_units import EXTRA_KEYS
from pmm.plan.rig_file import read_rig_file
from pmm.plan.rig_tables import (
    HANDED_ON,
    Gauge,
    HullEstimate,
    Limits,
    PhotocellOffset,
    RecorderSettings,
    RigTables,
    StructuralMode,
    TankTable,
)
from tests.pmm.plan.plans import EXAMPLES, HEAVE, HORIZONTAL_TEXT, HOUSE, RIG_TEXT, write_plan

NAMES = ("vertical", "horizontal", "manual", "paths")


def _pmm(*arguments: object) -> Result:
    return CliRunner().invoke(cli, [str(one) for one in arguments], catch_exceptions=False)


def _example(name: str) -> Path:
    return EXAMPLES / name / "plan.toml"


@pytest.mark.parametrize("name", NAMES)
def test_the_rig_can_run_the_examples(name: str) -> None:
    found = _pmm("plan", "check", _example(name))
    assert found.exit_code == 0
    assert "the rig can run it, with 0 warnings" in found.output
    document = json.loads(_pmm("plan", "check", _example(name), "--json").stdout)
    assert document["possible"] is True
    assert {*document["findings"][0]} == {field.name for field in fields(PlanFinding)}


def test_conditions_are_a_table_of_the_largest_numbers_and_their_limits() -> None:
    """2.1 m is half the tank's width; atan(0.15 / 0.5) at most, less by the phase, and 8 deg."""
    text = _pmm("plan", "check", _example("horizontal")).output
    rows = [line.split("  ") for line in text.splitlines()]
    told = {one[0].strip(): [cell.strip() for cell in one[1:] if cell.strip()] for one in rows}
    assert told["condition"] == ["largest", "limit", "source", "in run"]
    assert told["reach to the side [m]"][1:3] == ["2.1", "the tank's wall"]
    assert told["w' = w L / U"][1:] == ["3", "ITTC 7.5-02-06-02, practice", "yaw-f0.15-a150"]
    assert told["largest yaw [deg]"][1] == "none"
    assert "reach to the side" not in text.split("condition")[0]
    every = _pmm("plan", "check", _example("horizontal"), "--all").output
    assert every.count("reach to the side [m] =") > 1
    assert "in run" not in every


def test_the_examples_hold_the_matrices_that_they_promise() -> None:
    vertical, horizontal = (read_plan(_example(name)).runs for name in NAMES[:2])
    for motion in (Motion.HEAVE, Motion.PITCH):
        points = [
            one.set_point
            for one in vertical
            if one.kind is RunKind.OSCILLATION and one.motion is motion
        ]
        assert len({one.frequency_hz for one in points}) == 6
        assert len({one.eccentricity_m for one in points}) == 2
        assert len(points) == 12
    wet = [one for one in horizontal if one.kind is RunKind.OSCILLATION]
    assert {one.motion for one in wet} == {Motion.SWAY, Motion.YAW, Motion.YAW_DRIFT}
    assert min(one.set_point.frequency_hz for one in wet) == 0.02
    assert all(one.set_point.carriage_speed_m_s for one in wet)
    # The simulated rig's structure is rigid: nothing to pluck. Nor is its model free in roll.
    kinds = {one.kind for one in (*vertical, *horizontal)}
    assert kinds == set(RunKind) - {RunKind.PLUCK, RunKind.FREE_DECAY}


def test_what_is_shown_are_the_plan_s_own_numbers() -> None:
    plan, rig = read_plan_and_rig(_example("manual"))
    document = json.loads(_pmm("plan", "show", _example("manual"), "--json").stdout)
    times = duration_rows(plan.runs, rig)
    assert document["duration_s"] == pytest.approx(sum(times))
    assert [one["name"] for one in document["runs"]] == [one.name for one in plan.runs]
    assert [one["duration_s"] for one in document["runs"]] == pytest.approx(times)
    heave = document["runs"][1]
    assert heave["strut_velocity_m_s"] == pytest.approx(2.0 * 3.141592653589793 * 0.8 * 0.01)
    table = _pmm("plan", "show", _example("manual")).output
    assert "manual-run: 13 runs, 2:50 at most" in table
    assert re.search(r"heave-f0.8-a10 +0.8 +10 +0.0 +6 ", table)


def test_the_matrix_is_drawn(tmp_path: Path) -> None:
    path = write_plan(tmp_path, HEAVE + HEAVE.replace("20.0", "70.0"))
    output = _pmm("plan", "show", path, "--plot", tmp_path).output
    figure = tmp_path / f"{tmp_path.name}-matrix.svg"
    assert figure.name in output.replace("\n", "")
    drawn = figure.read_text()
    for text in ("heave, U = 0 m/s", "refused", "limit of amplitude", "half the stroke"):
        assert text in drawn


def test_a_plan_beyond_the_rig_ends_with_status_1(tmp_path: Path) -> None:
    path = write_plan(tmp_path, HEAVE.replace("20.0", "[70.0, 80.0]"))
    found = _pmm("plan", "check", path)
    assert found.exit_code == 1
    assert "REFUSE  heave-f0.8-a80: stroke [m] = 0.16 is above 0.12" in found.output
    assert "(and 1 other run so)" in found.output
    every = _pmm("plan", "check", path, "--all").output
    assert "heave-f0.8-a70: stroke [m] = 0.14 is above 0.12" in every
    assert json.loads(_pmm("plan", "check", path, "--json").stdout)["possible"] is False


def test_a_wrong_file_or_word_ends_with_status_2(tmp_path: Path) -> None:
    assert _pmm("plan", "check", write_plan(tmp_path, "oder = 3\n" + HEAVE)).exit_code == 2
    wrong = _pmm("plan", "chek", "a.toml")
    assert wrong.exit_code == 2
    assert "did you mean 'check'?" in wrong.output


def test_a_simulated_rig_is_found_beside_its_file_and_runs_free() -> None:
    rig = read_rig_file(EXAMPLES / "horizontal" / "rig.toml")
    file = (EXAMPLES / "horizontal" / "simulated.toml").resolve().as_posix()
    assert rig.hardware.bus is not None
    assert rig.hardware.bus.channel == file
    assert rig.hardware_tables["photocell"]["port"]["url"] == f"sim://{file}/photocell"
    assert rig.realtime is False


def test_a_rig_on_a_real_bus_keeps_to_the_clock(tmp_path: Path) -> None:
    text = (EXAMPLES / "vertical" / "rig.toml").read_text(encoding="utf-8")
    text = text.replace('"pmm-simulated"', '"socketcan"').replace("simulated.toml", "can0")
    (tmp_path / "rig.toml").write_text(text)
    assert read_rig_file(tmp_path / "rig.toml").realtime is True
    (tmp_path / "rig.toml").write_text(f"realtime = false\n{text}")
    with pytest.raises(ConfigurationError, match="realtime = false is for a bus 'pmm-simulated'"):
        read_rig_file(tmp_path / "rig.toml")


def test_a_force_that_no_gauge_states_is_watched_by_its_amplifier(tmp_path: Path) -> None:
    """One gauge alone would leave the other strut without a safe load."""
    stated = '[[gauges]]\nchannel = "force_aft"\nfull_scale_n = 100.0\n'
    text = re.sub(r"\[\[gauges\]\]\n(?:\w.*\n)*", "", RIG_TEXT)
    (tmp_path / "rig.toml").write_text(text)
    amplifiers = read_rig_file(tmp_path / "rig.toml").watched.loads
    (tmp_path / "rig.toml").write_text(f"{text}\n{stated}")
    assert read_rig_file(tmp_path / "rig.toml").watched.loads == {
        **amplifiers, "force_aft": 150.0
    }  # fmt: skip


def test_modes_of_the_pluck_test_are_read(tmp_path: Path) -> None:
    text = (EXAMPLES / "vertical" / "rig.toml").read_text(encoding="utf-8")
    one = '[[modes]]\nname = "{}"\nfrequency_hz = {}\n'
    (tmp_path / "rig.toml").write_text(
        'modes_file = "modes.toml"\n' + text + one.format("frame", 20.0)
    )
    (tmp_path / "modes.toml").write_text(one.format("yaw", 8.0) + "damping_ratio = 0.01\n")
    modes = read_rig_file(tmp_path / "rig.toml").modes
    assert modes == (StructuralMode("frame", 20.0), StructuralMode("yaw", 8.0, 0.01))


def _in_code(page: str) -> set[str]:
    text = (HOUSE / "docs" / page).read_text(encoding="utf-8")
    plain = re.sub(r"```.*?```", "", text, flags=re.DOTALL)
    return set(re.findall(r"[\w-]+", " ".join(re.findall(r"`([^`\n]+)`", plain))))


@pytest.mark.parametrize(
    ("page", "kinds"),
    [
        (
            "plans.md",
            (PlanTables, PlanEntry, Defaults, OrderTable, ZeroTable, ControlTable, KnownMass),
        ),
        (
            "rig-file.md",
            (
                RigTables, ShipModel, HullEstimate, TankTable, Limits, Gauge, StructuralMode,
                PhotocellOffset, RecorderSettings,
            ),
        ),
    ],
)  # fmt: skip
def test_every_key_is_on_its_page(page: str, kinds: tuple[Any, ...]) -> None:
    keys = {field.name for kind in kinds for field in fields(kind)}
    assert keys <= _in_code(page)


def test_every_word_is_on_its_page() -> None:
    words = {str(one) for kind in (RunKind, Motion, Scheme) for one in kind} - {"none"}
    people = {key for keys in EXTRA_KEYS.values() for key in keys}
    assert words | people <= _in_code("plans.md")
    assert {*HANDED_ON, *TABLES} <= _in_code("rig-file.md")


@pytest.mark.parametrize("page", ["plans.md", "rig-file.md"])
def test_the_pages_examples_are_valid(page: str, tmp_path: Path) -> None:
    text = (HOUSE / "docs" / page).read_text(encoding="utf-8")
    blocks = re.findall(r"^```toml\n(.*?)^```", text, flags=re.MULTILINE | re.DOTALL)
    assert blocks
    for block in blocks:
        if page == "plans.md":
            rig = HORIZONTAL_TEXT if 'kind = "circle"' in block else RIG_TEXT
            assert read_plan(write_plan(tmp_path, block, rig)).runs
        else:
            (tmp_path / "rig.toml").write_text(block)
            assert read_rig_file(tmp_path / "rig.toml").gauges
