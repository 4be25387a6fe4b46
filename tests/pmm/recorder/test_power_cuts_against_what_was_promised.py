"""A power cut at any moment loses nothing that was promised, and alters nothing unseen."""

from pathlib import Path

import pytest

from tests.pmm.recorder.faulty_disk import Faults, FaultyDisk
from tests.pmm.recorder.power_cuts import DISKS, cut, record

# Of each disk; without checksums some alter values. python -m benchmarks.cuts makes a thousand.
CUTS = range(43, 55)


@pytest.mark.sample(1)
@pytest.mark.parametrize("number", range(len(DISKS)))
def test_a_cut_at_any_step(tmp_path: Path, number: int) -> None:
    run = record(number, tmp_path / "run")
    found = [cut(run, seed, tmp_path / str(seed)) for seed in CUTS]
    assert [wrong for _, wrong in found if wrong] == []
    assert run.closed or DISKS[number].failing


def test_an_uncut_disk_holds_what_the_folder_holds(tmp_path: Path) -> None:
    run = record(0, tmp_path / "run")
    run.disk.image(len(run.disk.steps), 1, tmp_path / "image")
    there, kept = (
        {path.name: path.read_bytes() for path in (tmp_path / place).iterdir()}
        for place in ("run", "image")
    )
    assert kept == there


def test_what_was_not_synced_is_torn(tmp_path: Path) -> None:
    import os

    disk = FaultyDisk(tmp_path / "run", Faults(), 1)
    (tmp_path / "run").mkdir()
    with disk.watched():
        handle = os.open(tmp_path / "run" / "file", os.O_WRONLY | os.O_CREAT | os.O_EXCL)
        folder = os.open(tmp_path / "run", os.O_RDONLY)
        os.write(handle, b"a" * 4096)
        os.fsync(handle)
        os.fsync(folder)
        os.write(handle, b"b" * 4096)
        for one in (handle, folder):
            os.close(one)
    found = set()
    for seed in range(20):
        disk.image(len(disk.steps), seed, tmp_path / str(seed))
        data = (tmp_path / str(seed) / "file").read_bytes()
        assert data[:4096] == b"a" * 4096
        assert set(data[4096:]) <= set(b"b\0")
        found.add(data)
    assert len(found) > 5
