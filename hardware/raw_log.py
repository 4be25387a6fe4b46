"""The raw log of a CAN bus: frames into Vector's binary log (BLF), and out of what is left of one.

A BLF is a header of 144 bytes and a row of objects. Those here are containers, each of zlib-packed
frames and readable by itself: what is cut off behind one does not touch it. They are kept small, so
that a cut costs little. python-can's own writer takes some 10 us a frame, this one about 1; its
reader reads both.
"""

import struct
import zlib
from collections.abc import Generator, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO, Final

import can
import numpy as np
from can.io.blf import BLFParseError

CONTAINER_BYTES: Final = 8192
_LEVEL: Final = 1  # zlib: five times smaller already, at a third of the time
_HEADER_BYTES: Final = 144
_HEADER = struct.Struct("<4sI8BQQII16H72x")
_OBJECT = struct.Struct("<4sHHII")  # signature, header's size and version, object's size, kind
_PACKED = struct.Struct("<H6xI4x")  # method, size when unpacked
# An object, then: flags (nanoseconds), two unused, stamp; channel, flags, length, identifier, data.
_FRAME = struct.Struct("<4sHHIIIHHQHBBI8s")
# The same head; channel, length, and of an error: flags, code, position, length, identifier, data.
_ERROR = struct.Struct("<4sHHIIIHHQHHIBBBxIIH2x8s")
_KIND_FRAME, _KIND_CONTAINER, _KIND_ERROR = 1, 10, 73
_NANOSECONDS, _CHANNEL, _ZLIB = 2, 1, 2
_SENT, _REMOTE, _EXTENDED = 0x01, 0x80, 0x80000000
_ROW = np.dtype([("head", "S4"), ("sizes", "<u2", 2), ("size", "<u4"), ("kind", "<u4"),
                 ("rest", "V32")])  # fmt: skip

Frame = can.Message


def file_header(size: int = 0, unpacked: int = 0, frames: int = 0) -> bytes:
    """Return the header; a log that was not closed says 0 of its size and frames."""
    objects = 0 if not size else frames
    return _HEADER.pack(
        b"LOGG", _HEADER_BYTES, 0, 0, 0, 0, 2, 6, 8, 1, size, unpacked, objects, 0, *([0] * 16)
    )


def container(objects: bytes) -> bytes:
    """Return packed objects as one object of the file."""
    packed = zlib.compress(objects, _LEVEL)
    size = _OBJECT.size + _PACKED.size + len(packed)
    head = _OBJECT.pack(b"LOBJ", _OBJECT.size, 1, size, _KIND_CONTAINER)
    return b"".join((head, _PACKED.pack(_ZLIB, len(objects)), packed, bytes(size % 4)))


class FramePacker:
    """Turns frames into objects of a log, a container's worth at a time.

    Sent frames bear the stamp of the last one received: the order is what counts.

    Attributes
    ----------
    frames
        How many were taken.
    unpacked_bytes
        How many bytes of objects they made.
    """

    def __init__(self) -> None:
        self.frames = 0
        self.unpacked_bytes = 0
        self._stamp_ns = 0
        self._pending = bytearray()
        self._full: list[bytes] = []

    def take(self, frame: Frame) -> None:
        """Take a frame."""
        stamp_ns = int(frame.timestamp * 1e9)
        if stamp_ns > self._stamp_ns:
            self._stamp_ns = stamp_ns
        data = self._error(frame) if frame.is_error_frame else self._frame(frame)
        self.frames += 1
        self.unpacked_bytes += len(data)
        if len(self._pending) + len(data) > CONTAINER_BYTES:
            self._full.append(bytes(self._pending))
            self._pending.clear()
        self._pending += data

    def drain(self) -> list[bytes]:
        """Return what has come since the last call, in pieces for :func:`container`."""
        pieces, self._full = self._full, []
        if self._pending:
            pieces.append(bytes(self._pending))
            self._pending.clear()
        return pieces

    def _frame(self, frame: Frame) -> bytes:
        flags = (0 if frame.is_rx else _SENT) | (_REMOTE if frame.is_remote_frame else 0)
        identifier = frame.arbitration_id | (_EXTENDED if frame.is_extended_id else 0)
        return _FRAME.pack(
            b"LOBJ", 32, 1, _FRAME.size, _KIND_FRAME, _NANOSECONDS, 0, 0, self._stamp_ns,
            _CHANNEL, flags, frame.dlc, identifier, frame.data,
        )  # fmt: skip

    def _error(self, frame: Frame) -> bytes:
        identifier = frame.arbitration_id | (_EXTENDED if frame.is_extended_id else 0)
        return _ERROR.pack(
            b"LOBJ", 32, 1, _ERROR.size, _KIND_ERROR, _NANOSECONDS, 0, 0, self._stamp_ns,
            _CHANNEL, 0, 0, 0, 0, frame.dlc, 0, identifier, 0, frame.data,
        )  # fmt: skip


@dataclass(frozen=True)
class LogState:
    """What a raw log holds: whole frames, and bytes behind the last whole container."""

    frames: int
    tail_bytes: int


def look(path: Path) -> LogState:
    """Tell what is whole in a log, however it ended; a file that is no log has no frames."""
    size = path.stat().st_size
    frames, end = 0, 0
    with path.open("rb") as file:
        if file.read(_HEADER_BYTES)[:4] == b"LOGG" and size >= _HEADER_BYTES:
            end = _HEADER_BYTES
            for objects, after in _containers(file):
                frames, end = frames + _count(objects), after
    return LogState(frames, size - min(end, size))


def read_frames(path: Path) -> Generator[Frame, None, None]:
    """Yield a log's frames in order, up to where it is cut or damaged."""
    try:
        with path.open("rb") as file:
            yield from can.BLFReader(file)
    except (BLFParseError, struct.error, zlib.error, ValueError):
        return


def _containers(file: BinaryIO) -> Iterator[tuple[bytes, int]]:
    """Yield each whole container's objects, and where the next one begins."""
    while len(head := file.read(_OBJECT.size)) == _OBJECT.size:
        signature, _, _, size, kind = _OBJECT.unpack(head)
        rest = size - _OBJECT.size
        if signature != b"LOBJ" or kind != _KIND_CONTAINER or not 0 < rest <= 4 * CONTAINER_BYTES:
            return
        body = file.read(rest)
        if len(body) < rest or len(file.read(size % 4)) < size % 4:
            return
        try:
            yield zlib.decompress(body[_PACKED.size :]), file.tell()
        except zlib.error:
            return


def _count(objects: bytes) -> int:
    """Return how many objects there are, which all begin with their size."""
    if len(objects) % _ROW.itemsize == 0:
        rows = np.frombuffer(objects, _ROW)
        if np.all(rows["size"] == _ROW.itemsize):
            return len(rows)
    at = found = 0
    while at + _OBJECT.size <= len(objects):
        at += _OBJECT.unpack_from(objects, at)[3]
        found += 1
    return found
