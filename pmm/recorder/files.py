"""The files of a run's folder."""

import hashlib
import os
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
TEXTS: Final = (PULSES, EVENTS, HARMONICS, LINES, CYCLES)
STREAMS: Final = (SAMPLES, BUS, *TEXTS)
_OURS: Final = (HEADER, *STREAMS, MARKER, RECORDING, RECOVERED)


class RunExistsError(DataError):
    """The folder holds a run already: nothing is ever recorded over it."""


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
    names = [name for name in _OURS if (folder / name).exists()]
    if names:
        raise RunExistsError(
            f"{folder}: holds a run already ({', '.join(names)}); it is never overwritten. Record "
            "to another folder, or move this one away"
        )


def free_name(path: Path, mark: str) -> Path:
    """Return the first name beside a path's that nothing has: the mark and a number behind it."""
    number = 1
    while (free := path.with_name(f"{path.name}.{mark}{number}")).exists():
        number += 1
    return free


def set_aside(path: Path, mark: str = "damaged-") -> None:
    """Give another name to what is there and must not be there any more: nothing is lost."""
    if path.exists():
        path.rename(free_name(path, mark))


def sync_data(handle: int) -> None:
    """Bring a file's data to the disk."""
    getattr(os, "fdatasync", os.fsync)(handle)


def contents_of(path: Path) -> dict[str, int | str]:
    """Return a file's size and hash, as the completion marker keeps them."""
    return {"bytes": path.stat().st_size, "sha256": sha256(path)}


def sha256(path: Path) -> str:
    """Return a file's SHA-256, 64 hexadecimal digits; raises OSError if it cannot be read."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
