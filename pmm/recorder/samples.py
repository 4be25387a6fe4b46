"""The journal of samples: an Arrow IPC stream, a batch per flush, and out of it what is whole.

Its columns are ``sync``, the number of the SYNC, and the channels. What a batch holds is readable
as soon as it is written; a stream that was cut is readable up to its last whole batch.
"""

from bisect import bisect_left
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any, Final, NamedTuple
from zlib import crc32

import numpy as np
from numpy.typing import NDArray

from hardware.description.arrays import FloatArray, IntArray
from hardware.description.errors import DataError
from pmm.recorder import batches
from pmm.recorder.header import RunHeader

Piece = tuple[int, FloatArray]
SYNC: Final = "sync"
_HEADER_KEY: Final = b"run_header"


class SampleWriter:
    """Makes the bytes of the stream; importing Arrow takes a while, so make it before the loop."""

    def __init__(self, header: RunHeader) -> None:
        import pyarrow as pa

        self._arrow = pa
        fields = [pa.field(SYNC, pa.int64())]
        for channel in header.channels:
            about = {"units": channel.unit, "source": header.sources.get(channel.name, "")}
            if channel.full_scale is not None:
                about["full_scale"] = repr(channel.full_scale)
            for key, value in header.calibration.get(channel.name, {}).items():
                about[key] = repr(value)
            fields.append(pa.field(channel.name, pa.float64(), metadata=about))
        about_all = {_HEADER_KEY: header.to_json().encode(), batches.KEY: batches.KIND}
        self._schema = pa.schema(fields, metadata=about_all)
        self._head = bytes(self._schema.serialize())
        self._before = 0
        self.batch([(1, np.zeros((len(header.channels), 1)))])  # what is slow the first time

    def head(self) -> bytes:
        """Return the beginning of the stream, which its batches follow in the order of calls."""
        self._before = crc32(self._head)
        return self._head

    def batch(self, pieces: Sequence[Piece]) -> bytes:
        """Return pieces, each its first SYNC and values over the channels, as one batch."""
        sync = np.concatenate(
            [np.arange(first, first + values.shape[1], dtype=np.int64) for first, values in pieces]
        )
        values = np.ascontiguousarray(np.concatenate([values for _, values in pieces], axis=1))
        columns = [self._column(column) for column in (sync, *values)]
        batch = self._arrow.RecordBatch.from_arrays(columns, schema=self._schema)
        crc = batches.checksum((sync, *values), self._before)
        about, self._before = batches.metadata(crc, self._before), crc
        return self._message(batch, about)

    def _message(self, batch: Any, about: dict[bytes, bytes]) -> bytes:
        """Return a batch as it stands in the stream; only a stream's writer takes metadata."""
        sink = self._arrow.BufferOutputStream()
        with self._arrow.ipc.new_stream(sink, self._schema) as stream:
            stream.write_batch(batch, custom_metadata=about)
            end = sink.tell()
        return bytes(sink.getvalue()[len(self._head) : end])

    def _column(self, values: NDArray[Any]) -> Any:
        """Return a column over an array; Arrow's own way from NumPy would load pandas here."""
        pa = self._arrow
        kind = pa.int64() if values.dtype == np.int64 else pa.float64()
        return pa.Array.from_buffers(kind, len(values), [None, pa.py_buffer(values)])


@dataclass(frozen=True)
class JournalSamples:
    """The samples of a stream, read when asked for; missing SYNCs are NaN.

    A :class:`analysis.recording.Samples`.

    Attributes
    ----------
    header_text
        The header as it was written, perhaps by another version, which knew fewer keys.
    first_sync
        SYNC of sample number 0.
    sample_count
        Samples from the first to the last, the missing ones counted.
    gaps
        First missing SYNC and how many, of each gap.
    whole_bytes
        Of the file: where the last whole batch ends.
    changes
        What is not what was written, in words; a stream without checksums has none to tell by.
    is_headed
        Whether the header is what was written, by the first batch's checksum.
    """

    header: RunHeader
    header_text: str
    first_sync: int
    sample_count: int
    gaps: tuple[tuple[int, int], ...]
    whole_bytes: int
    changes: tuple[str, ...]
    is_headed: bool
    batches: tuple[Any, ...]
    syncs: tuple[IntArray, ...]

    @property
    def shape(self) -> tuple[int, ...]:
        """``(channels, samples)``."""
        return (len(self.header.channels), self.sample_count)

    def __getitem__(self, key: tuple[slice | Sequence[int], slice], /) -> FloatArray:
        """Return some channels between two sample numbers, shape ``(rows, samples)``."""
        rows, when = key
        chosen = range(self.shape[0])[rows] if isinstance(rows, slice) else rows
        start, stop, step = when.indices(self.sample_count)
        low, high = self.first_sync + start, self.first_sync + stop
        values = np.full((len(chosen), max(0, stop - start)), np.nan)
        earliest = bisect_left(self.syncs, low, key=lambda sync: sync[-1])
        for k in range(earliest, bisect_left(self.syncs, high, key=lambda sync: sync[0])):
            a, b = np.searchsorted(self.syncs[k], (low, high))
            at = self.syncs[k][a:b] - low
            for row, channel in zip(values, chosen, strict=True):
                row[at] = self.batches[k].column(channel + 1).to_numpy()[a:b]
        return values[:, ::step]


def read_header(path: Path) -> RunHeader | None:
    """Return the header that a stream carries; ``None`` if its beginning is not whole."""
    opened = _open(path)
    return opened and opened.header


def read_samples(path: Path) -> JournalSamples | None:
    """Return what is whole of a stream; ``None`` if that is nothing."""
    opened = _open(path)
    if opened is None:
        return None
    header, head_sum = opened.header, opened.checksum
    stored_batches = list(batches.read_batches(path, opened.schema, opened.end))
    ordered_batches = _in_order(stored_batches)
    if not ordered_batches:
        return None
    first, last = int(ordered_batches[0].sync[0]), int(ordered_batches[-1].sync[-1])
    syncs = tuple(batch.sync for batch in ordered_batches)
    changes = tuple(_changes(stored_batches, ordered_batches, head_sum, header))
    return JournalSamples(
        header,
        opened.text,
        first,
        last - first + 1,
        _gaps(syncs),
        max(batch.end for batch in stored_batches),
        changes,
        ordered_batches[0].checksum_before == head_sum,
        tuple(batch.content for batch in ordered_batches),
        syncs,
    )


def _in_order(stored_batches: Sequence[batches.Batch]) -> list[batches.Batch]:
    """Return batches by their SYNCs, but for those that come again."""
    ordered_batches: list[batches.Batch] = []
    for batch in sorted(stored_batches, key=lambda batch: int(batch.sync[0])):
        if not ordered_batches or batch.sync[0] > ordered_batches[-1].sync[-1]:
            ordered_batches.append(batch)
    return ordered_batches


def _changes(
    stored_batches: Sequence[batches.Batch],
    ordered_batches: Sequence[batches.Batch],
    head_sum: int,
    header: RunHeader,
) -> Iterator[str]:
    """Say what is not what was written, in words."""
    if ordered_batches[0].own_checksum is None:
        return
    if list(stored_batches) != list(ordered_batches):
        yield "its batches are not in the order in which they were written"
    if ordered_batches[0].checksum_before != head_sum:
        yield "its beginning, or its first batch, is damaged or missing"
    for batch, after in pairwise(ordered_batches):
        if after.checksum_before != batch.own_checksum:
            lost = int(batch.sync[-1]) + 1, int(after.sync[0]) - 1
            times = " to ".join(f"{at / header.sample_rate_hz:.3f} s" for at in lost)
            yield f"what lay between is damaged or missing: SYNC {lost[0]} to {lost[1]} ({times})"


class _Beginning(NamedTuple):
    """A whole beginning of a stream: its header, where it ends, and its checksum."""

    header: RunHeader
    text: str
    schema: Any
    end: int
    checksum: int


def _open(path: Path) -> _Beginning | None:
    import pyarrow as pa

    if not path.exists() or not path.stat().st_size:
        return None
    with path.open("rb") as file:
        try:
            schema = pa.ipc.open_stream(file).schema
            text = (schema.metadata or {})[_HEADER_KEY].decode()
            header = RunHeader.from_json(text, str(path))
        except (pa.ArrowException, OSError, KeyError, UnicodeDecodeError, DataError):
            return None
        end = file.tell()
        file.seek(0)
        return _Beginning(header, text, schema, end, crc32(file.read(end)))


def _gaps(syncs: Sequence[IntArray]) -> tuple[tuple[int, int], ...]:
    """Return the first missing SYNC and the count of each gap."""
    gaps = []
    before = int(syncs[0][0]) - 1
    for sync in syncs:
        steps = np.diff(sync, prepend=before)
        at = np.flatnonzero(steps > 1)
        gaps += [(int(sync[i] - steps[i] + 1), int(steps[i] - 1)) for i in at]
        before = int(sync[-1])
    return tuple(gaps)


def counts(samples: JournalSamples) -> Mapping[str, int]:
    """Return the counts of a journal, for the completion marker."""
    missing = sum(count for _, count in samples.gaps)
    return {
        "samples": samples.sample_count - missing,
        "missing": missing,
        "first_sync": samples.first_sync,
        "last_sync": samples.first_sync + samples.sample_count - 1,
    }
