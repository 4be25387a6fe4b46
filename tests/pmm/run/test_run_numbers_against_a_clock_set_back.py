"""Runs in the order in which they were made, told by their numbers while the clock goes back."""

import json
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from pmm.evaluation.run_results import read_results
from pmm.plan.plan import read_plan_and_rig
from pmm.recorder.campaign_owner import own_campaign
from pmm.run.campaign_folder import finished_runs
from tests.pmm.run.harness import bench, oscillation
from tests.sim.devices.benches import ROOT

NOON = datetime(2026, 10, 25, 12, 0, tzinfo=UTC)


def _made(folder: Path, name: str, started: datetime) -> None:
    """Make a run, its controller's clock at a time."""
    runs = [oscillation(name, 2.0, periods=2, max_periods=2)]
    with bench(folder, runs, utc=lambda: started.isoformat()) as one:
        one.finish()


def _header(folder: Path, name: str) -> dict:
    return json.loads((folder / name / "header.json").read_text(encoding="utf-8"))


@pytest.mark.slow
def test_a_clock_that_is_set_back_changes_no_order(tmp_path: Path) -> None:
    names = ["first", "second", "third"]
    for hours, name in enumerate(names):
        _made(tmp_path, name, NOON - timedelta(hours=hours))
    assert [_header(tmp_path, name)["number"] for name in names] == [1, 2, 3]
    assert [one.name for one in read_results(tmp_path)] == names
    now = read_plan_and_rig(ROOT / "examples" / "vertical" / "plan.toml")
    found = finished_runs(tmp_path, *now)
    assert [(one.number, one.plan.name) for one in found] == list(enumerate(names, 1))


@pytest.mark.slow
def test_runs_without_numbers_are_ordered_by_clock_before_those_that_have_one(
    tmp_path: Path,
) -> None:
    for name, hours in (("late", 2), ("early", 1)):
        _made(tmp_path, name, NOON + timedelta(hours=hours))
        header = _header(tmp_path, name)
        del header["number"]  # as a campaign of before has it
        (tmp_path / name / "header.json").write_text(json.dumps(header), encoding="utf-8")
    _made(tmp_path, "new", NOON)
    assert _header(tmp_path, "new")["number"] == 3
    assert [one.name for one in read_results(tmp_path)] == ["early", "late", "new"]


def test_no_number_is_given_twice_after_a_try_that_was_moved_aside(tmp_path: Path) -> None:
    _made(tmp_path, "run", NOON)
    (tmp_path / "run").rename(tmp_path / "run.try1")
    (tmp_path / "damaged").mkdir()
    (tmp_path / "damaged" / "header.json").write_text("{", encoding="utf-8")
    with own_campaign(tmp_path) as owned:
        assert owned.count() == 2  # two runs lie there, whatever can be read of them
    _made(tmp_path, "run", NOON)
    assert _header(tmp_path, "run")["number"] == 3
