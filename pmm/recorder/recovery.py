"""Makes a recording of whatever a crash left of a run. Nothing that is there is ever destroyed."""

import json
import os
from collections.abc import Iterable, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity
from hardware.raw_log import LogState, look
from pmm.recorder.files import (
    BUS,
    MARKER,
    RECORDING,
    RECOVERED,
    SAMPLES,
    is_run,
    lock,
    set_aside,
    write_whole,
)
from pmm.recorder.rebuilding import rebuild
from pmm.recorder.recording import RunData, convert, read_run
from pmm.recorder.samples import counts

if TYPE_CHECKING:
    from collections.abc import Iterator


@dataclass(frozen=True)
class RecoveredRun:
    """What was made of a run.

    Attributes
    ----------
    path
        The recording.
    samples, missing
        Samples of each channel; SYNCs between the first and the last that are not there (NaN).
    frames
        Whole frames of the raw log.
    lost_tail_bytes
        Bytes at the ends of files that are not whole, by file.
    was_whole
        Whether the run had been closed and its recording was there: nothing was to do.
    flags
        What was noticed.
    """

    path: Path
    samples: int
    missing: int
    frames: int
    lost_tail_bytes: Mapping[str, int]
    was_whole: bool
    flags: tuple[Flag, ...]


def runs_in(place: Path) -> tuple[Path, ...]:
    """Return the folders of runs: the place itself, or those in a campaign's folder, by name.

    Raises
    ------
    DataError
        If there are none.
    """
    if is_run(place):
        return (place,)
    found = sorted(one for one in place.iterdir() if is_run(one)) if place.is_dir() else []
    if not found:
        raise DataError(f"{place}: holds no run: no {SAMPLES}, {BUS} or header in it or below it")
    return tuple(found)


def recover(folder: Path, drivers: Iterable[EntryPoint] | None = None) -> RecoveredRun:
    """Make a recording of a run's folder, however the run ended; the same again does nothing.

    Where nothing of the samples' journal is whole, it is decoded again from the raw log.

    Parameters
    ----------
    drivers
        Where the rig's drivers are looked for then; all installed ones by default.

    Raises
    ------
    BeingRecordedError
        If a process is recording into it.
    DataError
        If there is no whole sample in it, and none to be decoded.
    DiskFullError
        If there is no room for the recording.
    """
    with _alone(folder):
        run = read_run(folder)
        log = look(folder / BUS) if (folder / BUS).exists() else LogState(0, 0)
        if (folder / RECORDING).exists() and _readable(folder / RECORDING):
            return _outcome(run, log, _flags_before(folder), was_whole=run.marker is not None)
        flags = _flags(run, log)
        if run.samples is None:
            flags += (rebuild(run, drivers),)
            run = read_run(folder)
        set_aside(folder / RECORDING)
        convert(run, flags)
        outcome = _outcome(run, log, flags, was_whole=False)
        write_whole(folder / RECOVERED, _text(outcome))
        return outcome


@contextmanager
def _alone(folder: Path) -> "Iterator[None]":
    """Hold the run's lock, so that neither its recorder nor another recovery is at it."""
    if not (folder / SAMPLES).exists():
        yield
        return
    handle = os.open(folder / SAMPLES, os.O_RDONLY)
    try:
        lock(handle, folder)
        yield
    finally:
        os.close(handle)


def _readable(path: Path) -> bool:
    from analysis.readers import read_recording

    try:
        return read_recording(path).sample_count > 0
    except DataError:
        return False


def _flags(run: RunData, log: LogState) -> tuple[Flag, ...]:
    """Return what the recovery itself noticed."""
    if run.marker is not None:
        return tuple(_cut(run, run.marker))
    tails = {name: size for name, size in {**run.tails, BUS: log.tail_bytes}.items() if size}
    torn = ", ".join(f"{size} bytes of {name}" for name, size in tails.items()) or "nothing"
    message = (
        f"the run was not closed ({MARKER} is missing); made of its journals up to the last whole "
        f"batch; not whole: {torn}"
    )
    return (Flag("recovered", Severity.WARNING, message),)


def _cut(run: RunData, marker: Mapping[str, Any]) -> "Iterator[Flag]":
    """Yield a flag for each file of a closed run that is shorter than its marker says."""
    for name, about in marker["files"].items():
        path = run.folder / name
        size = path.stat().st_size if path.exists() else 0
        if size < about["bytes"]:
            message = f"{name} has {size} of {about['bytes']} bytes; it was cut after the run"
            yield Flag("journal_cut", Severity.WARNING, message)


def _outcome(
    run: RunData, log: LogState, flags: tuple[Flag, ...], *, was_whole: bool
) -> RecoveredRun:
    found = counts(run.samples) if run.samples else {"samples": 0, "missing": 0}
    return RecoveredRun(
        run.folder / RECORDING,
        found["samples"],
        found["missing"],
        log.frames,
        {name: size for name, size in {**run.tails, BUS: log.tail_bytes}.items() if size},
        was_whole,
        flags,
    )


def _text(outcome: RecoveredRun) -> str:
    return json.dumps({**asdict(outcome), "path": outcome.path.name}, indent=1)


def _flags_before(folder: Path) -> tuple[Flag, ...]:
    """Return what an earlier recovery noticed."""
    if not (folder / RECOVERED).exists():
        return ()
    told = json.loads((folder / RECOVERED).read_text(encoding="utf-8"))["flags"]
    return tuple(Flag(**{**one, "severity": Severity(one["severity"])}) for one in told)
