"""A recording of what a binary file of another program holds: columns, units, perhaps a rate."""

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

from analysis.foreign.columns import ForeignColumns
from analysis.foreign.process import read_foreign
from analysis.readers.columns import ColumnMap
from analysis.readers.headers import Header, parse_header
from analysis.readers.reader import Reader
from analysis.readers.text_plan import plan_columns
from analysis.readers.text_recording import Origin, from_columns
from analysis.readers.text_source import Progress
from analysis.recording import Recording
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.flags import Flag, Severity
from hardware.description.version import installing

_REMEDY = (
    "export them with a column of times, or give the sample rate if they were sampled together"
)


def foreign_reader(
    kind: str, read: Callable[[Path], ForeignColumns], package: str | None = None
) -> Reader:
    """Return a reader of binary files that takes the columns as long as most of a file is.

    It raises DataError if the file cannot be read, holds no column of numbers, or neither times nor
    a rate; ConfigurationError if the column map names what is not there, or the package is missing.

    Parameters
    ----------
    kind
        As messages and the recording's provenance say it; also the extra that brings ``package``.
    read
        A function of a module, called in a process of its own, which imports that module.
    package
        What ``read`` imports that is not always there.
    """

    def recording(path: Path, columns: ColumnMap, name: str, _: Progress) -> Recording:
        if package is not None and find_spec(package) is None:
            raise ConfigurationError(
                f"{path}: reading {kind.upper()} needs the extra {kind!r}: {installing(kind)}"
            )
        content = read_foreign(path, kind, f"{read.__module__}:{read.__qualname__}")
        return _recording_of(content, path, columns, name, kind)

    return Reader(recording)


def _recording_of(
    content: ForeignColumns, path: Path, columns: ColumnMap, name: str, kind: str
) -> Recording:
    if not content.values:
        raise DataError(
            f"{path}: no vector of numbers in it; there is nothing to take for a channel"
        )
    length = max(map(len, content.values.values()))
    columns_kept = {key: values for key, values in content.values.items() if len(values) == length}
    headers = tuple(_header(k, key, content.units) for k, key in enumerate(columns_kept, 1))
    table = dict(zip(headers, columns_kept.values(), strict=True))
    if columns.sample_rate_hz is None and not _has_time(headers, columns):
        if content.no_rate:
            raise DataError(f"{path}: {content.no_rate}; {_REMEDY}")
        columns = replace(columns, sample_rate_hz=content.sample_rate_hz)
    plan = plan_columns(headers, columns, str(path))
    with path.open("rb") as file:
        origin = Origin(path, name, kind, hashlib.file_digest(file, "sha256").hexdigest())
    shorter = [key for key in content.values if key not in columns_kept]
    return from_columns(plan, table, columns, origin, _left_out(shorter, length))


def _has_time(headers: tuple[Header, ...], columns: ColumnMap) -> bool:
    return columns.time is not None or any(header.is_time for header in headers)


def _header(number: int, name: str, units: Mapping[str, str]) -> Header:
    """Return a header; the unit that the file states goes before one in the name."""
    parsed = parse_header(number, name)
    unit = units.get(name, "").strip()
    return parsed if not unit else replace(parsed, unit=unit, unit_is_suffix=False, name=name)


def _left_out(names: list[str], length: int) -> tuple[Flag, ...]:
    if not names:
        return ()
    text = f"{', '.join(names)}: not of {length} samples, as the longest of the file are; left out"
    return (Flag("other_length", Severity.WARNING, text),)
