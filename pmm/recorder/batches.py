"""The batches of an Arrow stream, each of which says what it holds and which one was before it.

A batch carries in its metadata the CRC-32 of its columns' bytes and that of the batch before; the
first one's is that of the stream's beginning. So a batch that was changed is known, and one that is
missing; behind a damaged piece the next whole batch is looked for.
"""

import mmap
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final
from zlib import crc32

import numpy as np
from numpy.typing import NDArray

from hardware.description.arrays import IntArray

KEY: Final = b"checksums"
KIND: Final = b"crc32"  # what a stream whose batches have checksums says under the key
_TEXT: Final = "crc32={:08x} before={:08x}"
_TAG: Final = re.compile(rb"crc32=([0-9a-f]{8}) before=([0-9a-f]{8})")
_BEGIN: Final = b"\xff" * 4  # of a message, followed by the length of its metadata
_MOST_METADATA: Final = 1 << 20  # bytes: 20,000 columns
_WORD: Final = 4


@dataclass(frozen=True, eq=False)
class Batch:
    """A whole batch.

    Attributes
    ----------
    sync
        Its SYNCs.
    own_checksum, checksum_before
        Its checksum, and that of the batch before it; ``None`` in streams without.
    end
        Where it ends in the file.
    """

    content: Any
    sync: IntArray
    own_checksum: int | None
    checksum_before: int | None
    end: int


def checksum(columns: Iterable[NDArray[Any]], before: int) -> int:
    """Return the checksum of a batch's columns behind that of the batch before."""
    crc = crc32(before.to_bytes(_WORD, "little"))
    for column in columns:
        crc = crc32(np.ascontiguousarray(column).data, crc)
    return crc


def metadata(crc: int, before: int) -> dict[bytes, bytes]:
    """Return what a batch carries."""
    return {KEY: _TEXT.format(crc, before).encode()}


def read_batches(path: Path, schema: Any, start: int) -> Iterator[Batch]:
    """Yield the whole batches of a stream, in the order of the file.

    Parameters
    ----------
    schema
        Of the stream; where it says that there are checksums, batches without are damaged.
    start
        Where the first batch begins.
    """
    import pyarrow as pa

    with path.open("rb") as file:
        data = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
    buffer, tagged = pa.py_buffer(data), (schema.metadata or {}).get(KEY) == KIND
    at: int | None = start
    while at is not None and at < len(data):
        batch = _batch(data, buffer, at, schema, tagged=tagged)
        if batch is not None:
            yield batch
            at = batch.end
        else:
            at = _next_message(data, at + 1) if tagged else None


def _tag(data: mmap.mmap, at: int) -> re.Match[bytes] | None:
    """Return the checksums of the message at a place, if one can begin there."""
    if data[at : at + _WORD] != _BEGIN:
        return None
    length = int.from_bytes(data[at + _WORD : at + 2 * _WORD], "little")
    if length > _MOST_METADATA:
        return None
    return _TAG.search(data[at + 2 * _WORD : at + 2 * _WORD + length])


def _next_message(data: mmap.mmap, at: int) -> int | None:
    """Return where the next message with checksums begins."""
    while (at := data.find(_BEGIN, at)) >= 0:
        if _tag(data, at):
            return at
        at += 1
    return None


def _batch(data: mmap.mmap, buffer: Any, at: int, schema: Any, *, tagged: bool) -> Batch | None:
    """Return the batch at a place; ``None`` if none is whole there."""
    import pyarrow as pa

    tag = _tag(data, at)
    if tagged and tag is None:
        return None
    try:
        source = pa.BufferReader(buffer.slice(at))
        batch = pa.ipc.read_record_batch(pa.ipc.read_message(source), schema)
        batch.validate()
        columns = [column.to_numpy() for column in batch.columns]
    except (pa.ArrowException, OSError, EOFError, ValueError):
        return None
    sync = columns[0]
    if not (len(sync) and sync[0] > 0 and np.all(np.diff(sync) > 0)):
        return None
    crc, before = (int(tag[1], 16), int(tag[2], 16)) if tag else (None, None)
    if before is not None and checksum(columns, before) != crc:
        return None
    return Batch(batch, sync, crc, before, at + source.tell())
