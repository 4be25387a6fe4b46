"""Campaigns that choose their runs, against the hull of the rig, its plan checks and the tank."""

import json
import tomllib
from pathlib import Path
from shutil import copytree, rmtree
from typing import Any

import pytest
from click.testing import CliRunner

from pmm.cli import cli
from pmm.plan.checks import check_plan
from pmm.plan.duration import duration_rows
from pmm.plan.findings import PlanVerdict
from pmm.plan.plan import read_plan_and_rig
from pmm.sequential.look import read_decisions
from tests.pmm.sequential.campaigns import EXAMPLE, made, until, written


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Any]:
    """A campaign that has ended, in ``c`` beside its design, and what it told."""
    place = tmp_path_factory.mktemp("whole")
    return place, made(written(place, repeat=0.004), place / "c")


@pytest.fixture
def copied(whole: tuple[Path, Any], tmp_path: Path) -> Path:
    """That campaign, to be changed."""
    copytree(whole[0], tmp_path, dirs_exist_ok=True)
    return tmp_path


@pytest.mark.slow
def test_it_stops_when_the_targets_are_met_and_the_hull_is_found(whole: tuple[Path, Any]) -> None:
    folder, told = whole[0] / "c", whole[1]
    assert told["ending"] == "all targets are met"
    last, before = told["decisions"][-1], told["decisions"][:-1]
    hull = tomllib.loads((EXAMPLE / "rig.toml").read_text(encoding="utf-8"))["hull"]["damping"]
    truth = {"Z_w": -hull[0][0], "M_q": -hull[1][1]}
    for one in last["known"]:
        assert one["standard_uncertainty"] <= one["wanted"]
        assert abs(one["value"] - truth[one["name"]]) < 3.0 * one["standard_uncertainty"]
    for row in before:  # not one run too many
        met = [(one["standard_uncertainty"] or 1e9) <= one["wanted"] for one in row["known"]]
        assert not (met and all(met))
    assert [len(row["runs"]) for row in told["decisions"]] == list(range(len(last["runs"]) + 1))
    plan, rig = read_plan_and_rig(folder / "plan.toml")
    assert {one.verdict for one in check_plan(plan, rig)} <= {PlanVerdict.NOTE}
    assert last["time_s"] == pytest.approx(sum(duration_rows(plan.runs, rig)))
    assert [plan.runs[0].name, plan.runs[-1].name] == ["zero-01", "zero-02"]
    assert all((folder / run.name / "run.nc").is_file() for run in plan.runs)


@pytest.mark.slow
def test_the_coefficients_of_the_folder_are_those_that_ended_it(whole: tuple[Path, Any]) -> None:
    place, told = whole
    words = ["plan", "design", str(place / "design.toml"), "--after", str(place / "c"), "--json"]
    done = CliRunner().invoke(cli, words)
    known = {one["name"]: one for one in json.loads(done.stdout)["known"]}
    for one in told["decisions"][-1]["known"]:
        assert one["value"] == pytest.approx(known[one["name"]]["value"], rel=1e-12)


@pytest.mark.slow
def test_the_report_tells_what_was_known_after_each_run(whole: tuple[Path, Any]) -> None:
    place, told = whole
    page = place / "page.html"
    done = CliRunner().invoke(cli, ["report", str(place / "c"), "--output", str(page)])
    assert done.exit_code == 0, f"{done.output}{done.exception}"
    text = page.read_text(encoding="utf-8")
    assert "Run after run" in text
    assert all(name in text for name in told["runs"])
    assert "standard uncertainty over what is asked for" in text  # the figure's axis


@pytest.mark.slow
def test_a_campaign_that_was_cut_short_goes_on_to_the_same_runs(
    whole: tuple[Path, Any], copied: Path
) -> None:
    design, folder, runs = copied / "design.toml", copied / "c", whole[1]["runs"]
    # As a crash leaves it: a run is lost, the campaign's file is older than what is recorded.
    for lost in (folder / runs[-1], folder / "zero-02"):
        rmtree(lost)
    old = (folder / "campaign.toml").read_text(encoding="utf-8")
    (folder / "campaign.toml").write_text(old.partition("[[runs]]")[0], encoding="utf-8")
    kept = {name: (folder / name / "run.nc").read_bytes() for name in runs[:-1]}
    again = made(design, folder, "--resume")
    assert again["runs"] == runs
    assert again["ending"] == "all targets are met"
    assert kept == {name: (folder / name / "run.nc").read_bytes() for name in runs[:-1]}
    assert not list(folder.glob("*.try*"))
    assert made(design, folder, "--resume")["decisions"] == again["decisions"]


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


def test_answers_that_end_stop_the_campaign_at_rest(tmp_path: Path) -> None:
    done = until(written(tmp_path), tmp_path / "c", given="y 1\n")
    assert done.exit_code == 1
    assert "nobody answers" in str(done.exception) + done.output
    assert "1 run, " in done.output
    last = read_decisions(tmp_path / "c")[-1]
    assert [(tmp_path / "c" / name / "run.nc").is_file() for name in last.runs] == [True]
    assert not last.is_decided


@pytest.mark.slow
def test_a_target_of_a_band_is_met_at_each_of_its_frequencies(tmp_path: Path) -> None:
    design = written(tmp_path)
    text = design.read_text().replace("frequencies_hz = 1.0", "frequencies_hz = [0.8, 1.0]")
    head = text.partition("[targets]")[0]
    design.write_text(f'{head}[targets]\n"Z_w at 0.7 to 1.1 Hz" = "3 %"\n')
    told = made(design, tmp_path / "c")
    assert told["ending"] == "all targets are met"
    known = told["decisions"][-1]["known"]
    assert sorted(one["name"] for one in known) == ["Z_w at 0.8 Hz, 0 m/s", "Z_w at 1 Hz, 0 m/s"]
    assert all(one["standard_uncertainty"] <= one["wanted"] for one in known)


@pytest.mark.slow
def test_the_time_is_kept_to_and_said(tmp_path: Path) -> None:
    design = written(tmp_path, repeat=0.02, more="[limits]\ntime_h = 0.011\n")
    told = made(design, tmp_path / "c")
    assert told["ending"] == "the time is used up"
    assert 1 < len(told["runs"]) < 5
    assert "too little for any run" in told["decisions"][-1]["remark"]


@pytest.mark.slow
def test_what_no_run_lowers_ends_the_campaign_before_it_begins(tmp_path: Path) -> None:
    design = written(tmp_path, more="[stated]\nforce_gain_relative = 0.05\n")
    told = made(design, tmp_path / "c")
    assert told["ending"] == "nothing left would help"
    assert told["runs"] == []
    assert len(told["decisions"][-1]["notes"]) == 2
    assert all("which no run lowers" in one for one in told["decisions"][-1]["notes"])


@pytest.mark.slow
def test_one_target_beyond_all_runs_leaves_the_others(tmp_path: Path) -> None:
    design = written(tmp_path, more="Z_wdot = 0.2\n[stated]\nmass_kg = 0.5\n")
    told = made(design, tmp_path / "c")
    assert told["ending"] == "nothing left would help"
    last = told["decisions"][-1]
    assert last["remark"] == "all other targets are met"
    assert [one["standard_uncertainty"] <= one["wanted"] for one in last["known"]] == [
        one["name"] != "Z_wdot" for one in last["known"]
    ]
    assert sum(bool(one["added"]) for one in told["decisions"]) == 1


@pytest.mark.slow
def test_a_run_that_cannot_be_used_is_said_and_the_campaign_goes_on(
    whole: tuple[Path, Any], copied: Path
) -> None:
    runs = whole[1]["runs"]
    (copied / "c" / runs[0] / "run.nc").write_bytes(b"nothing that could be read")
    told = made(copied / "design.toml", copied / "c", "--resume")
    assert told["ending"] == "all targets are met"
    assert set(runs) < set(told["runs"])
    notes = told["decisions"][-1]["notes"]
    assert any(one.startswith(f"{runs[0]} cannot be used") for one in notes)


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


@pytest.mark.slow
def test_a_folder_that_holds_a_campaign_is_gone_on_from_only_on_demand(
    whole: tuple[Path, Any],
) -> None:
    done = until(whole[0] / "design.toml", whole[0] / "c", "--approve", "all")
    assert done.exit_code == 2
    assert "--resume goes on with it" in str(done.exception) + done.output


@pytest.mark.slow
def test_an_ended_campaign_goes_on_when_more_is_asked(
    whole: tuple[Path, Any], copied: Path
) -> None:
    design, folder = copied / "design.toml", copied / "c"
    text = design.read_text(encoding="utf-8")
    design.write_text(text.replace('Z_w = "3 %"', 'Z_w = "2.2 %"'), encoding="utf-8")
    before, after = whole[1]["runs"], made(design, folder, "--resume")
    assert after["ending"] == "all targets are met"
    assert after["runs"][: len(before)] == before
    assert len(after["runs"]) > len(before)
    assert (folder / "zero-04" / "run.nc").is_file()  # a zero run before and after the new ones


@pytest.mark.slow
def test_a_run_that_fails_stops_the_campaign_at_rest_and_others_take_its_place(
    tmp_path: Path,
) -> None:
    design, folder = written(tmp_path), tmp_path / "c"
    hull = "added_mass = [[75.0, 3.0], [3.0, 22.0]]\ndamping = [[900.0, 12.0], [12.0, 55.0]]\n"
    _append(tmp_path / "simulated.toml", f"\n[hull]\n{hull}")  # the tank knows it better
    for strut in ("aft", "fore"):
        gauge = f'channel = "force_{strut}"\nfull_scale_n = 40.0\n'
        _append(tmp_path / "rig.toml", f"\n[[gauges]]\n{gauge}")
    text = design.read_text(encoding="utf-8")
    design.write_text(text.replace("[10.0, 20.0]", "[20.0]"), encoding="utf-8")
    failed = until(design, folder, given="y\n")
    assert failed.exit_code == 1
    said = str(failed.exception) + failed.output
    assert "the fault is latched" in said
    assert "--until targets --resume" in said
    design.write_text(text.replace("[10.0, 20.0]", "[5.0]"), encoding="utf-8")
    told = made(design, folder, "--resume")
    assert told["ending"] == "all targets are met"
    assert all("-a5" in name for name in told["runs"])
    assert told["decisions"][0]["approved"] == "all, beforehand"


def _append(path: Path, text: str) -> None:
    path.write_text(path.read_text(encoding="utf-8") + text, encoding="utf-8")
