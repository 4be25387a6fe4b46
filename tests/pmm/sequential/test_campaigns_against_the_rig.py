"""Campaigns that choose their runs, against the hull of the rig, its plan checks and the tank."""

import json
import tomllib
from pathlib import Path
from shutil import rmtree

import pytest
from click.testing import CliRunner

from pmm.cli import cli
from pmm.plan.checks import check_plan
from pmm.plan.duration import duration_rows
from pmm.plan.findings import PlanVerdict
from pmm.plan.plan import read_plan_and_rig
from tests.pmm.sequential.campaigns import EXAMPLE, made, until, written


def test_it_stops_when_the_targets_are_met_and_the_hull_is_found(tmp_path: Path) -> None:
    folder = tmp_path / "c"
    told = made(written(tmp_path, repeat=0.006), folder)
    assert told["ending"] == "all targets are met"
    last, before = told["decisions"][-1], told["decisions"][:-1]
    hull = tomllib.loads((EXAMPLE / "rig.toml").read_text(encoding="utf-8"))["hull"]["damping"]
    truth = {"Z_w": -hull[0][0], "M_q": -hull[1][1]}
    for one in last["known"]:
        assert one["standard_uncertainty"] <= one["wanted"]
        assert abs(one["value"] - truth[one["name"]]) < 3.0 * one["standard_uncertainty"]
    assert not any(
        all((one["standard_uncertainty"] or 1e9) <= one["wanted"] for one in row["known"])
        for row in before
        if row["known"]
    )
    assert [len(row["runs"]) for row in told["decisions"]] == list(range(len(last["runs"]) + 1))
    plan, rig = read_plan_and_rig(folder / "plan.toml")
    assert {one.verdict for one in check_plan(plan, rig)} <= {PlanVerdict.NOTE}
    assert last["time_s"] == pytest.approx(sum(duration_rows(plan.runs, rig)))
    assert plan.runs[0].name == "zero-01"
    assert plan.runs[-1].name == "zero-02"  # the closing zero was made too
    assert all((folder / run.name / "run.nc").is_file() for run in plan.runs)


def test_the_coefficients_of_the_folder_are_those_that_ended_it(tmp_path: Path) -> None:
    folder = tmp_path / "c"
    told = made(written(tmp_path), folder)
    done = CliRunner().invoke(
        cli, ["plan", "design", str(tmp_path / "design.toml"), "--after", str(folder), "--json"]
    )
    known = {one["name"]: one for one in json.loads(done.stdout)["known"]}
    for one in told["decisions"][-1]["known"]:
        assert one["value"] == pytest.approx(known[one["name"]]["value"], rel=1e-12)


def test_a_campaign_that_was_cut_short_goes_on_to_the_same_runs(tmp_path: Path) -> None:
    design, whole = written(tmp_path, repeat=0.006), tmp_path / "whole"
    runs = made(design, whole)["runs"]
    assert len(runs) >= 3
    # As a crash leaves it: a run is lost, the campaign's file is older than what is recorded.
    for lost in (whole / runs[-1], whole / "zero-02"):
        rmtree(lost)
    old = (whole / "campaign.toml").read_text(encoding="utf-8")
    (whole / "campaign.toml").write_text(old.partition("[[runs]]")[0], encoding="utf-8")
    kept = {name: (whole / name / "run.nc").read_bytes() for name in runs[:-1]}
    again = made(design, whole, "--resume")
    assert again["runs"] == runs
    assert again["ending"] == "all targets are met"
    assert kept == {name: (whole / name / "run.nc").read_bytes() for name in runs[:-1]}
    assert not list(whole.glob("*.try*"))
    assert made(design, whole, "--resume")["decisions"] == again["decisions"]


def test_nothing_is_made_that_the_operator_does_not_approve(tmp_path: Path) -> None:
    design = written(tmp_path)
    rejected = until(design, tmp_path / "c", given="perhaps\nn\n")
    assert rejected.exit_code == 0
    assert "did not approve" in rejected.stdout
    assert not list((tmp_path / "c").glob("*/header.json"))
    nobody = until(design, tmp_path / "c", given="")
    assert nobody.exit_code == 1
    assert "nobody answers: Approve of these runs?" in str(nobody.exception) + nobody.output
    assert not list((tmp_path / "c").glob("*/header.json"))
    approved = until(design, tmp_path / "c", given="y\n")
    assert approved.exit_code == 0
    assert "the operator" in approved.stdout


def test_the_time_is_kept_to_and_said(tmp_path: Path) -> None:
    design = written(tmp_path, repeat=0.02, more="[limits]\ntime_h = 0.011\n")
    told = made(design, tmp_path / "c")
    assert told["ending"] == "the time is used up"
    assert 1 < len(told["runs"]) < 5
    assert "too little for any run" in told["decisions"][-1]["remark"]


def test_what_no_run_lowers_ends_the_campaign_before_it_begins(tmp_path: Path) -> None:
    design = written(tmp_path, more="[stated]\nforce_gain_relative = 0.05\n")
    told = made(design, tmp_path / "c")
    assert told["ending"] == "nothing left would help"
    assert told["runs"] == []
    assert len(told["decisions"][-1]["notes"]) == 2
    assert all("which no run lowers" in one for one in told["decisions"][-1]["notes"])


def test_a_run_that_cannot_be_used_is_said_and_the_campaign_goes_on(tmp_path: Path) -> None:
    design, folder = written(tmp_path), tmp_path / "c"
    runs = made(design, folder)["runs"]
    (folder / runs[0] / "run.nc").write_bytes(b"nothing that could be read")
    told = made(design, folder, "--resume")
    assert told["ending"] == "all targets are met"
    assert set(runs) < set(told["runs"])
    assert any(one.startswith(f"{runs[0]} cannot be used") for one in
               told["decisions"][-1]["notes"])  # fmt: skip


@pytest.mark.parametrize(
    ("before", "words", "said"),
    [
        ((), ("--only", "heave"), "does not go with --until"),
        ((), ("--dry-run",), "does not go with --until"),
        (('"pmm-simulated"', '"socketcan"'), ("--approve", "all"), "is for the simulated rig"),
        ((), ("--approve", "none.toml"), "none.toml"),
    ],
)
def test_bad_requests_are_one_sentence_each(
    tmp_path: Path, before: tuple[str, ...], words: tuple[str, ...], said: str
) -> None:
    design = written(tmp_path)
    rig = tmp_path / "rig.toml"
    if before:
        rig.write_text(rig.read_text(encoding="utf-8").replace(*before), encoding="utf-8")
    done = until(design, tmp_path / "c", *words)
    assert done.exit_code == 2, done.output
    assert said in str(done.exception) + done.output
    assert not (tmp_path / "c" / "plan.toml").exists()


def test_a_design_without_targets_has_no_end(tmp_path: Path) -> None:
    design = written(tmp_path, more="[limits]\ntime_h = 1.0\n")
    text = design.read_text(encoding="utf-8")
    targets = '[targets]\nZ_w = "3 %"\nM_q = "3 %"\n'
    design.write_text(text.replace(targets, ""), encoding="utf-8")
    done = until(design, tmp_path / "c", "--approve", "all")
    assert done.exit_code == 2
    assert "has no [targets]" in str(done.exception) + done.output


def test_a_folder_that_holds_a_campaign_is_gone_on_from_only_on_demand(tmp_path: Path) -> None:
    design = written(tmp_path)
    made(design, tmp_path / "c")
    done = until(design, tmp_path / "c", "--approve", "all")
    assert done.exit_code == 2
    assert "--resume goes on with it" in str(done.exception) + done.output


def test_an_ended_campaign_goes_on_when_more_is_asked(tmp_path: Path) -> None:
    design, folder = written(tmp_path, repeat=0.004), tmp_path / "c"
    before = made(design, folder)
    text = design.read_text(encoding="utf-8")
    design.write_text(text.replace('Z_w = "3 %"', 'Z_w = "1.5 %"'), encoding="utf-8")
    after = made(design, folder, "--resume")
    assert after["ending"] == "all targets are met"
    assert after["runs"][: len(before["runs"])] == before["runs"]
    assert len(after["runs"]) > len(before["runs"])
    assert after["decisions"][-1]["known"][0]["wanted"] == pytest.approx(0.015 * 190.0)
    assert (folder / "zero-04" / "run.nc").is_file()  # a zero run before and after the new ones
