"""Whatever happens to a file's bytes, it is refused in words or read; nothing else comes out."""

import gzip
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.readers import read_recording, write_recording
from analysis.recording import Recording
from hardware.description.channels import Channel
from hardware.description.errors import DataError

TEXT = b"Time [s],F [N],G [mm]\n" + b"".join(b"%d.5,%d.25,-%d\n" % (n, n, n) for n in range(60))

spots = st.lists(st.tuples(st.integers(0, len(TEXT) - 1), st.integers(0, 255)), max_size=6)


@given(spots=spots, cut=st.integers(0, len(TEXT)))
def test_damaged_text(
    tmp_path_factory: pytest.TempPathFactory, spots: list[tuple[int, int]], cut: int
) -> None:
    data = bytearray(TEXT)
    for place, value in spots:
        data[place] = value
    path = tmp_path_factory.mktemp("damaged") / "run.csv"
    path.write_bytes(bytes(data[:cut]))
    with suppress(DataError):
        recording = read_recording(path)
        assert recording.samples.shape == (len(recording.channels), recording.sample_count)
        assert recording.sample_rate_hz > 0.0


@given(cut=st.integers(1, len(gzip.compress(TEXT, mtime=0)) - 1))
def test_every_truncation_of_gzip_is_refused(
    tmp_path_factory: pytest.TempPathFactory, cut: int
) -> None:
    path = tmp_path_factory.mktemp("cut") / "run.csv.gz"
    path.write_bytes(gzip.compress(TEXT, mtime=0)[:cut])
    with pytest.raises(DataError, match="gzip file"):
        read_recording(path)


@pytest.fixture(scope="module")
def stored(tmp_path_factory: pytest.TempPathFactory) -> Path:
    samples = np.random.default_rng(3).standard_normal((2, 300))
    recording = Recording("run", (Channel("a", "N"), Channel("b", "m")), samples, 100.0)
    return write_recording(recording, tmp_path_factory.mktemp("stored") / "run.nc")


@given(part=st.floats(0.001, 0.999))
def test_every_truncation_of_netcdf_is_refused(
    tmp_path_factory: pytest.TempPathFactory, stored: Path, part: float
) -> None:
    data = stored.read_bytes()
    path = tmp_path_factory.mktemp("cut") / "run.nc"
    path.write_bytes(data[: int(part * len(data))])
    with pytest.raises(DataError, match=r"cut short|not a NetCDF|is damaged|is empty"):
        read_recording(path)
