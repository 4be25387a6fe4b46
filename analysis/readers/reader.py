"""One call that reads a recording of any kind."""

import math
from dataclasses import replace
from pathlib import Path

from analysis.readers.columns import ColumnMap
from analysis.readers.registry import find_reader, name_of
from analysis.readers.text_source import Progress
from analysis.recording import Recording
from hardware.description.errors import ConfigurationError, DataError


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
