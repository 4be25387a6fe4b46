"""Recordings as NetCDF4 files: written whole, read a stretch at a time."""

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from analysis.readers.attributes import (
    channel_attributes,
    channel_names,
    check_storable,
    check_time,
    parse_channel,
    parse_run,
    run_attributes,
)
from analysis.recording import FloatArray, Recording
from hardware.description import dataset as schema
from hardware.description.errors import DataError

# Half a megabyte of one channel: small beside any memory, large beside a disk's seek.
CHUNK_SAMPLES = 65536
# Samples that are copied or checked at a time.
BLOCK_SAMPLES = 2 * CHUNK_SAMPLES


@dataclass(frozen=True)
class StoredSamples:
    """Samples that stay in their file until a stretch of them is asked for.

    The file is open only while it is read, so there is nothing to close.

    Attributes
    ----------
    variables
        The file's variables, one per row.
    identity
        Size and time of the file as it was opened: a file that changed since is refused.
    """

    path: Path
    variables: tuple[str, ...]
    sample_count: int
    identity: tuple[int, int]

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
        names = self.variables[rows] if isinstance(rows, slice) else self._named(rows)
        start, stop, step = when.indices(self.sample_count)
        if step < 1:
            raise ValueError(f"samples are read forwards, not by steps of {step}")
        values = np.empty((len(names), len(range(start, stop, step))))
        with _reading(self.path):
            if _identity(self.path) != self.identity:
                raise DataError(f"{self.path}: the file has changed since it was opened")
            with h5py.File(self.path, "r") as file:
                for row, name in zip(values, names, strict=True):
                    if row.size:
                        file[name].read_direct(row, np.s_[start:stop:step])
        return values

    def _named(self, rows: Sequence[int]) -> tuple[str, ...]:
        return tuple(self.variables[row] for row in rows)


def read_netcdf(path: Path) -> Recording:
    """Open a recording; its samples stay on disk. See :func:`analysis.readers.read_recording`."""
    import h5netcdf

    where = str(path)
    with _reading(path), h5netcdf.File(path, "r", phony_dims="sort") as file:
        variables = dict(file.variables)
        dimensions = {name: tuple(variable.dimensions) for name, variable in variables.items()}
        names = channel_names(dimensions, where)
        channels = tuple(parse_channel(name, variables[name].attrs, where) for name in names)
        time, edges = variables[schema.TIME], variables.get(schema.EDGE_TIME)
        samples = StoredSamples(path, names, int(time.shape[0]), _identity(path))
        start_s = float(time[0]) if samples.sample_count else 0.0
        edges_s = None if edges is None else np.asarray(edges[:], dtype=np.float64)
        recording = parse_run(file.attrs, channels, samples, start_s, edges_s, where)
        for start, stop in _blocks(samples.sample_count):
            check_time(np.asarray(time[start:stop], np.float64), recording, start, where)
    return recording


def write_recording(recording: Recording, path: str | Path, *, overwrite: bool = False) -> Path:
    """Write a recording as NetCDF4, as :mod:`hardware.description.dataset` says.

    It is written beside its place under a temporary name and then renamed, so that a half written
    file never bears a recording's name. Lazily read samples are copied a stretch at a time.

    Raises
    ------
    DataError
        If the file exists and ``overwrite`` is not set, cannot be written, or the recording cannot
        be kept (see :func:`to_dataset`).
    """
    path = Path(path)
    check_storable(recording)
    if path.suffix != ".nc":
        raise DataError(f"{path}: a recording is kept as NetCDF; end the name with .nc")
    _refuse_existing(path, overwrite)
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        _write(recording, part)
        _refuse_existing(path, overwrite)
        part.replace(path)
    except OSError as error:
        raise DataError(f"{path}: cannot write the recording: {error}") from None
    finally:
        part.unlink(missing_ok=True)
    return path


def _refuse_existing(path: Path, overwrite: bool) -> None:
    if path.exists() and not overwrite:
        raise DataError(f"{path}: exists already; choose another name, or ask to overwrite it")


def _write(recording: Recording, path: Path) -> None:
    import h5netcdf

    count, edges = recording.sample_count, recording.photocell_edges_s
    with h5netcdf.File(path, "w") as file:
        file.dimensions[schema.TIME] = count
        file.attrs.update(run_attributes(recording))
        time = _variable(file, schema.TIME, {schema.UNITS: "s"}, count)
        variables = [
            _variable(file, channel.name, channel_attributes(channel), count)
            for channel in recording.channels
        ]
        for start, stop in _blocks(count):
            time[start:stop] = recording.time_s(start, stop)
            values = recording.samples[:, start:stop]
            for variable, row in zip(variables, values, strict=True):
                variable[start:stop] = row
        if edges is not None:
            file.dimensions[schema.EDGE] = len(edges)
            stored = file.create_variable(schema.EDGE_TIME, (schema.EDGE,), np.float64)
            stored.attrs[schema.UNITS] = "s"
            if len(edges):
                stored[:] = edges
    with path.open("rb+") as file:
        os.fsync(file.fileno())


def _variable(file: Any, name: str, attributes: dict[str, str | float], count: int) -> Any:
    variable = file.create_variable(
        name, (schema.TIME,), np.float64, chunks=(min(count, CHUNK_SAMPLES),)
    )
    variable.attrs.update(attributes)
    return variable


def _blocks(count: int) -> Iterator[tuple[int, int]]:
    for start in range(0, count, BLOCK_SAMPLES):
        yield start, min(start + BLOCK_SAMPLES, count)


def _identity(path: Path) -> tuple[int, int]:
    status = path.stat()
    return status.st_size, status.st_mtime_ns


@contextmanager
def _reading(path: Path) -> Iterator[None]:
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
