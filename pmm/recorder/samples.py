"""The journal of samples: an Arrow IPC stream, a batch per flush, and out of it what is whole.

Its columns are ``sync``, the number of the SYNC, and the channels. What a batch holds is readable
as soon as it is written; a stream that was cut is readable up to its last whole batch.
"""

from bisect import bisect_left
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from hardware.description.errors import DataError
from pmm.recorder.header import RunHeader

FloatArray = NDArray[np.float64]
Piece = tuple[int, FloatArray]
SYNC: Final = "sync"
_HEADER_KEY: Final = b"run_header"


class SampleWriter:
    """Makes the bytes of the stream; importing Arrow takes a while, so make it before the loop."""

    def __init__(self, header: RunHeader) -> None:
        import pyarrow as pa

        self._arrow = pa
        fields = [pa.field(SYNC, pa.int64())]
        for one in header.channels:
            about = {"units": one.unit, "source": header.sources.get(one.name, "")}
            if one.full_scale is not None:
                about["full_scale"] = repr(one.full_scale)
            for key, value in header.calibration.get(one.name, {}).items():
                about[key] = repr(value)
            fields.append(pa.field(one.name, pa.float64(), metadata=about))
        self._schema = pa.schema(fields, metadata={_HEADER_KEY: header.to_json().encode()})
        self.batch([(1, np.zeros((len(header.channels), 1)))])  # what is slow the first time

    def head(self) -> bytes:
        """Return the beginning of the stream."""
        return bytes(self._schema.serialize())

    def batch(self, pieces: Sequence[Piece]) -> bytes:
        """Return pieces, each its first SYNC and values over the channels, as one batch."""
        sync = np.concatenate(
            [np.arange(first, first + values.shape[1], dtype=np.int64) for first, values in pieces]
        )
        values = np.ascontiguousarray(np.concatenate([values for _, values in pieces], axis=1))
        columns = [self._column(one) for one in (sync, *values)]
        batch = self._arrow.RecordBatch.from_arrays(columns, schema=self._schema)
        return bytes(batch.serialize())

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
    first_sync
        SYNC of sample number 0.
    sample_count
        Samples from the first to the last, the missing ones counted.
    gaps
        First missing SYNC and how many, of each gap.
    whole_bytes
        Of the file: where the last whole batch ends.
    """

    header: RunHeader
    first_sync: int
    sample_count: int
    gaps: tuple[tuple[int, int], ...]
    whole_bytes: int
    batches: tuple[Any, ...]
    syncs: tuple[NDArray[np.int64], ...]

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
        found = np.full((len(chosen), max(0, stop - start)), np.nan)
        earliest = bisect_left(self.syncs, low, key=lambda sync: sync[-1])
        for k in range(earliest, bisect_left(self.syncs, high, key=lambda sync: sync[0])):
            a, b = np.searchsorted(self.syncs[k], (low, high))
            at = self.syncs[k][a:b] - low
            for row, channel in zip(found, chosen, strict=True):
                row[at] = self.batches[k].column(channel + 1).to_numpy()[a:b]
        return found[:, ::step]


def read_header(path: Path) -> RunHeader | None:
    """Return the header that a stream carries; ``None`` if its beginning is not whole."""
    opened = _open(path)
    return opened and opened[0]


def read_samples(path: Path) -> JournalSamples | None:
    """Return what is whole of a stream; ``None`` if that is nothing."""
    opened = _open(path)
    if opened is None:
        return None
    header, stream, source = opened
    batches: list[Any] = []
    syncs: list[NDArray[np.int64]] = []
    whole = source.tell()
    while (batch := _next(stream)) is not None:
        sync = batch.column(0).to_numpy()
        last = int(syncs[-1][-1]) if syncs else 0
        if not (len(sync) and sync[0] > last and np.all(np.diff(sync) > 0)):
            break
        batches.append(batch)
        syncs.append(sync)
        whole = source.tell()
    if not batches:
        return None
    first, last = int(syncs[0][0]), int(syncs[-1][-1])
    return JournalSamples(
        header, first, last - first + 1, _gaps(syncs), whole, tuple(batches), tuple(syncs)
    )


def _open(path: Path) -> tuple[RunHeader, Any, Any] | None:
    """Open a stream and read its schema; ``None`` if that is not whole."""
    import pyarrow as pa

    if not path.exists() or not path.stat().st_size:
        return None
    source = pa.memory_map(str(path))
    try:
        stream = pa.ipc.open_stream(source)
        text = (stream.schema.metadata or {})[_HEADER_KEY].decode()
        return RunHeader.from_json(text, str(path)), stream, source
    except (pa.ArrowException, OSError, KeyError, UnicodeDecodeError, DataError):
        return None


def _next(stream: Any) -> Any:
    """Return the next whole batch, or ``None``."""
    import pyarrow as pa

    try:
        return stream.read_next_batch()
    except (StopIteration, pa.ArrowException, OSError):
        return None


def _gaps(syncs: Sequence[NDArray[np.int64]]) -> tuple[tuple[int, int], ...]:
    """Return the first missing SYNC and the count of each gap."""
    found = []
    before = int(syncs[0][0]) - 1
    for sync in syncs:
        steps = np.diff(sync, prepend=before)
        at = np.flatnonzero(steps > 1)
        found += [(int(sync[i] - steps[i] + 1), int(steps[i] - 1)) for i in at]
        before = int(sync[-1])
    return tuple(found)


def counts(samples: JournalSamples) -> Mapping[str, int]:
    """Return the counts of a journal, for the completion marker."""
    missing = sum(count for _, count in samples.gaps)
    return {
        "samples": samples.sample_count - missing,
        "missing": missing,
        "first_sync": samples.first_sync,
        "last_sync": samples.first_sync + samples.sample_count - 1,
    }
