"""A lost journal of samples, decoded again from the raw log, holds what the lost one held."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from analysis.readers import read_recording
from hardware.description.errors import DataError
from pmm.recorder.header import LiveSettings
from pmm.recorder.recording import read_run
from pmm.recorder.recovery import recover
from pmm.recorder.replay import replay
from pmm.recorder.run_recorder import RunEnd
from sim.devices.bench_file import DRIVERS
from tests.pmm.recorder.recorded import fed, header, session

TWO = LiveSettings(periods=2)


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run that was closed, and one of the same rig that was not."""
    place = tmp_path_factory.mktemp("runs")
    with session() as rig:
        for name in ("closed", "killed"):
            recorder, _ = rig.record(place / name, 600, TWO)
            with recorder:
                if name == "closed":
                    recorder.close(RunEnd.COMPLETE)
    return place


CHANGES = {  # of ten pulses, 1 s apart: what is left of them, how many are missing, and differ
    "whole": (lambda lines: lines, 0, 0),
    "the last, in flight": (lambda lines: lines[:-1], 0, 0),
    "the last four": (lambda lines: lines[:-4], 3, 0),  # the last of them was in flight
    "the fifth": (lambda lines: lines[:4] + lines[5:], 1, 0),
    "the first three": (lambda lines: lines[3:], 3, 0),
    "all": (lambda _: [], 9, 0),
    "an angle": (lambda lines: [*lines[:4], _turned(lines[4]), *lines[5:]], 0, 1),
    "a line twice": (lambda lines: [*lines[:5], *lines[4:]], 0, 6),
}


def _turned(line: str) -> str:
    number, time_s, _ = json.loads(line)
    return json.dumps([number, time_s, 1.0], separators=(",", ":")) + "\n"


@pytest.fixture(scope="module")
def pulsed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run of ten turns that was not closed."""
    folder = tmp_path_factory.mktemp("pulsed") / "run"
    with session() as rig:
        recorder, _ = rig.record(folder, 1000, TWO)
        with recorder:
            pass
    return folder


@pytest.mark.slow
@pytest.mark.parametrize("change", CHANGES)
def test_pulses_that_were_lost_are_named_and_come_back(
    pulsed: Path, tmp_path: Path, change: str
) -> None:
    change_lines, missing, differing = CHANGES[change]
    folder = tmp_path / "run"
    shutil.copytree(pulsed, folder)
    path = folder / "pulses.jsonl"
    lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    assert len(lines) == 10
    path.write_text("".join(change_lines(lines)), encoding="utf-8")
    again = replay(folder, DRIVERS)
    found = again.pulse_comparison
    assert (len(found.missing), found.differing) == (missing, differing)
    assert again.same is not bool(missing or differing)
    codes = [flag.code for flag in recover(folder, DRIVERS).flags]
    is_seen = bool(missing) or change == "a line twice"  # a line of text has no checksum
    assert codes == ["recovered", "pulses_rebuilt"][: 1 + is_seen]
    if is_seen:
        assert path.read_text(encoding="utf-8") == "".join(lines)
        assert (folder / "pulses.jsonl.damaged-1").exists()
        assert replay(folder, DRIVERS).same
        assert recover(folder, DRIVERS).changed == ()


@pytest.mark.slow
def test_lost_pulses_that_cannot_be_decoded_are_named(pulsed: Path, tmp_path: Path) -> None:
    folder = tmp_path / "run"
    shutil.copytree(pulsed, folder)
    (folder / "bus.blf").unlink()
    path = folder / "pulses.jsonl"
    lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    path.write_text("".join(lines[:4] + lines[5:]), encoding="utf-8")
    flag = recover(folder, DRIVERS).flags[-1]
    before, after = (json.loads(lines[k])[0] for k in (3, 5))
    assert flag.code == "pulses_lost"
    assert f"number {after} follows number {before}" in flag.message


def lost(run: Path, place: Path, *names: str) -> Path:
    """Copy a run without some of its files."""
    folder = place / run.name
    shutil.copytree(run, folder)
    for name in (*names, "run.nc"):
        (folder / name).unlink(missing_ok=True)
    return folder


def whole(run: Path) -> np.ndarray:
    samples = read_run(run).samples
    return samples[:, 0 : samples.sample_count]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["closed", "killed"])
def test_samples_come_back_bit_by_bit(runs: Path, tmp_path: Path, name: str) -> None:
    folder = lost(runs / name, tmp_path, "samples.arrows")
    found = recover(folder, DRIVERS)
    recorded = read_recording(found.path)
    truth = whole(runs / name)
    assert np.array_equal(recorded.samples[:, 0 : recorded.sample_count], truth)
    assert recorded.start_s == read_run(runs / name).samples.first_sync / 100.0
    assert recorded.photocell_edges_s.tolist() == read_run(runs / name).pulses_s.tolist()
    codes = [one.code for one in recorded.flags]
    assert codes[-1] == "samples_rebuilt"
    assert codes[0] == ("recovered" if name == "killed" else "journal_changed")
    assert np.array_equal(whole(folder), truth), "the journal is there again"
    assert replay(folder, DRIVERS).same


@pytest.mark.slow
def test_doing_it_again_changes_nothing(runs: Path, tmp_path: Path) -> None:
    folder = lost(runs / "closed", tmp_path, "samples.arrows")
    found = recover(folder, DRIVERS)
    before = {one.name: one.read_bytes() for one in folder.iterdir()}
    again = recover(folder, DRIVERS)
    assert (again.samples, again.flags) == (found.samples, found.flags)
    assert {one.name: one.read_bytes() for one in folder.iterdir()} == before


@pytest.mark.slow
def test_pulses_that_are_lost_too_come_back(runs: Path, tmp_path: Path) -> None:
    folder = lost(runs / "closed", tmp_path, "samples.arrows", "pulses.jsonl")
    recover(folder, DRIVERS)
    told = (runs / "closed" / "pulses.jsonl").read_text().splitlines()
    again = (folder / "pulses.jsonl").read_text().splitlines()
    assert [json.loads(one) for one in again] == [json.loads(one) for one in told]
    assert len(told) == 6


@pytest.mark.slow
@pytest.mark.parametrize("torn", [b"", b"ARROW? no"])
def test_what_cannot_be_read_keeps_its_bytes(runs: Path, tmp_path: Path, torn: bytes) -> None:
    folder = lost(runs / "killed", tmp_path)
    (folder / "samples.arrows").write_bytes(torn)
    assert recover(folder, DRIVERS).samples == whole(runs / "killed").shape[1]
    assert (folder / "samples.arrows.damaged-1").read_bytes() == torn


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.2, 0.5, 0.8, 0.95])
def test_a_log_that_is_cut_as_well_gives_a_beginning(
    runs: Path, tmp_path: Path, share: float
) -> None:
    folder = lost(runs / "killed", tmp_path, "samples.arrows")
    size = (folder / "bus.blf").stat().st_size
    with (folder / "bus.blf").open("rb+") as file:
        file.truncate(round(share * size))
    found = recover(folder, DRIVERS)
    recorded = read_recording(found.path)
    truth = whole(runs / "killed")
    values = recorded.samples[:, 0 : recorded.sample_count]
    assert np.array_equal(values, truth[:, : values.shape[1]])
    assert values.shape[1] > (share - 0.25) * truth.shape[1]


@pytest.mark.slow
def test_a_rig_whose_photocell_is_on_a_serial_line(tmp_path: Path) -> None:
    with session(serial=("photocell",), photocell={"driver": "timestamper"}) as rig:
        for _ in range(500):  # marks, so that the clock's fit is worth carrying over
            rig.rig.cycle()
        recorder, _ = rig.record(tmp_path / "run", 300, TWO)
        with recorder:
            recorder.close(RunEnd.COMPLETE)
    folder = lost(tmp_path / "run", tmp_path / "lost", "samples.arrows", "pulses.jsonl")
    recover(folder, DRIVERS)
    assert np.array_equal(whole(folder), whole(tmp_path / "run"))
    again, told = read_run(folder).pulses_s, read_run(tmp_path / "run").pulses_s
    assert again[: told.size].tolist() == told.tolist()
    assert told.size >= 3


@pytest.mark.slow
def test_without_a_log_or_a_rig_nothing_is_touched(runs: Path, tmp_path: Path) -> None:
    folder = lost(runs / "killed", tmp_path, "samples.arrows", "bus.blf")
    before = sorted(one.name for one in folder.iterdir())
    with pytest.raises(DataError, match=r"none can be decoded: .*bus.blf is missing"):
        recover(folder, DRIVERS)
    (folder / "bus.blf").write_bytes(b"")
    with pytest.raises(DataError, match=r"neither do bus.blf and lines.jsonl"):
        recover(folder, DRIVERS)
    assert sorted(one.name for one in folder.iterdir()) == sorted([*before, "bus.blf"])


def test_a_header_that_knows_no_rig_is_named(tmp_path: Path) -> None:
    from pmm.recorder.run_recorder import RunRecorder

    with RunRecorder(tmp_path / "run", header()) as recorder:
        fed(recorder, range(1, 101))
    (tmp_path / "run" / "samples.arrows").unlink()
    with pytest.raises(DataError, match="does not say what the rig was"):
        recover(tmp_path / "run")
