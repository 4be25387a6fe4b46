"""Whatever sizes a raw log states: it ends there, at once, in little memory; its frames hold."""

import struct
import tracemalloc
import zlib
from pathlib import Path

import numpy as np
import pytest

from hardware.raw_log import FramePacker, container, file_header
from hardware.raw_log_reading import MOST_BYTES, look, read_frames
from tests.pmm.recorder.test_raw_log_against_python_can import numbered, said, written

COUNT, PIECES = 500, 5
HEAD = 144  # bytes before the first container


def packed(objects: bytes, says: int) -> bytes:
    """A container that states any size of its objects."""
    body = struct.pack("<H6xI4x", 2, says) + zlib.compress(objects)
    size = 16 + len(body)
    return struct.pack("<4sHHII", b"LOBJ", 16, 1, size, 10) + body + bytes(size % 4)


def frames_of(count: int) -> bytes:
    packer = FramePacker()
    for frame in numbered(count):
        packer.take(frame)
    return b"".join(packer.drain())


@pytest.mark.parametrize("size", [0, 1, 15, 16, 31, 32, 2**31, 2**32 - 1])
def test_a_container_of_any_size_ends_the_log(tmp_path: Path, size: int) -> None:
    path = tmp_path / "bus.blf"
    data = bytearray(written(path, numbered(COUNT)))
    second = data.index(b"LOBJ", HEAD + 4)
    data[second + 8 : second + 12] = size.to_bytes(4, "little")
    path.write_bytes(data)
    assert len(list(read_frames(path))) == COUNT // PIECES
    assert look(path).frames == COUNT // PIECES
    assert look(path).tail_bytes == len(data) - second


@pytest.mark.parametrize("size", [0, 1, 47, 49, 2**32 - 1])
def test_an_object_of_any_size_ends_its_container(tmp_path: Path, size: int) -> None:
    path, objects = tmp_path / "bus.blf", bytearray(frames_of(10))
    objects[3 * 48 + 8 : 3 * 48 + 12] = size.to_bytes(4, "little")
    path.write_bytes(file_header() + container(bytes(objects)))
    assert [one.data[0] for one in read_frames(path)] == [0, 1, 2]
    assert look(path).frames == 3


@pytest.mark.parametrize("says", [0, 480, MOST_BYTES, 2**32 - 1])
def test_what_unpacks_to_more_than_it_says_takes_no_memory(tmp_path: Path, says: int) -> None:
    path = tmp_path / "bus.blf"
    bomb = packed(bytes(1 << 26), says) if says == 480 else packed(bytes(1 << 24), says)
    path.write_bytes(file_header() + container(frames_of(10)) + bomb)
    tracemalloc.start()
    try:
        assert len(list(read_frames(path))) == 10
        assert look(path).frames == 10
        assert tracemalloc.get_traced_memory()[1] < 16 * MOST_BYTES
    finally:
        tracemalloc.stop()


def test_a_spoiled_log_is_its_beginning(tmp_path: Path) -> None:
    """Every container has zlib's checksum: no frame that was not written is ever read."""
    path = tmp_path / "bus.blf"
    whole = np.frombuffer(written(path, numbered(COUNT)), np.uint8)
    told = [said(one) for one in numbered(COUNT)]
    rng = np.random.default_rng(23)
    for _ in range(300):
        data = whole.copy()
        at = rng.integers(HEAD, len(data), int(rng.integers(1, 6)))
        data[at] = rng.integers(0, 256, len(at))
        path.write_bytes(data.tobytes())
        found = [said(one) for one in read_frames(path)]
        assert found == told[: len(found)]
