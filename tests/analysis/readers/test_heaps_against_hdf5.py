"""A heap that HDF5 walks through for ever is refused, and no other; HDF5 itself is the judge.

HDF5 is asked in a process of its own, which the system ends: no signal reaches HDF5's loop.
"""

import signal
import struct
import subprocess
import sys
from pathlib import Path

import h5py
import pytest

from analysis.readers import read_recording, write_recording
from analysis.readers.stored_samples import check_heaps
from hardware.description.errors import DataError
from tests.analysis.readers.test_netcdf_bad_input import example

_MARK = b"GCOL"
# Opening such a file takes milliseconds; the limit is of processor time, and in whole seconds.
_OPEN = """
import resource, sys, time, h5netcdf
ends = int(time.process_time()) + 2
resource.setrlimit(resource.RLIMIT_CPU, (ends, ends + 1))
try:
    h5netcdf.File(sys.argv[1], "r", phony_dims="sort")
except Exception:
    pass
"""


def _objects(data: bytes) -> list[int]:
    """Return where the objects of the first heap begin; the last is what is free."""
    heap = data.index(_MARK)
    (size,) = struct.unpack_from("<Q", data, heap + 8)
    found, at = [], heap + 16
    while at < heap + size:
        number, own = struct.unpack_from("<H6xQ", data, at)
        found.append(at)
        at += own if number == 0 else 16 + (own + 7) // 8 * 8
    return found


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("which", "number", "size", "endless"),
    [
        (-1, 0, 0, True),
        (1, 0, 0, True),
        (1, 5, 2**64 - 16, True),
        (1, 5, 2**64 - 24, False),
        (-1, 0, 2**64 - 8, False),
        (1, 5, 5000, False),
    ],
)
def test_refused_where_hdf5_comes_to_no_end(
    tmp_path: Path, which: int, number: int, size: int, endless: bool
) -> None:
    path = write_recording(example(), tmp_path / "run.nc")
    data = bytearray(path.read_bytes())
    struct.pack_into("<H6xQ", data, _objects(data)[which], number, size)
    path.write_bytes(data)
    assert _hangs(path) is endless
    with pytest.raises(DataError, match="heap at byte [0-9]+ has no end" if endless else "damaged"):
        read_recording(path)


def _hangs(path: Path) -> bool:
    asked = subprocess.run([sys.executable, "-c", _OPEN, str(path)], check=False)
    assert asked.returncode in (0, -signal.SIGXCPU)
    return asked.returncode != 0


def test_heaps_of_other_sizes_and_places_are_sound(tmp_path: Path) -> None:
    path = tmp_path / "texts.nc"
    with h5py.File(path, "w") as file:
        for number in range(300):  # several heaps, some of a single long text
            file.attrs[f"text {number}"] = "x" * (number % 7) * 3000
    assert path.read_bytes().count(_MARK) > 5
    check_heaps(path)


@pytest.mark.parametrize("place", [0, (1 << 20) - 4, (2 << 20) - 7, 3 << 20])
def test_a_heap_is_found_wherever_it_begins(tmp_path: Path, place: int) -> None:
    path = tmp_path / "run.nc"
    heap = struct.pack("<4sB3xQ", _MARK, 1, 4096) + bytes(4080)
    path.write_bytes(bytes(place) + heap + bytes(100))
    with pytest.raises(DataError, match=f"heap at byte {place} has no end"):
        check_heaps(path)


def test_a_mark_at_the_end_of_a_file_is_no_heap(tmp_path: Path) -> None:
    path = tmp_path / "run.nc"
    path.write_bytes(_MARK + b"\x01\0\0\0")
    check_heaps(path)
