"""A full disk is noticed before a run and in it; what was flushed before can be read."""

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from analysis.readers import read_recording
from hardware.errors import Reaction
from pmm.recorder.disk import DiskFullError, DiskWatch, bytes_per_s, free_bytes
from pmm.recorder.recovery import recover
from pmm.recorder.run_recorder import RunEnd, RunRecorder
from tests.pmm.recorder.recorded import fed, header, truth, until_full
from tests.sim.devices.benches import ROOT

FILLING = """
import json, resource, sys
from pathlib import Path
from pmm.recorder.run_recorder import RunRecorder
from tests.pmm.recorder.recorded import header, until_full
resource.setrlimit(resource.RLIMIT_FSIZE, (200_000, 200_000))
with RunRecorder(Path(sys.argv[1]), header()) as recorder:
    first, error = until_full(recorder)
print(json.dumps([first, str(error), error.reaction.name]))
"""


def test_a_run_that_does_not_fit_is_refused_before(tmp_path: Path) -> None:
    watch = DiskWatch(tmp_path, 2e6, reserve_bytes=50e6, free=lambda _: 100_000_000)
    watch.check_before(25.0)
    with pytest.raises(DiskFullError, match=r"26 s needs 102\.0 MB .*100\.0 MB are free") as caught:
        watch.check_before(26.0)
    assert caught.value.reaction is Reaction.PROFILE_STOP


def test_the_estimate_covers_what_a_run_takes(tmp_path: Path) -> None:
    """16 channels at 10 kHz for a second: journal and NetCDF on the disk."""
    wide = header(channels=tuple(header().channels[1].__class__(f"c{i}", "N") for i in range(16)),
                  sample_rate_hz=10_000.0)  # fmt: skip
    with RunRecorder(tmp_path, wide) as recorder:
        values = np.random.default_rng(1).normal(size=(16, 100))
        for first in range(1, 10_001, 100):
            recorder.samples(first, values)
            recorder.tick(first / 1e4)
        recorder.close(RunEnd.COMPLETE)
    taken = sum(one.stat().st_size for one in tmp_path.iterdir())
    assert taken == pytest.approx(bytes_per_s(16, 1e4), rel=0.05)


def test_a_disk_that_fills_stops_the_run_while_the_recording_still_fits(tmp_path: Path) -> None:
    free = 300_000
    watch = DiskWatch(tmp_path, 1e5, reserve_bytes=250_000, free=lambda _: free)
    with RunRecorder(tmp_path / "run", header(), disk=watch) as recorder:
        fed(recorder, range(1, 101))
        free = 249_000
        _, error = until_full(recorder, 101)
        assert re.search(r"0\.2 MB are free.*What was recorded is kept", str(error))
        path = recorder.close(RunEnd.FAULT)
    found = read_recording(path)
    assert found.sample_count >= 100
    assert np.array_equal(
        found.samples[:, 0 : found.sample_count], truth(range(1, found.sample_count + 1))
    )


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="RLIMIT_FSIZE is POSIX's")
def test_files_that_may_not_grow_keep_what_they_have(tmp_path: Path) -> None:
    command = [sys.executable, "-c", FILLING, str(tmp_path / "run")]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    first, message, reaction = json.loads(done.stdout)
    assert reaction == "PROFILE_STOP"
    assert "what was written before is kept" in message
    assert f"pmm recover {tmp_path / 'run'}" in message
    _beginning(tmp_path / "run", at_most=first)


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A disk of 1 MB."""
    place = tmp_path / "disk"
    place.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=1m", "tmpfs", str(place)]
    if sys.platform != "linux" or os.geteuid() or subprocess.run(mount, check=False).returncode:
        pytest.skip("no tmpfs can be mounted here")
    try:
        yield place
    finally:
        subprocess.run(["umount", str(place)], check=True)  # noqa: S607


@pytest.mark.slow
def test_a_full_disk_keeps_what_was_flushed(small_disk: Path, tmp_path: Path) -> None:
    assert free_bytes(small_disk / "not" / "there" / "yet") <= 2**20
    folder = small_disk / "run"
    with RunRecorder(folder, header()) as recorder:
        first, _ = until_full(recorder)
        with pytest.raises(DiskFullError, match="what was written before is kept"):
            recorder.close(RunEnd.FAULT)
    assert not (folder / "run.nc").exists()
    with pytest.raises(DiskFullError, match=r"Make room, then: pmm recover"):
        recover(folder)
    whole = tmp_path / "moved"
    shutil.copytree(folder, whole)
    _beginning(whole, at_most=first)


def _beginning(folder: Path, at_most: int) -> None:
    """Recover; what comes out is the truth's beginning, short of the end by a flush at most."""
    recording = read_recording(recover(folder).path)
    count = recording.sample_count
    assert at_most - 200 <= count <= at_most + 100
    assert np.array_equal(recording.samples[:, 0:count], truth(range(1, count + 1)))
