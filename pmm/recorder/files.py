"""The files of a run's folder, and how one is written whole or not at all."""

import hashlib
import os
import sys
from pathlib import Path
from typing import Final

from hardware.description.errors import DataError

HEADER: Final = "header.json"
SAMPLES: Final = "samples.arrows"
BUS: Final = "bus.blf"
PULSES: Final = "pulses.jsonl"
EVENTS: Final = "events.jsonl"
HARMONICS: Final = "harmonics.jsonl"
LINES: Final = "lines.jsonl"
CYCLES: Final = "cycles.jsonl"
MARKER: Final = "complete.json"
RECORDING: Final = "run.nc"
RECOVERED: Final = "recovered.json"
STREAMS: Final = (SAMPLES, BUS, PULSES, EVENTS, HARMONICS, LINES, CYCLES)
_OURS: Final = (HEADER, *STREAMS, MARKER, RECORDING, RECOVERED)
_CHUNK: Final = 2**20


class RunExistsError(DataError):
    """The folder holds a run already: nothing is ever recorded over it."""


class BeingRecordedError(DataError):
    """A process is recording into the folder at this moment."""


def is_run(folder: Path) -> bool:
    """Tell whether a folder holds a run, or what a crash left of one."""
    return any((folder / name).exists() for name in (HEADER, *STREAMS))


def check_empty(folder: Path) -> None:
    """Refuse a folder that holds a run.

    Raises
    ------
    RunExistsError
        If it does; the message names what is there.
    """
    there = [name for name in _OURS if (folder / name).exists()]
    if there:
        raise RunExistsError(
            f"{folder}: holds a run already ({', '.join(there)}); it is never overwritten. Record "
            "to another folder, or move this one away"
        )


def write_whole(path: Path, text: str) -> None:
    """Write a text file so that it is there whole, on the disk, or not at all."""
    part = path.with_name(f".{path.name}.part")
    with part.open("w", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    part.replace(path)
    sync_folder(path.parent)


def set_aside(path: Path) -> None:
    """Give a file that cannot be read another name, if it is there: its bytes are kept."""
    if not path.exists():
        return
    number = 1
    while (other := path.with_name(f"{path.name}.damaged-{number}")).exists():
        number += 1
    path.rename(other)


def sync_folder(folder: Path) -> None:
    """Bring the names in a folder to the disk, where the system can."""
    if sys.platform == "win32":
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def sync_data(handle: int) -> None:
    """Bring a file's data to the disk."""
    getattr(os, "fdatasync", os.fsync)(handle)


def sha256(path: Path) -> str:
    """Return a file's hash."""
    found = hashlib.sha256()
    with path.open("rb") as file:
        while piece := file.read(_CHUNK):
            found.update(piece)
    return found.hexdigest()


def lock(handle: int, folder: Path) -> None:
    """Keep others from taking the run of an open file for one that a crash left.

    The lock ends with the process, however it ends. Where system or disk have none, nothing is
    done.

    Raises
    ------
    BeingRecordedError
        If another process holds it.
    """
    if sys.platform == "win32":
        return
    import fcntl

    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as error:
        raise BeingRecordedError(
            f"{folder}: a process is recording into it; recover it when that has ended"
        ) from error
    except OSError:
        return  # a network drive without locks
