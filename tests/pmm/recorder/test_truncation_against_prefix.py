"""Whatever is cut off a run's files: what is recovered is the beginning of the truth."""

import hashlib
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from analysis.readers import read_recording
from hardware.description.errors import DataError
from pmm.recorder.files import STREAMS
from pmm.recorder.recording import read_run
from pmm.recorder.recovery import recover
from pmm.recorder.run_recorder import RunEnd, RunRecorder
from tests.pmm.recorder.recorded import fed, header, truth


@pytest.fixture(scope="module")
def left(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A run of 400 samples in eight batches that was not closed."""
    folder = tmp_path_factory.mktemp("left") / "run"
    with RunRecorder(folder, header()) as recorder:
        fed(recorder, range(1, 401), tick_s=0.011)
    return folder


def copied(left: Path, place: str) -> Path:
    folder = Path(place) / "run"
    shutil.copytree(left, folder)
    return folder


def hashes(folder: Path) -> dict[str, str]:
    names = [one for one in (*STREAMS, "header.json") if (folder / one).exists()]
    return {name: hashlib.sha256((folder / name).read_bytes()).hexdigest() for name in names}


def check(folder: Path) -> int:
    """Recover twice; return how many samples came out, all of them true."""
    before = hashes(folder)
    try:
        found = recover(folder)
    except DataError as error:
        _said_where(error, folder)
        assert hashes(folder) == before
        assert not (folder / "run.nc").exists()
        return 0
    recording = read_recording(found.path)
    values = recording.samples[:, 0 : recording.sample_count]
    assert np.array_equal(values, truth(range(1, recording.sample_count + 1)))
    edges = recording.photocell_edges_s.tolist()
    assert edges == [number + 1 + 0.0123 for number in range(len(edges))]
    codes = [one.code for one in recording.flags]
    assert codes in (["recovered"], ["recovered", "journal_changed"])  # a header that was cut
    stamp = found.path.stat().st_mtime_ns
    again = recover(folder)
    assert (again.samples, again.flags) == (found.samples, found.flags)
    assert found.path.stat().st_mtime_ns == stamp, "a second recovery wrote again"
    assert hashes(folder) == before, "a raw file was changed"
    return recording.sample_count


def _said_where(error: DataError, folder: Path) -> None:
    assert str(folder) in str(error)


@pytest.mark.slow
@given(share=st.floats(0.0, 1.0))
def test_samples_cut_anywhere(left: Path, share: float) -> None:
    with tempfile.TemporaryDirectory() as place:
        folder = copied(left, place)
        data = (folder / "samples.arrows").read_bytes()
        (folder / "samples.arrows").write_bytes(data[: round(share * len(data))])
        found = check(folder)
        # Whole batches come out: all that end before the cut.
        assert found == 400 if share == 1.0 else found <= 400
        assert found >= (share - 0.35) * 400


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(data=st.data())
def test_every_file_cut_anywhere(left: Path, data: st.DataObject) -> None:
    with tempfile.TemporaryDirectory() as place:
        folder = copied(left, place)
        for name in (*STREAMS, "header.json"):
            size = (folder / name).stat().st_size
            keep = data.draw(st.one_of(st.just(size), st.integers(0, size)), label=name)
            with (folder / name).open("rb+") as file:
                file.truncate(keep)
        check(folder)


@pytest.mark.slow
@settings(max_examples=20, deadline=None)
@given(junk=st.binary(max_size=300), name=st.sampled_from(STREAMS))
def test_junk_behind_what_is_whole(left: Path, junk: bytes, name: str) -> None:
    """A disk that loses its power may leave zeros or anything in the last block."""
    with tempfile.TemporaryDirectory() as place:
        folder = copied(left, place)
        with (folder / name).open("ab") as file:
            file.write(junk + bytes(64))
        if name in ("samples.arrows", "bus.blf"):
            assert check(folder) == 400
        else:
            # A number may be whole JSON by itself; it stands behind all that is true.
            assert read_run(folder).samples.sample_count == 400


@pytest.mark.parametrize("name", [*STREAMS, "header.json"])
@pytest.mark.parametrize("how", ["removed", "emptied"])
def test_one_file_gone(left: Path, tmp_path: Path, name: str, how: str) -> None:
    folder = copied(left, str(tmp_path))
    if how == "removed":
        (folder / name).unlink()
    else:
        (folder / name).write_bytes(b"")
    assert check(folder) == (0 if name == "samples.arrows" else 400)


def test_a_killed_conversion_is_done_again(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    with RunRecorder(folder, header()) as recorder:
        fed(recorder, range(1, 401))
        path = recorder.close(RunEnd.COMPLETE)
    path.rename(folder / ".run.nc.4711.part")
    with (folder / ".run.nc.4711.part").open("rb+") as file:
        file.truncate(1000)
    found = recover(folder)
    assert (found.samples, found.flags) == (400, ())
    assert not list(folder.glob(".run.nc*"))
    assert recover(folder).was_whole


def test_a_recording_that_cannot_be_read_is_set_aside(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    with RunRecorder(folder, header()) as recorder:
        fed(recorder, range(1, 401))
        recorder.close(RunEnd.COMPLETE)
    (folder / "run.nc").write_bytes(b"half a page")
    assert recover(folder).samples == 400
    assert (folder / "run.nc.damaged-1").read_bytes() == b"half a page"
    assert read_recording(folder / "run.nc").sample_count == 400


def test_a_closed_run_that_was_cut_later_says_so(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    with RunRecorder(folder, header()) as recorder:
        fed(recorder, range(1, 401), tick_s=0.011)
        recorder.close(RunEnd.COMPLETE)
    (folder / "run.nc").unlink()
    size = (folder / "samples.arrows").stat().st_size
    with (folder / "samples.arrows").open("rb+") as file:
        file.truncate(size - 10)
    found = recover(folder)
    assert found.samples < 400
    flag, lost = found.flags
    assert (flag.code, lost.code) == ("journal_changed", "samples_lost")
    assert f"{size - 10} of {size} bytes" in flag.message
    assert found.changed == ("samples.arrows",)
