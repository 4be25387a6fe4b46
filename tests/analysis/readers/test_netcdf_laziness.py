"""A stored recording stays on disk until a stretch is asked for, and leaves no file open."""

import tracemalloc
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.readers import read_recording, write_recording
from analysis.recording import Recording
from hardware.description.channels import Channel

COUNT = 1_000_000  # 8 MB a channel


@pytest.fixture(scope="module")
def samples() -> np.ndarray:
    return np.random.default_rng(1).standard_normal((4, COUNT))


@pytest.fixture(scope="module")
def stored(tmp_path_factory: pytest.TempPathFactory, samples: np.ndarray) -> Recording:
    channels = tuple(Channel(f"c{n}", "N") for n in range(4))
    recording = Recording("long", channels, samples, sample_rate_hz=10_000.0)
    return read_recording(write_recording(recording, tmp_path_factory.mktemp("lazy") / "long.nc"))


def peak_of(action: Callable[[], object]) -> int:
    tracemalloc.start()
    try:
        action()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_slicing_takes_the_memory_of_the_slice(stored: Recording) -> None:
    assert peak_of(lambda: stored.samples[:, 500_000:510_000]) < 1_000_000


@pytest.mark.slow
def test_opening_and_selecting_read_no_samples(stored: Recording) -> None:
    path = getattr(stored.samples, "path", None)
    assert isinstance(path, Path)
    # The whole is 32 MB; the time stamps are checked by blocks of an eighth of a million.
    assert peak_of(lambda: read_recording(path).select(["c2", "c1"])) < 20_000_000
    chosen = read_recording(path).select(["c2", "c1"])
    assert peak_of(lambda: chosen.samples[:, 10:1000]) < 1_000_000
    assert np.array_equal(chosen.samples[:, 10:20], stored.samples[[2, 1], 10:20])


@pytest.mark.slow
def test_copying_goes_by_blocks(stored: Recording, tmp_path: Path) -> None:
    copy = tmp_path / "copy.nc"
    assert peak_of(lambda: write_recording(stored, copy)) < 30_000_000
    assert np.array_equal(read_recording(copy).samples[:, 0:COUNT], stored.samples[:, 0:COUNT])


def test_no_file_stays_open(stored: Recording) -> None:
    handles = Path("/proc/self/fd")
    if not handles.exists():
        pytest.skip("no /proc on this system to count open files")
    before = len(list(handles.iterdir()))
    for start in range(0, 1000, 10):
        stored.samples[:, start : start + 10]
    assert len(list(handles.iterdir())) == before


@given(
    rows=st.one_of(st.slices(4), st.lists(st.integers(-4, 3), min_size=1, max_size=5)),
    start=st.one_of(st.none(), st.integers(-COUNT - 5, COUNT + 5)),
    length=st.integers(-5, 1000),
    step=st.sampled_from([None, 1, 3]),
)
def test_slices_are_those_of_an_array(
    stored: Recording,
    samples: np.ndarray,
    rows: slice | list[int],
    start: int | None,
    length: int,
    step: int | None,
) -> None:
    when = slice(start, (start or 0) + length, step)
    assert np.array_equal(stored.samples[rows, when], samples[rows, when])


def test_samples_are_not_read_backwards(stored: Recording) -> None:
    with pytest.raises(ValueError, match="read forwards"):
        stored.samples[:, 10:0:-1]
