"""A small file that holds, or says that it holds, too much is refused in little memory."""

import gzip
import subprocess
import sys
import tracemalloc
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner

from analysis.readers import read_recording
from analysis.reading_limits import (
    LONGEST_LINE,
    MEMORY_SETTING,
    MOST_COLUMNS,
    ReadingLimits,
    limits,
)
from hardware.description.errors import ConfigurationError, DataError
from pmm.cli import cli

HEAD = b"t [s],F [N]\n"
# 10 MB of these unpack to 10 GB; a tenth is enough to see what memory is taken.
READ = """
import sys
from analysis.readers import read_recording
from benchmarks.peak import peak_bytes
from hardware.description.errors import DataError
before = peak_bytes()
try:
    read_recording(sys.argv[1], sample_rate_hz=100.0)
except DataError as error:
    print(error)
    print(peak_bytes() - before, file=sys.stderr)
"""


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="no resource limits to measure with")
def test_a_gigabyte_of_gzip_takes_no_memory(tmp_path: Path) -> None:
    path = tmp_path / "run.csv.gz"
    with gzip.open(path, "wb", compresslevel=1) as file:
        file.write(b"F [N]\n")
        for _ in range(16):
            file.write(b"1\n" * (1 << 20))
    done = subprocess.run(
        [sys.executable, "-c", READ, str(path)],
        env={"PYTHONPATH": ":".join(sys.path), MEMORY_SETTING: "0.1"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert "rows or more of 1 columns, where the limit is 1388888 rows" in done.stdout
    assert MEMORY_SETTING in done.stdout
    assert int(done.stderr.split()[-1]) < 150_000_000


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (HEAD + b"0,1\n" + b"1," * LONGEST_LINE, "a line of more than 131072 bytes"),
        (HEAD + b"0,1\n" + b"\n" * (1 << 20), "a line of more than"),
        (b",".join(b"c%d" % k for k in range(MOST_COLUMNS + 1)) + b"\n", "no rows of data"),
        (
            b",".join(b"c%d" % k for k in range(MOST_COLUMNS + 1))
            + b"\n"
            + b",".join([b"1"] * (MOST_COLUMNS + 1))
            + b"\n",
            "4097 columns; the limit is 4096",
        ),
    ],
)
def test_shapes_that_no_recorder_writes(tmp_path: Path, text: bytes, said: str) -> None:
    path = tmp_path / "run.csv"
    path.write_bytes(text)
    with pytest.raises(DataError, match=said):
        read_recording(path, sample_rate_hz=100.0)


def test_text_beyond_the_limit_is_refused_though_no_number_of_it_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(MEMORY_SETTING, "0.001")
    path = tmp_path / "run.csv"
    path.write_bytes(HEAD + b"0,1,%s\n" % (b"x" * 60_000) * 100)
    with pytest.raises(DataError, match="more than 2000000 bytes of text"):
        read_recording(path)


def test_the_setting_raises_the_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "run.csv"
    path.write_bytes(HEAD + b"".join(b"%d,%d\n" % (k, k % 9) for k in range(20_000)))
    monkeypatch.setenv(MEMORY_SETTING, "0.001")
    with pytest.raises(DataError, match="19999 rows or more of 2 columns, where the limit is 104"):
        read_recording(path)
    monkeypatch.setenv(MEMORY_SETTING, "0.002")
    assert read_recording(path).sample_count == 20_000
    monkeypatch.delenv(MEMORY_SETTING)
    assert limits() == ReadingLimits()


@pytest.mark.parametrize("text", ["0", "-1", "nan", "inf", "much"])
def test_a_setting_that_is_no_number_is_refused(
    text: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "run.csv"
    path.write_bytes(HEAD + b"0,1\n1,2\n")
    monkeypatch.setenv(MEMORY_SETTING, text)
    with pytest.raises(ConfigurationError, match=MEMORY_SETTING):
        read_recording(path)


def declared(path: Path, shape: int, chunk: int, **more: int) -> Path:
    """A NetCDF file that says it holds so many samples, of which a hundred are there."""
    import h5py

    with h5py.File(path, "w") as file:
        file.attrs.update({"schema": "pmm-run-1", "sample_rate_hz": 100.0})
        for name in ("time", "force_aft", *more):
            one = file.create_dataset(
                name, (more.get(name, shape),), "f8", chunks=(chunk,), maxshape=(None,)
            )
            one[:100] = [k / 100.0 for k in range(100)]
            one.attrs["units"] = "s" if name != "force_aft" else "N"
            if name == "time":
                one.make_scale(name)
            elif name == "force_aft":
                one.dims[0].attach_scale(file["time"])
    return path


def chunked(path: Path) -> Path:
    """A NetCDF file that says it keeps half a thousand million samples in one piece."""
    import h5py

    with h5py.File(path, "w") as file:
        file.create_dataset("time", (10**9,), "f8", chunks=(5 * 10**8,))
    return path


@pytest.mark.parametrize(
    ("write", "said"),
    [
        (lambda path: declared(path, 10**12, 100), "8000000000000 bytes, of which 800 are there"),
        (
            lambda path: declared(path, 100, 100, photocell_edge_time=3 * 10**7),
            "30000000 rows or more of 1 columns",
        ),
        (chunked, "its chunks of 4000000000 bytes"),
    ],
)
def test_a_shape_is_not_believed(tmp_path: Path, write: Callable[[Path], Path], said: str) -> None:
    path = write(tmp_path / "run.nc")
    tracemalloc.start()
    try:
        with pytest.raises(DataError, match=said):
            read_recording(path)
        assert tracemalloc.get_traced_memory()[1] < 10_000_000
    finally:
        tracemalloc.stop()


def test_the_command_line_raises_the_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(MEMORY_SETTING, "1")  # put back afterwards, whatever the command sets
    path = tmp_path / "run.csv"
    path.write_bytes(HEAD + b"".join(b"%d,%d\n" % (k, k % 9) for k in range(20_000)))
    few = CliRunner().invoke(cli, ["--read-memory", "0.001", "analyse", str(path)])
    assert (few.exit_code, "too large" in few.stderr) == (1, True)
    more = CliRunner().invoke(cli, ["--read-memory", "0.1", "analyse", str(path)])
    assert "too large" not in more.stderr
