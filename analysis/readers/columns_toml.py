"""Column maps from TOML, with all errors of a file in one message."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from difflib import get_close_matches
from pathlib import Path
from typing import TypeGuard

from analysis.readers.columns import (
    ChannelColumn,
    ColumnMap,
    Edge,
    PhotocellColumn,
    TextLayout,
    TimeColumn,
)
from analysis.readers.columns_options import parse_source
from hardware.description.errors import ConfigurationError
from hardware.description.toml import parse_toml
from hardware.description.units import unit


class TomlTable:
    """Keys of one table, checked as they are taken.

    Every method returns ``None`` for an absent key and for a wrong value, and notes the latter in
    ``faults``, which the tables of a file share: so one message tells all errors of the file.
    """

    def __init__(self, table: Mapping[str, object], where: str, faults: list[str]) -> None:
        self.table, self.where, self.faults = table, where, faults
        self.known: list[str] = []

    def fault(self, key: str, message: str) -> None:
        """Note what is wrong with a key."""
        self.faults.append(f"{self.where}{key} {message}")

    def get(self, key: str) -> object:
        """Return whatever stands at a key."""
        self.known.append(key)
        return self.table.get(key)

    def text(self, key: str) -> str | None:
        """Return text that is not empty."""
        value = self.get(key)
        if value is None or (isinstance(value, str) and value):
            return value
        self.fault(key, f"= {value!r} should be text")
        return None

    def flag(self, key: str) -> bool | None:
        """Return true or false."""
        value = self.get(key)
        if value is None or isinstance(value, bool):
            return value
        self.fault(key, f"= {value!r} should be true or false")
        return None

    def number(self, key: str, *, positive: bool = False) -> float | None:
        """Return a finite number."""
        value = self.get(key)
        if value is None:
            return None
        if is_number(value) and (not positive or value > 0):
            return float(value)
        self.fault(key, f"= {value!r} should be a {'positive' if positive else 'finite'} number")
        return None

    def whole_number(self, key: str) -> int | None:
        """Return a whole number from 0 up."""
        value = self.get(key)
        if value is None or (isinstance(value, int) and value is not True and value >= 0):
            return value
        self.fault(key, f"= {value!r} should be a whole number, 0 or more")
        return None

    def unit(self, key: str) -> str | None:
        """Return the name of a known unit."""
        name = self.text(key)
        try:
            if name is not None:
                unit(name)
        except ConfigurationError as error:
            self.fault(key, f"= {error}")
        return name

    def one_of(self, key: str, choices: tuple[str, ...]) -> str | None:
        """Return one of some words."""
        value = self.get(key)
        if value is None or (isinstance(value, str) and value in choices):
            return value
        self.fault(key, f"= {value!r} should be one of {', '.join(map(repr, choices))}")
        return None

    def finish(self) -> None:
        """Note the keys that nobody took, each with the known key it resembles."""
        for key in self.table:
            if key not in self.known:
                matches = get_close_matches(key, self.known, n=1, cutoff=0.5)
                hint = (
                    f"did you mean {matches[0]}?" if matches else f"known: {', '.join(self.known)}"
                )
                self.fault(key, f"is not a known key; {hint}")


def is_number(value: object) -> TypeGuard[int | float]:
    """Tell whether a TOML value is a finite number; true and false are none."""
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def read_column_map(path: str | Path) -> ColumnMap:
    """Read a column map from a TOML file; ``docs/formats.md`` documents the keys.

    Raises
    ------
    ConfigurationError
        If the file cannot be read, or for unknown keys (with a suggestion), wrong types, unknown
        units and impossible values: all errors of the file in one message.
    """
    path = Path(path)
    try:
        table = parse_toml(path.read_text(encoding="utf-8-sig"))
    except FileNotFoundError:
        raise ConfigurationError(f"{path}: no such column map") from None
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigurationError(f"{path}: not a readable TOML file: {error}") from None
    except ConfigurationError as error:
        raise ConfigurationError(f"{path}: {error}") from None
    # Messages name the whole path; provenance keeps the name, which means the same elsewhere.
    return replace(parse_column_map(table, str(path)), origin=path.name)


def parse_column_map(table: Mapping[str, object], origin: str) -> ColumnMap:
    """Build a column map from a TOML table already read, such as one of a campaign file.

    Raises
    ------
    ConfigurationError
        As :func:`read_column_map`; ``origin`` names the file and table in the message.
    """
    faults: list[str] = []
    top = TomlTable(table, "", faults)
    column_map = ColumnMap(
        channels=tuple(_channels(top)),
        time=_time(top),
        sample_rate_hz=top.number("sample_rate_hz", positive=True),
        photocell=_photocell(top),
        layout=TextLayout(
            separator=top.text("separator"),
            decimal=top.one_of("decimal", (".", ",")),
            skip_rows=top.whole_number("skip_rows") or 0,
            missing=_texts(top, "missing"),
        ),
        keep_others=bool(top.flag("keep_others")),
        origin=origin,
    )
    top.finish()
    if faults:
        raise ConfigurationError(f"{origin}: " + "; ".join(faults))
    return column_map


def _time(top: TomlTable) -> TimeColumn | None:
    source = _source(top, "time", "time")
    if source is None:
        return None
    if isinstance(source, ChannelColumn):
        if source.sign < 0:
            top.fault("time", "has a sign, which means nothing here; leave out '-'")
        return TimeColumn(source.column, source.unit)
    column, unit_name = source.text("column"), source.unit("unit")
    source.finish()
    if not column:
        _needs_column(top, "time")
        return None
    return TimeColumn(column, unit_name)


def _channels(top: TomlTable) -> Iterator[ChannelColumn]:
    table = _subtable(top, "channels") or TomlTable({}, "channels.", top.faults)
    for name in table.table:
        source = _source(table, name, name)
        if isinstance(source, ChannelColumn):
            yield source
        elif source is not None:
            channel = _long_channel(table, name, source)
            if channel:
                yield channel


def _long_channel(table: TomlTable, name: str, source: TomlTable) -> ChannelColumn | None:
    column, unit_name = source.text("column"), source.unit("unit")
    sign, scale = source.number("sign"), source.number("scale")
    full_scale = source.number("full_scale", positive=True)
    if sign not in (None, 1.0, -1.0):
        source.fault("sign", f"= {sign:g} should be 1 or -1; a factor goes to scale")
    if scale == 0.0:
        source.fault("scale", "= 0 would leave nothing of the channel")
    source.finish()
    if not column:
        _needs_column(table, name)
        return None
    return ChannelColumn(
        name, column, unit_name, -1 if sign == -1.0 else 1, scale or 1.0, full_scale
    )


def _needs_column(table: TomlTable, key: str) -> None:
    if not any(fault.startswith(f"{table.where}{key}.column") for fault in table.faults):
        table.fault(key, "needs the key column")


def _photocell(top: TomlTable) -> PhotocellColumn | None:
    table = _subtable(top, "photocell")
    if table is None:
        return None
    photocell = PhotocellColumn(
        column=table.text("column"),
        threshold=table.number("threshold"),
        edge=Edge(table.one_of("edge", tuple(Edge)) or Edge.RISING),
        edges_s=_time_list(table, "edges_s"),
        edges_file=table.text("edges_file"),
    )
    table.finish()
    sources = [key for key in ("column", "edges_s", "edges_file") if key in table.table]
    if len(sources) != 1:
        top.fault("photocell", f"needs one of column, edges_s, edges_file; it has {len(sources)}")
    return photocell


def _source(table: TomlTable, key: str, name: str) -> ChannelColumn | TomlTable | None:
    """Return a column's short form parsed, its long form as a table, or ``None``."""
    value = table.get(key)
    if isinstance(value, str):
        try:
            return parse_source(name, value)
        except ConfigurationError as error:
            table.fault(key, f"= {value!r}: {error}")
    elif isinstance(value, Mapping):
        return TomlTable(value, f"{table.where}{key}.", table.faults)
    elif value is not None:
        table.fault(key, f"= {value!r} should be a column's header or a table with the key column")
    return None


def _subtable(top: TomlTable, key: str) -> TomlTable | None:
    value = top.get(key)
    if value is None or isinstance(value, Mapping):
        return TomlTable(value, f"{key}.", top.faults) if value else None
    top.fault(key, f"= {value!r} should be a table")
    return None


def _texts(table: TomlTable, key: str) -> tuple[str, ...]:
    value = table.get(key)
    if isinstance(value, list) and all(isinstance(item, str) for item in value):
        return tuple(value)
    if value is not None:
        table.fault(key, f"= {value!r} should be a list of texts")
    return ()


def _time_list(table: TomlTable, key: str) -> tuple[float, ...] | None:
    value = table.get(key)
    if isinstance(value, list) and all(is_number(item) for item in value):
        return tuple(float(item) for item in value)
    if value is not None:
        table.fault(key, f"= {value!r} should be a list of times in seconds")
    return None
