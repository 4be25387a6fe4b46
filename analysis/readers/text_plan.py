"""Which columns of a text file are read, and as what."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from analysis.readers.clock import CLOCK, DATE
from analysis.readers.columns import ChannelColumn, ColumnMap, TimeColumn
from analysis.readers.columns_options import COMMAND_LINE
from analysis.readers.headers import Header, find_header, stated_unit, unit_hint
from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.flags import Flag, Severity
from hardware.description.units import Unit, is_unit, unit

YEAR_S: Final = 3.156e7
# First stamps of a clock that counts from 1970: in seconds they would lie 3000 years off and more.
_EPOCHS: Final = {"ns": 1e17, "us": 1e14, "ms": 1e11}


@dataclass(frozen=True)
class ChannelPlan:
    """A channel and its column; ``mapped`` where a column map names it."""

    spec: ChannelColumn
    header: Header
    mapped: bool

    def resolve(self) -> tuple[Channel, float, tuple[Flag, ...]]:
        """Return the channel in SI units, the factor to them, and what is to be said of it."""
        resolved, flags = self._unit()
        factor = self.spec.sign * self.spec.scale * resolved.factor
        full_scale = self.spec.full_scale
        full_scale_si = None if full_scale is None else full_scale * resolved.factor
        return Channel(self.spec.name, resolved.si, full_scale_si), factor, flags

    def _unit(self) -> tuple[Unit, tuple[Flag, ...]]:
        name, map_unit = self.spec.name, self.spec.unit
        stated = stated_unit(self.header, self.spec.column)
        chosen = map_unit or stated
        if chosen is None:
            text = f"{name}: no unit is stated; values are kept as they are"
            return Unit("", 1.0), (Flag("unit_missing", Severity.WARNING, text, name),)
        if not is_unit(chosen):
            text = (
                f"{name}: the unit {chosen!r} is not known; values are kept as they are, no unit"
                f"{unit_hint(chosen)}"
            )
            return Unit("", 1.0), (Flag("unit_unknown", Severity.WARNING, text, name),)
        if map_unit and stated and map_unit.strip() != stated:
            text = (
                f"{name}: the column map says {map_unit!r}, the header {stated!r}; the map is used"
            )
            return unit(map_unit), (Flag("unit_overridden", Severity.WARNING, text, name),)
        if not map_unit and self.header.unit_is_suffix:
            text = f"{name}: the unit {stated!r} was told from the header {self.header.text!r}"
            return unit(chosen), (Flag("unit_from_suffix", Severity.NOTE, text, name),)
        return unit(chosen), ()


@dataclass(frozen=True)
class ColumnPlan:
    """The columns of one file by their part; ``time`` is ``None`` where a rate is given."""

    time: Header | None
    photocell: Header | None
    channels: tuple[ChannelPlan, ...]
    flags: tuple[Flag, ...] = ()

    @property
    def wanted(self) -> tuple[Header, ...]:
        """Every column that is read, each once, in the file's order."""
        headers = {plan.header for plan in self.channels} | {self.time, self.photocell}
        return tuple(sorted((h for h in headers if h), key=lambda header: header.number))


def plan_columns(headers: tuple[Header, ...], columns: ColumnMap, where: str) -> ColumnPlan:
    """Find the columns that a map asks for, or give each its part by its header.

    Raises
    ------
    DataError
        If no time column is found and no sample rate given.
    ConfigurationError
        If a mapped column is not there.
    """
    time, found_time = _time(headers, columns, where)
    photocell = columns.photocell.column if columns.photocell else None
    level = find_header(headers, photocell, where) if photocell else None
    channels = [
        ChannelPlan(spec, _mapped(headers, spec, columns, where), mapped=True)
        for spec in columns.channels
    ]
    if columns.keep_others or not channels:
        used = {plan.header for plan in channels} | {time, found_time, level}
        channels += [
            ChannelPlan(ChannelColumn(header.name, header.text), header, mapped=False)
            for header in headers
            if header not in used
        ]
    flags: tuple[Flag, ...] = ()
    if found_time and not time:
        text = f"the column {found_time.text!r} is not used: the sample rate was given"
        flags = (Flag("time_not_used", Severity.NOTE, text),)
    return ColumnPlan(time, level, tuple(channels), flags)


def _mapped(
    headers: tuple[Header, ...], spec: ChannelColumn, columns: ColumnMap, where: str
) -> Header:
    try:
        return find_header(headers, spec.column, where)
    except ConfigurationError as error:
        if spec.name != spec.column or columns.origin != COMMAND_LINE:
            raise
        raise ConfigurationError(f"{error}; write NAME=COLUMN or NAME=COLUMN:UNIT") from None


def _time(
    headers: tuple[Header, ...], columns: ColumnMap, where: str
) -> tuple[Header | None, Header | None]:
    """Return the time column to read and the one that is there."""
    if columns.time:
        time_header = find_header(headers, columns.time.column, where)
        return time_header, time_header
    by_name = [header for header in headers if header.is_time]
    named = next(iter(by_name + [header for header in headers if header.unit == CLOCK]), None)
    if columns.sample_rate_hz is not None:
        return None, named
    if named is None:
        names = ", ".join(header.text or header.generic for header in headers)
        example = next((header.name for header in headers if _may_be_time(header)), "COLUMN")
        raise DataError(
            f"{where}: no column is named as time (columns: {names}); name it in the column map "
            f"with its unit, s or ms (time={example}:s), or, where the file has none, give the "
            "sample rate; where these are no headers, say skip_rows (lines before them)"
        )
    return named, named


def _may_be_time(header: Header) -> bool:
    """Whether a column has a unit of time, or none."""
    try:
        return header.unit is None or unit(header.unit).si == "s"
    except ConfigurationError:
        return False


def without_idle(plan: ColumnPlan, table: Mapping[Header, FloatArray], where: str) -> ColumnPlan:
    """Leave out columns that carry nothing: an unnamed index, no values at all, another clock.

    Raises
    ------
    DataError
        If no channel is left, or two have the same name.
    """
    channels, flags = [], list(plan.flags)
    for channel in plan.channels:
        flag = None if channel.mapped else _idle(channel.header, table[channel.header])
        if flag:
            flags.append(flag)
        else:
            channels.append(channel)
    if not channels:
        raise DataError(f"{where}: no column is left to be a channel, beside time and index")
    _check_unique(channels, where)
    return replace(plan, channels=tuple(channels), flags=tuple(flags))


def _idle(header: Header, values: FloatArray) -> Flag | None:
    if header.unit in (CLOCK, DATE):
        text = f"{header.text or header.generic} holds dates or times of day and is left out"
        return Flag("clock_column", Severity.NOTE, text)
    if header.text not in ("", "Unnamed: 0"):
        return None
    if np.isnan(values).all():
        text = f"{header.generic} has neither a name nor values and is left out"
        return Flag("empty_column", Severity.NOTE, text)
    counts = values[0] in (0.0, 1.0) and bool((np.diff(values) >= 1.0).all())
    if header.number == 1 and counts and bool((values == np.rint(values)).all()):
        text = "the first column has no name and counts the rows; it is left out"
        return Flag("index_column", Severity.NOTE, text)
    return None


def _check_unique(channels: Iterable[ChannelPlan], where: str) -> None:
    headers: dict[str, Header] = {}
    for channel in channels:
        name, header = channel.spec.name, channel.header
        if name in headers:
            raise DataError(
                f"{where}: {headers[name].generic} and {header.generic} would both be called "
                f"{name!r}; give them names in the column map"
            )
        headers[name] = header


def time_factor(
    header: Header, mapped: TimeColumn | None, stamps: FloatArray, where: str
) -> tuple[float, tuple[Flag, ...]]:
    """Return what turns time stamps into seconds; ``mapped`` is the map's word on them, if any.

    Stamps without a unit are seconds, unless they lie where only a clock that counts fractions of
    them since 1970 does.

    Raises
    ------
    DataError
        If the column's unit is not one of time.
    """
    name = header.unit if mapped is None else mapped.unit or stated_unit(header, mapped.column)
    if name == CLOCK:
        return 1.0, ()
    if name is None:
        counted = _since_1970(stamps)
        assumed_unit = f"{counted}, as they count from 1970," if counted else "seconds"
        alternative = "s" if counted else "ms"
        text = (
            f"the time column {header.text!r} states no unit; {assumed_unit} are assumed. If they "
            f"are others, name the unit in the column map: time={header.text}:{alternative}"
        )
        factor = unit(counted).factor if counted else 1.0
        return factor, (Flag("time_unit_assumed", Severity.WARNING, text),)
    try:
        stated = unit(name)
    except ConfigurationError as error:
        raise DataError(f"{where}: time column {header.text!r}: {error}") from None
    if stated.si != "s":
        raise DataError(
            f"{where}: time column {header.text!r} is in {name!r}, which is no unit of time; "
            "name the right column or its unit in the column map"
        )
    _check_seconds(header, name, stamps * stated.factor, where)
    return stated.factor, ()


def _since_1970(stamps: FloatArray) -> str | None:
    """Return the unit in which stamps count from 1970, where they are too many to be seconds."""
    first = stamps[0]
    return next((name for name, least in _EPOCHS.items() if abs(first) >= least), None)


def _check_seconds(header: Header, name: str, stamps_s: FloatArray, where: str) -> None:
    """Refuse stamps in a stated unit that lie thousands of years from 1970."""
    counted = _since_1970(stamps_s)
    if counted:
        raise DataError(
            f"{where}: the time column {header.text!r} begins {stamps_s[0] / YEAR_S:.3g} years "
            f"after its zero in {name!r}; name its unit in the column map: time={header.name}:UNIT"
        )
