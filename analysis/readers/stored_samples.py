"""Samples that stay in a NetCDF file until a stretch is asked for, and checks of the file before.

The stated shape of a variable costs a file no bytes, so it is held against what the file holds.
Texts and dimensions lie in heaps. HDF5 walks through the objects of a heap as soon as it reads one
of them, by the sizes that they state. At one that states to take no room it walks on the spot for
ever, and no signal reaches it. So the heaps are walked through before, by the sizes of lengths that
HDF5 writes unless told otherwise.
"""

import math
import struct
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO, Final

import numpy as np

from analysis.readers.checksums import BLOCK_SAMPLES
from analysis.readers.damage import stretches
from analysis.reading_limits import ReadingLimits, limits
from hardware.description.arrays import BoolArray, FloatArray
from hardware.description.dataset import EDGE_TIME
from hardware.description.errors import DataError

_MARK: Final = b"GCOL\x01\x00\x00\x00"  # of a heap, version 1
_HEAD: Final = struct.Struct("<8sQ")  # the mark and the heap's size
_OBJECT: Final = struct.Struct("<H6xQ")  # its number, 0 where the heap is free, and its size
_BLOCK: Final = 1 << 20  # bytes looked at in one go
_LARGEST: Final = 1 << 26  # bytes of a heap: usually 4096, or one long text
_PACKING: Final = 1032  # bytes of zeros that deflate keeps in one: more is not in the file
_LARGEST_CHUNK: Final = 1 << 26  # bytes, read whole for any of its samples; ours have 2^19


@dataclass(frozen=True)
class StoredSamples:
    """Samples of a file, which is open only while it is read, so that there is nothing to close.

    Attributes
    ----------
    variables
        The file's variables, one per row.
    identity
        Size and time of the file as it was opened: a file that changed since is refused.
    damaged
        Row to whether each of its blocks is damaged: those are never read, and NaN.
    """

    path: Path
    variables: tuple[str, ...]
    sample_count: int
    identity: tuple[int, int]
    damaged: tuple[BoolArray | None, ...]

    @property
    def shape(self) -> tuple[int, ...]:
        """``(channels, samples)``."""
        return (len(self.variables), self.sample_count)

    def __getitem__(self, key: tuple[slice | Sequence[int], slice], /) -> FloatArray:
        """Read some rows between two sample numbers, shape ``(rows, samples)``.

        Raises
        ------
        DataError
            If the file has changed, gone, or is damaged.
        """
        import h5py

        rows, span = key
        chosen = range(len(self.variables))[rows] if isinstance(rows, slice) else rows
        start, stop, step = span.indices(self.sample_count)
        if step < 1:
            raise ValueError(f"samples are read forwards, not by steps of {step}")
        values = np.full((len(chosen), max(0, stop - start)), np.nan)
        with reading(self.path):
            if identity(self.path) != self.identity:
                raise DataError(f"{self.path}: the file has changed since it was opened")
            with h5py.File(self.path, "r") as file:
                for target, row in zip(values, chosen, strict=True):
                    for a, b in self._good(row, start, stop):
                        part = np.s_[a - start : b - start]
                        file[self.variables[row]].read_direct(target, np.s_[a:b], part)
        return values[:, ::step]

    def _good(self, row: int, start: int, stop: int) -> Iterator[tuple[int, int]]:
        """Yield the undamaged stretches of a row between two sample numbers."""
        bad = self.damaged[row]
        full_row = [(0, self.sample_count)]
        for a, b in full_row if bad is None else stretches(~bad, BLOCK_SAMPLES, self.sample_count):
            if max(a, start) < min(b, stop):
                yield max(a, start), min(b, stop)


def identity(path: Path) -> tuple[int, int]:
    """Return what tells a file from a changed one."""
    status = path.stat()
    return status.st_size, status.st_mtime_ns


@contextmanager
def reading(path: Path) -> Iterator[None]:
    """Turn what the libraries say of a damaged file into a DataError of one sentence."""
    try:
        yield
    except (OSError, KeyError, RuntimeError, TypeError, ValueError) as error:
        raise DataError(f"{path}: {_what_is_wrong(path, str(error))}") from None


def _what_is_wrong(path: Path, message: str) -> str:
    try:
        with path.open("rb") as file:
            head = file.read(8)
    except OSError as error:
        return f"cannot be read: {error.strerror}"
    if not head:
        return "the file is empty"
    if head.startswith(b"CDF"):
        return "an older NetCDF 3 file; convert it with 'nccopy -k nc4'"
    if head != b"\x89HDF\r\n\x1a\n":
        return "not a NetCDF file"
    if "truncated" in message:
        return "the NetCDF file is cut short; copy it again"
    return f"the NetCDF file is damaged: {message}"


def check_heaps(path: Path) -> None:
    """Refuse a file with a heap that HDF5 would not come to the end of.

    Raises
    ------
    DataError
        With the place of the heap.
    """
    with path.open("rb") as file:
        for place in _marks(file):
            file.seek(place)
            size = _HEAD.unpack(file.read(_HEAD.size).ljust(_HEAD.size))[1]
            if _is_endless(file.read(max(0, min(size, _LARGEST) - _HEAD.size))):
                raise DataError(
                    f"{path}: the NetCDF file is damaged: its heap at byte {place} has no end"
                )


def _marks(file: BinaryIO) -> Iterator[int]:
    """Yield where heaps begin, also those that lie across two blocks."""
    place, tail = 0, b""
    while block := file.read(_BLOCK):
        data, at = tail + block, place - len(tail)
        offset = data.find(_MARK)
        while offset >= 0:
            yield at + offset
            offset = data.find(_MARK, offset + 1)
        place += len(block)
        tail = data[1 - len(_MARK) :]
        file.seek(place)


def _is_endless(heap: bytes) -> bool:
    """Tell whether an object takes no room; one that takes too much is refused by HDF5."""
    at = 0
    while at + _OBJECT.size <= len(heap):
        number, size = _OBJECT.unpack_from(heap, at)
        room = size if number == 0 else _OBJECT.size + (size + 7) // 8 * 8
        if room % (1 << 64) == 0:  # as HDF5 counts
            return True
        at += room
    return False


def check_declared(path: Path) -> None:
    """Refuse a file whose variables are larger than what lies in it, before any is read.

    Raises
    ------
    DataError
        With the variable, what it says and what is there.
    """
    import h5py

    allowed = limits()
    with h5py.File(path, "r") as file:
        for name, item in file.items():
            if isinstance(item, h5py.Dataset):
                _check(item, f"{path}: the variable {name!r}", allowed)


def _check(variable: Any, where: str, allowed: ReadingLimits) -> None:
    stored, chunk = (
        variable.id.get_storage_size(),
        math.prod(variable.chunks or ()) * variable.dtype.itemsize,
    )
    if variable.chunks and chunk > _LARGEST_CHUNK:
        raise allowed.too_large(where, f"its chunks of {chunk} bytes, where 2^26 are the most")
    if variable.nbytes > max(allowed.memory_bytes / 4.0, _PACKING * stored):
        raise allowed.too_large(
            where, f"it says {variable.nbytes} bytes, of which {stored} are there"
        )
    if variable.ndim and variable.name == f"/{EDGE_TIME}":
        allowed.check_rows(variable.shape[0], 1, where)
