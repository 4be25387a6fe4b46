"""Two processes, one campaign's folder: one writes, others are told who, and a kill frees it."""

import json
import os
import signal
from pathlib import Path

import pytest

from analysis.readers import read_recording
from pmm.recorder.campaign_owner import own_campaign, writer_of
from tests.pmm.run.processes import LONG, READINGS, SHORT, pmm, recording, written_plan

LOCK = ".pmm-lock"


def _files(folder: Path) -> dict[str, bytes]:
    """All that cannot change while a run is being recorded: names, and what was written whole."""
    names = [one.relative_to(folder).as_posix() for one in folder.rglob("*") if one.is_file()]
    whole = ("header.json", "plan.toml", "rig.toml")
    return {name: (folder / name).read_bytes() if name.endswith(whole) else b"" for name in names}


@pytest.mark.slow
def test_a_campaign_being_recorded_has_one_writer_and_readers_are_told(tmp_path: Path) -> None:
    plan, folder = written_plan(tmp_path), tmp_path / "out"
    first = pmm("run", plan, "--output", folder, "--only", SHORT, given=READINGS)
    assert first.exit_code == 0, first.stderr
    with recording(plan, folder, "--resume", run=LONG) as process:
        before = _files(folder)
        for words in (("run", plan, "--output", folder, "--resume"), ("recover", folder / LONG)):
            refused = pmm(*words, given=READINGS)
            assert refused.exit_code == 1, refused.stderr
            assert f"process {process.pid}" in refused.stderr
            assert "), since 20" in refused.stderr
            assert "wait for it or stop it" in refused.stderr
        analysed = pmm("analyse", folder, "--json")
        assert analysed.exit_code == 0, analysed.stderr
        assert [one["run"] for one in json.loads(analysed.stdout)["runs"]] == [SHORT]
        assert f"is being written by process {process.pid}" in analysed.stderr
        live = pmm("replay", folder / LONG)
        assert live.exit_code == 1
        assert f"is being recorded by process {process.pid}" in live.stderr
        assert {name: _files(folder)[name] for name in before} == before
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=120)
        assert process.returncode == 130
    marker = json.loads((folder / LONG / "complete.json").read_text(encoding="utf-8"))
    assert marker["outcome"] == "stopped"
    assert read_recording(folder / LONG / "run.nc").sample_count == marker["samples"]
    assert (folder / LOCK).read_bytes() == b""  # an owner that ends leaves no name
    assert not list(folder.glob("*.try*"))


@pytest.mark.slow
def test_a_killed_owner_is_no_owner_and_its_name_in_the_lock_no_obstacle(tmp_path: Path) -> None:
    plan, folder = written_plan(tmp_path), tmp_path / "out"
    with recording(plan, folder) as process:
        process.kill()
        process.wait(timeout=120)
    left = json.loads((folder / LOCK).read_text(encoding="utf-8"))
    assert left["pid"] == process.pid
    assert writer_of(folder) is None
    words = ("run", plan, "--output", folder, "--resume", "--only", SHORT, "--json")
    resumed = pmm(*words, given=READINGS)
    assert resumed.exit_code == 0, resumed.stderr
    assert [one["outcome"] for one in json.loads(resumed.stdout)["runs"]] == ["complete"]
    recovered = pmm("recover", folder / f"{SHORT}.try1")
    assert recovered.exit_code == 0, recovered.stderr
    assert (folder / LOCK).read_bytes() == b""


@pytest.mark.parametrize("left", ["", "{", "[]", '{"pid": 1}', "\0" * 40])
def test_whatever_stands_in_a_lock_that_nobody_holds_is_no_owner(tmp_path: Path, left: str) -> None:
    (tmp_path / LOCK).write_text(left, encoding="utf-8")
    assert writer_of(tmp_path) is None
    with own_campaign(tmp_path), own_campaign(tmp_path):  # loop and recorder of one process
        assert writer_of(tmp_path) is None
        assert json.loads((tmp_path / LOCK).read_text(encoding="utf-8"))["pid"] == os.getpid()
    assert (tmp_path / LOCK).read_bytes() == b""
