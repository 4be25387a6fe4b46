"""Columns of numbers from a file that is no text: names, units, and a rate where it has one."""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from analysis.readers.columns import ColumnMap
from analysis.readers.headers import Header, parse_header
from analysis.readers.text_plan import plan_columns
from analysis.readers.text_recording import Origin, from_columns
from analysis.recording import FloatArray, Recording
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity


@dataclass(frozen=True, eq=False)
class ForeignColumns:
    """What was found in a file.

    Attributes
    ----------
    values
        By name; they need not be of one length.
    units
        By name, where the file states one.
    sample_rate_hz
        Where the file states it; a time column goes before it.
    """

    values: Mapping[str, FloatArray]
    units: Mapping[str, str]
    sample_rate_hz: float | None = None


def recording_of(
    path: Path, columns: ColumnMap, name: str, reader: str, found: ForeignColumns
) -> Recording:
    """Return a recording of the columns that are as long as most of the file is.

    Raises
    ------
    DataError
        If the file holds no column of numbers, or neither times nor a rate.
    ConfigurationError
        If the column map names what is not there.
    """
    if not found.values:
        raise DataError(
            f"{path}: no vector of numbers in it; there is nothing to take for a channel"
        )
    length = max(map(len, found.values.values()))
    kept = {key: values for key, values in found.values.items() if len(values) == length}
    headers = tuple(_header(k, key, found.units) for k, key in enumerate(kept, 1))
    table = dict(zip(headers, kept.values(), strict=True))
    if columns.sample_rate_hz is None and not _has_time(headers, columns):
        columns = replace(columns, sample_rate_hz=found.sample_rate_hz)
    plan = plan_columns(headers, columns, str(path))
    origin = Origin(path, name, reader, hashlib.sha256(path.read_bytes()).hexdigest())
    left = [key for key in found.values if key not in kept]
    return from_columns(plan, table, columns, origin, _left_out(left, length))


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
