"""The readers of recordings: entry points ``pmm.readers``, and one call that reads any kind."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from typing import Final

from analysis.readers.columns import ColumnMap
from analysis.readers.text_source import Progress
from analysis.recording import Recording
from hardware.description.errors import ConfigurationError, DataError

GROUP: Final = "pmm.readers"
_PACKED: Final = ".gz"


@dataclass(frozen=True)
class Reader:
    """A reader, as its entry point presents it; its name there is the end of its files' names.

    Attributes
    ----------
    read
        Makes a recording of a path, a column map, the recording's name and what is told the part
        that has been read, from 0 to 1.
    own_channels
        Whether the file says its own channels, units and rate, so that it takes no column map.
    text
        Whether the file is text, which is read from gzip too.
    """

    read: Callable[[Path, ColumnMap, str, Progress], Recording]
    own_channels: bool = False
    text: bool = False


def find_reader(path: Path) -> Reader:
    """Return the reader of a file, told from its name.

    Raises
    ------
    DataError
        If the kind of file is not known; the message lists the known ones.
    ConfigurationError
        If the reader's package cannot be loaded.
    """
    plain = _unpacked(path)
    ending = plain.suffix.lower().removeprefix(".")
    reader = _load(_entry_points()[ending]) if ending in _entry_points() else None
    if reader is None or not (reader.text or plain is path):
        endings = ", ".join(f".{ending}" for ending in _entry_points())
        raise DataError(
            f"{path}: the kind of file is not known; its name should end in {endings}, or in "
            "that of a text file with .gz behind"
        )
    return reader


def name_of(path: Path) -> str:
    """Return what a recording in a file is called: the file's name without its endings."""
    return _unpacked(path).stem


def text_endings() -> tuple[str, ...]:
    """Return what names of text files end in, packed ones among them."""
    texts = [f".{name}" for name, entry in _entry_points().items() if _load(entry).text]
    return tuple(f"{ending}{packed}" for ending in texts for packed in ("", _PACKED))


def _unpacked(path: Path) -> Path:
    return path.with_suffix("") if path.suffix.lower() == _PACKED else path


@cache
def _entry_points() -> Mapping[str, EntryPoint]:
    return {entry_point.name: entry_point for entry_point in entry_points(group=GROUP)}


def _load(entry: EntryPoint) -> Reader:
    try:
        reader = entry.load()
    except Exception as error:  # a foreign package may raise anything while it is imported
        raise ConfigurationError(
            f"the reader of .{entry.name} files, {entry.value}, cannot be loaded: {error}"
        ) from error
    if not isinstance(reader, Reader):
        raise ConfigurationError(f"{entry.value} is no analysis.readers.reader.Reader")
    return reader


def read_recording(
    path: str | Path,
    columns: ColumnMap | None = None,
    *,
    sample_rate_hz: float | None = None,
    progress: Progress = lambda _: None,
) -> Recording:
    """Read a recording: ``.nc`` as this project writes it, text, plain or gzip, MAT or TDMS.

    Samples come in SI units on an even grid. What was noticed or repaired is in ``flags``; their
    codes are in ``docs/formats.md``. Samples of a NetCDF file stay on disk until they are sliced.

    Parameters
    ----------
    columns
        Which column of a text file (variable of a MAT, channel of a TDMS file) is what; ``None``
        believes its headers.
    sample_rate_hz
        Rate of these files' samples, in place of their time column, if they have one.
    progress
        Told which part of a text file has been read, from 0 to 1.

    Raises
    ------
    DataError
        If the file is missing, empty, cut short, of an unknown kind, or its content cannot be taken
        for a recording; the message names the file and the line, row or column.
    ConfigurationError
        If a column map or a sample rate is given that cannot be.
    """
    path = Path(path)
    _check_there(path)
    reader = find_reader(path)
    if reader.own_channels and (columns is not None or sample_rate_hz is not None):
        raise ConfigurationError(
            f"{path}: a {path.suffix} recording says its own channels and rate; "
            "leave out the column map and the sample rate"
        )
    columns = columns or ColumnMap(origin="headers")
    if sample_rate_hz is not None:
        columns = replace(columns, sample_rate_hz=sample_rate_hz)
    rate = columns.sample_rate_hz
    if rate is not None and not (math.isfinite(rate) and rate > 0.0):
        raise ConfigurationError(f"{path}: a sample rate of {rate:g} Hz; it should be above 0")
    return reader.read(path, columns, name_of(path), progress)


def _check_there(path: Path) -> None:
    if path.is_dir():
        raise DataError(f"{path}: a folder, not a recording")
    if not path.exists():
        raise DataError(f"{path}: no such file" + ("" if path.suffix else " or folder"))
    if not path.stat().st_size:
        raise DataError(f"{path}: the file is empty")
