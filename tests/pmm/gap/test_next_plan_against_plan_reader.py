"""Proposed runs as a plan: what ``pmm plan`` reads from it is what was proposed."""

import math
from pathlib import Path
from shutil import copy

import pytest
from click.testing import CliRunner

from analysis.gap.design.proposals import Proposal
from hardware.description.kinds import RunKind
from hardware.description.setpoint import Medium, SetPoint
from pmm.cli import cli
from pmm.gap.next_plan import plan_text
from pmm.plan.plan import read_plan
from tests.pmm.plan.plans import EXAMPLES

POINTS = (
    SetPoint(0.5, 0.02, 0.0, 1.2),
    SetPoint(0.5, 0.02, math.pi / 2.0, 0.0),
    SetPoint(0.8, 0.012, math.pi, 0.0, Medium.AIR),
)


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    ran = [Proposal("oscillation", one, 0.0, 5.0) for one in POINTS]
    special = [
        Proposal(kind, None, 50.0, 3.0, strut=strut)
        for kind, strut in (("rest", ""), ("check-weight", "fore"), ("injection", ""))
    ]
    copy(EXAMPLES / "vertical" / "rig.toml", tmp_path)
    copy(EXAMPLES / "vertical" / "simulated.toml", tmp_path)
    path = tmp_path / "plan.toml"
    path.write_text(plan_text("next", [*ran, *special]), encoding="utf-8")
    return path


def test_every_run_is_as_it_was_proposed(plan: Path) -> None:
    runs = [one for one in read_plan(plan).runs if one.name.startswith("next-")]
    turning = [one for one in runs if one.kind.oscillates]
    assert [one.set_point for one in turning] == [*POINTS]
    assert [one.kind for one in turning] == [RunKind.OSCILLATION] * 2 + [RunKind.DRY]
    assert {one.kind for one in runs} >= {RunKind.ZERO, RunKind.CHECK_WEIGHT}
    loads = [one.load for one in runs if one.load is not None]
    assert {one.force_n for one in loads} == {0.0, 25.0, 50.0}
    assert {one.channel for one in loads} == {"force_fore"}


def test_what_no_plan_can_do_is_said(plan: Path) -> None:
    said = plan.read_text(encoding="utf-8")
    assert "# by hand: a sine of 50 N at 10 Hz into all force amplifiers" in said


def test_a_dead_weight_is_asked_for(tmp_path: Path) -> None:
    copy(EXAMPLES / "vertical" / "rig.toml", tmp_path)
    path = tmp_path / "plan.toml"
    proposed = [Proposal("oscillation", POINTS[1], 50.0, 5.0)]
    path.write_text(plan_text("next", proposed), encoding="utf-8")
    said = "Put a dead weight of 50 N on the model (on a cord where it moves sideways)"
    assert said in {prompt for one in read_plan(path).runs for prompt in one.prompts}


def test_the_rig_can_run_it(plan: Path) -> None:
    found = CliRunner().invoke(cli, ["plan", "check", str(plan)], catch_exceptions=False)
    assert found.exit_code == 0, found.output
    assert "the rig can run it" in found.output
