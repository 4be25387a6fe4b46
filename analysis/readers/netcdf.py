"""Recordings as NetCDF4 files: written whole, read a stretch at a time."""

import errno
import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, BinaryIO, Final

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
from analysis.readers.checksums import BLOCK_SAMPLES, KIND, Summing
from analysis.readers.conditioning import without_spikes
from analysis.readers.damage import Damage, find_damage
from analysis.readers.missing_values import with_missing_said
from analysis.readers.netcdf_group import NetcdfGroup, describe
from analysis.readers.reader import Reader
from analysis.readers.stored_samples import (
    StoredSamples,
    check_declared,
    check_heaps,
    identity,
    reading,
)
from analysis.recording import Recording
from hardware.description import dataset as schema
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from hardware.description.room import file_error_text

_CANNOT: Final = {errno.EOPNOTSUPP, errno.ENOSYS, errno.EINVAL}  # not every disk can take room


@dataclass(frozen=True)
class Reserved:
    """A new, empty file and the room that it will need at most."""

    file: BinaryIO
    size_bytes: int

    def take(self) -> None:
        """Take the room.

        Raises
        ------
        OSError
            If there is not so much.
        """
        if not hasattr(os, "posix_fallocate"):
            return
        try:
            os.posix_fallocate(self.file.fileno(), 0, self.size_bytes)
        except OSError as error:
            if error.errno not in _CANNOT:
                raise


@contextmanager
def reserved(path: Path, size_bytes: int) -> Iterator[Reserved]:
    """Open a new file for which there is room, and bring it to the disk at the end.

    HDF5 does not outlive a disk that fills up under it: it takes the process with it. It begins
    with an empty file, so the room is tried first, and taken for good once HDF5 has begun.

    Raises
    ------
    OSError
        If there is no room; nothing is written then.
    """
    with path.open("wb+") as file:
        opened = Reserved(file, size_bytes)
        opened.take()
        file.truncate(0)
        yield opened
        file.flush()
        os.fsync(file.fileno())


# Half a megabyte of one channel: small beside any memory, large beside a disk's seek.
CHUNK_SAMPLES = 64 * BLOCK_SAMPLES
# Samples that are copied or checked at a time.
STRETCH_SAMPLES = 2 * CHUNK_SAMPLES
_BOOKS_BYTES = 32768  # what HDF5 keeps beside the samples of a variable: measured 2 to 8 kB


def read_netcdf(path: Path) -> Recording:
    """Open a recording; its samples stay on disk, but for the few in the place of spikes.

    See :func:`analysis.readers.read_recording`.
    """
    import h5netcdf

    where = str(path)
    with reading(path):
        check_heaps(path)
        check_declared(path)
    with reading(path), h5netcdf.File(path, "r", phony_dims="sort") as file:
        variables = dict(file.variables)
        dimensions = {name: tuple(variable.dimensions) for name, variable in variables.items()}
        names = channel_names(dimensions, where)
        channels = tuple(parse_channel(name, variables[name].attrs, where) for name in names)
        damage = find_damage(path, names)
        time, edges = variables[schema.TIME], variables.get(schema.EDGE_TIME)
        bad = tuple(damage.blocks.get(name) for name in names)
        samples = StoredSamples(path, names, int(time.shape[0]), identity(path), bad)
        edges_s = None if edges is None else _edges_s(edges, damage)
        recording = parse_run(file.attrs, channels, samples, 0.0, edges_s, where)
        recording = _timed(recording, time, damage, where)
        flags = damage.all_flags(recording, 0 if edges is None else int(edges.shape[0]))
        recording = replace(recording, flags=(*recording.flags, *flags))
    return without_spikes(with_missing_said(recording))


def read_span(path: Path) -> tuple[str, float]:
    """Return when a recording was begun, UTC as text, and its length in s; no sample is read.

    The text is empty where the recording does not say.

    Raises
    ------
    DataError
        If it is no such file.
    """
    import h5netcdf

    with reading(path), h5netcdf.File(path, "r", phony_dims="sort") as file:
        time = file.variables[schema.TIME]
        told = json.loads(file.attrs.get(schema.ATTR_PROVENANCE, "{}"))
        started = told.get("started_utc", "") if isinstance(told, dict) else ""
        return str(started), float(time[-1]) - float(time[0])


READER: Final = Reader(lambda path, *_: read_netcdf(path), own_channels=True)


def _edges_s(edges: Any, damage: Damage) -> FloatArray:
    """Read the photocell's pulses but for the damaged ones."""
    stretches = [
        np.asarray(edges[a:b], dtype=np.float64)
        for a, b in damage.good(schema.EDGE_TIME, int(edges.shape[0]))
    ]
    return np.concatenate([np.empty(0), *stretches])


def _timed(recording: Recording, time: Any, damage: Damage, where: str) -> Recording:
    """Return the recording at its time, which is checked where it is not damaged."""
    good = damage.good(schema.TIME, recording.sample_count)
    first = good[0][0]
    recording = replace(recording, start_s=float(time[first]) - first / recording.sample_rate_hz)
    for a, b in good:
        for start, stop in _stretches(a, b):
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
        raise DataError(f"{file_error_text(error, path)}; the recording is not written") from None
    finally:
        part.unlink(missing_ok=True)
    return path


def _refuse_existing(path: Path, overwrite: bool) -> None:
    if path.exists() and not overwrite:
        raise DataError(f"{path}: exists already; choose another name, or ask to overwrite it")


def _write(recording: Recording, path: Path) -> None:
    import h5py

    count, edges = recording.sample_count, recording.photocell_edges_s
    most, chunk = _most_bytes(recording), min(recording.sample_count, CHUNK_SAMPLES)
    with reserved(path, most) as room, h5py.File(room.file, "w", track_order=True) as file:
        room.take()
        group = NetcdfGroup(file)
        describe(file, run_attributes(recording) | {schema.ATTR_CHECKSUMS: KIND})
        variables = [group.coordinate(schema.TIME, count, chunk)]
        describe(variables[0], {schema.UNITS: "s"})
        for channel in recording.channels:
            made = group.variable(channel.name, (schema.TIME,), np.float64, chunk)
            describe(made, channel_attributes(channel))
            variables.append(made)
        sums = Summing()
        for start, stop in _stretches(0, count):
            values = np.vstack([recording.time_s(start, stop), recording.samples[:, start:stop]])
            for variable, row in zip(variables, values, strict=True):
                variable[start:stop] = row
                sums.take(variable, row)
        if edges is not None:
            group.dimension(schema.EDGE, len(edges))
            stored = group.variable(schema.EDGE_TIME, (schema.EDGE,), np.float64)
            describe(stored, {schema.UNITS: "s"})
            stored[:] = edges
            sums.take(stored, edges)
        sums.finish(group)


def _most_bytes(recording: Recording) -> int:
    """Return what the file takes at most: whole chunks, attributes, and HDF5's own books."""
    count, rows = recording.sample_count, len(recording.channels) + 1
    chunk = max(1, min(count, CHUNK_SAMPLES))
    edges = recording.photocell_edges_s
    sums = rows * -(-count // BLOCK_SAMPLES)
    values = rows * -(-count // chunk) * chunk + sums + (0 if edges is None else 2 * len(edges))
    texts = sum(len(str(value).encode()) for value in run_attributes(recording).values())
    return 8 * values + 2 * texts + 2 * (rows + 2) * _BOOKS_BYTES


def _stretches(first: int, end: int) -> Iterator[tuple[int, int]]:
    for start in range(first, end, STRETCH_SAMPLES):
        yield start, min(start + STRETCH_SAMPLES, end)
