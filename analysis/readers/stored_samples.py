"""Samples that stay in a NetCDF file until a stretch of them is asked for."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from analysis.readers.checksums import BLOCK_SAMPLES
from analysis.readers.damage import stretches
from hardware.description.arrays import BoolArray, FloatArray
from hardware.description.errors import DataError


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

        rows, when = key
        chosen = range(len(self.variables))[rows] if isinstance(rows, slice) else rows
        start, stop, step = when.indices(self.sample_count)
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
        whole = [(0, self.sample_count)]
        for a, b in whole if bad is None else stretches(~bad, BLOCK_SAMPLES, self.sample_count):
            if max(a, start) < min(b, stop):
                yield max(a, start), min(b, stop)


def identity(path: Path) -> tuple[int, int]:
    """Return what tells a file from a changed one."""
    status = path.stat()
    return status.st_size, status.st_mtime_ns


@contextmanager
def reading(path: Path) -> Iterator[None]:
    """Turn what the libraries say of a bad file into one clear word."""
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
