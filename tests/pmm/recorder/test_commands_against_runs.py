"""``pmm recover`` and ``pmm replay`` say what the functions find, by status, table and JSON."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from pmm.cli import cli
from pmm.recorder.header import LiveSettings
from pmm.recorder.run_recorder import RunEnd, RunRecorder
from tests.pmm.recorder.recorded import fed, header, session


def pmm(*words: str | Path) -> Result:
    return CliRunner().invoke(cli, [str(one) for one in words])


def test_a_campaign_is_recovered_run_by_run(tmp_path: Path) -> None:
    with RunRecorder(tmp_path / "a closed", header()) as recorder:
        fed(recorder, range(1, 101))
        recorder.close(RunEnd.COMPLETE)
    with RunRecorder(tmp_path / "b killed", header()) as recorder:
        fed(recorder, range(1, 101))
    said = pmm("recover", tmp_path, "--json")
    assert said.exit_code == 0
    closed, killed = json.loads(said.stdout)
    assert (closed["was_whole"], killed["was_whole"]) == (True, False)
    assert [one["samples"] for one in (closed, killed)] == [100, 100]
    assert Path(killed["path"]).exists()
    table = pmm("recover", tmp_path)
    assert "nothing: it was closed" in table.stdout
    assert "run.nc is there" in table.stdout
    assert "[recovered]" in table.stdout


def _opened_and_fed(folder: Path) -> None:
    for name in ("a", "b"):
        with RunRecorder(folder / name, header()) as recorder:
            if name == "b":
                fed(recorder, range(1, 51))


@pytest.mark.parametrize("cut_bytes", [0, 7, None])
def test_a_recorder_that_was_just_opened_has_lost_nothing(
    tmp_path: Path, cut_bytes: int | None
) -> None:
    _opened_and_fed(tmp_path)
    for name in ("samples.arrows", "bus.blf"):  # the program may end while they are begun
        path = tmp_path / "a" / name
        path.write_bytes(path.read_bytes()[:cut_bytes])
    said = pmm("recover", tmp_path)
    assert said.exit_code == 0, said.output
    assert "nothing: the program ended before anything was written" in said.stdout
    assert (tmp_path / "b" / "run.nc").exists()
    assert not (tmp_path / "a" / "run.nc").exists()
    empty, _ = json.loads(pmm("recover", tmp_path, "--json").stdout)
    assert "nothing to recover" in empty["nothing_written"]


def test_a_run_whose_samples_are_lost_fails_and_the_others_do_not(tmp_path: Path) -> None:
    _opened_and_fed(tmp_path)
    (tmp_path / "a" / "pulses.jsonl").write_text("[1,7.5,null]\n")
    said = pmm("recover", tmp_path)
    assert said.exit_code == 1
    assert "a: holds no whole sample" in said.stderr.replace("\n", "")
    assert (tmp_path / "b" / "run.nc").exists()


@pytest.mark.parametrize("command", ["recover", "replay"])
def test_a_folder_that_is_not_there_is_wrong_usage(tmp_path: Path, command: str) -> None:
    said = pmm(command, tmp_path / "nowhere")
    assert said.exit_code == 2
    assert "no such folder" in said.stderr


@pytest.mark.slow
def test_replay_prints_both_and_their_difference(tmp_path: Path) -> None:
    with session() as rig:
        recorder, _ = rig.record(tmp_path / "run", 400, LiveSettings(periods=2))
        with recorder:
            recorder.close(RunEnd.COMPLETE)
    said = pmm("replay", tmp_path / "run")
    assert said.exit_code == 0, said.output
    assert said.stdout.split()[:5] == ["samples", "400,", "0", "values", "differ"]
    assert "force_fore" in said.stdout
    document = json.loads(pmm("replay", tmp_path / "run", "--json").stdout)
    assert document["same"] is True
    assert document["readings"] == document["recorded_readings"]
    (tmp_path / "run" / "pulses.jsonl").write_text("[1,7.5,null]\n")
    assert pmm("replay", tmp_path / "run").exit_code == 1
