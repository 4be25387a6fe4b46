"""Frames out of what is left of a raw log, whatever stands in it.

A size is believed only up to what a writer makes: containers and their objects are looked at in
place, and what is larger, shorter or not where it should be ends the log. python-can's own reader
goes round for ever at an object of size 0 and takes gigabytes for one that says so.
"""

import zlib
from collections.abc import Generator, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO, Final

from hardware.raw_log import (
    ERROR,
    EXTENDED,
    FRAME,
    HEADER_BYTES,
    KIND_CONTAINER,
    KIND_ERROR,
    KIND_FRAME,
    OBJECT,
    PACKED,
    REMOTE,
    SENT,
    ZLIB,
    Frame,
)

# Of a container, packed or not: python-can's writer makes 128 KiB, the one here 8. Twice as many
# would do no harm; half would still hold whatever is written.
MOST_BYTES: Final = 1 << 20
_NANOSECOND_S: Final = 1e-9
_MASK: Final = 0x1FFFFFFF


@dataclass(frozen=True)
class LogState:
    """What a raw log holds: whole frames, and bytes behind the last whole container."""

    frames: int
    tail_bytes: int


def look(path: Path) -> LogState:
    """Tell what is whole in a log, however it ended; a file that is no log has no frames."""
    size = path.stat().st_size
    frames = end = 0
    with path.open("rb") as file:
        for data, after in _containers(file):
            frames, end = frames + sum(1 for _ in _objects(data)), after
        end = end or (HEADER_BYTES if _is_log(file) else 0)
    return LogState(frames, size - min(end, size))


def read_frames(path: Path) -> Generator[Frame, None, None]:
    """Yield a log's frames in order, up to where it is cut or damaged."""
    with path.open("rb") as file:
        for data, _ in _containers(file):
            for kind, at in _objects(data):
                yield _frame(data, at) if kind == KIND_FRAME else _error(data, at)


def _is_log(file: BinaryIO) -> bool:
    """Read the header."""
    file.seek(0)
    head = file.read(HEADER_BYTES)
    return len(head) == HEADER_BYTES and head.startswith(b"LOGG")


def _containers(file: BinaryIO) -> Iterator[tuple[bytes, int]]:
    """Yield each whole container's objects, and where the next one begins."""
    if not _is_log(file):
        return
    while len(head := file.read(OBJECT.size)) == OBJECT.size:
        signature, _, _, size, kind = OBJECT.unpack(head)
        rest = size - OBJECT.size
        if signature != b"LOBJ" or kind != KIND_CONTAINER or not PACKED.size < rest <= MOST_BYTES:
            return
        body = file.read(rest)
        if len(body) < rest or len(file.read(size % 4)) < size % 4:
            return
        data = _unpacked(body)
        if data is None:
            return
        yield data, file.tell()


def _unpacked(body: bytes) -> bytes | None:
    """Return a container's objects; ``None`` if they are not as long as it says."""
    method, length = PACKED.unpack_from(body)
    if method != ZLIB or length > MOST_BYTES:
        return None
    unpacker = zlib.decompressobj()
    try:
        data = unpacker.decompress(body[PACKED.size :], length + 1)
    except zlib.error:
        return None
    return data if unpacker.eof and len(data) == length else None


def _objects(data: bytes) -> Iterator[tuple[int, int]]:
    """Yield kind and place of each frame, up to what is none."""
    at = 0
    while at + OBJECT.size <= len(data):
        signature, _, _, size, kind = OBJECT.unpack_from(data, at)
        full_size = _SIZES.get(kind)
        if signature != b"LOBJ" or size != full_size or at + size > len(data):
            return
        yield kind, at
        at += size


_SIZES: Final = {KIND_FRAME: FRAME.size, KIND_ERROR: ERROR.size}


def _frame(data: bytes, at: int) -> Frame:
    _, _, _, _, _, _, _, _, stamp, _, flags, length, identifier, payload = FRAME.unpack_from(
        data, at
    )
    length = min(length, len(payload))
    is_remote = bool(flags & REMOTE)
    return Frame(
        timestamp=stamp * _NANOSECOND_S,
        arbitration_id=identifier & _MASK,
        is_extended_id=bool(identifier & EXTENDED),
        is_remote_frame=is_remote,
        is_rx=not flags & SENT,
        dlc=length,
        data=None if is_remote else payload[:length],
    )


def _error(data: bytes, at: int) -> Frame:
    values = ERROR.unpack_from(data, at)
    stamp, length, identifier, payload = values[8], values[14], values[16], values[18]
    return Frame(
        timestamp=stamp * _NANOSECOND_S,
        is_error_frame=True,
        arbitration_id=identifier & _MASK,
        is_extended_id=bool(identifier & EXTENDED),
        dlc=min(length, len(payload)),
        data=payload[:length],
    )
