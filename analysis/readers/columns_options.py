"""The short form of a mapped column, as options of a command line and strings of a TOML file."""

from collections.abc import Iterable

from analysis.readers.columns import ChannelColumn, ColumnMap, PhotocellColumn, TimeColumn
from analysis.readers.headers import TIME_NAMES, unit_hint
from hardware.description.errors import ConfigurationError
from hardware.description.units import is_unit, unit

TIME_OPTION = "time"
PHOTOCELL_OPTION = "photocell"
COMMAND_LINE = "column map on the command line"


def parse_source(name: str, text: str) -> ChannelColumn:
    """Turn ``[-]COLUMN[:UNIT]`` into a channel called ``name``.

    Raises
    ------
    ConfigurationError
        If no column is named or the unit is not known.
    """
    text = text.strip()
    sign = -1 if text.startswith("-") else 1
    column = text[1:].strip() if sign < 0 else text
    unit_name = None
    if ":" in column and not column.endswith(("]", ")")):
        column, unit_name = (part.strip() for part in column.rsplit(":", 1))
        _check_unit(unit_name)
    if not column:
        raise ConfigurationError(f"{name}: no column is named in {text!r}")
    return ChannelColumn(name, column, unit_name, sign)


def _is_time(channel: ChannelColumn) -> bool:
    """Whether a mapped column is that of time stamps: called so, and in a unit of time."""
    names = {channel.name.casefold(), channel.column.casefold()}
    in_time = channel.unit is not None and unit(channel.unit).si == "s"
    return in_time and not names.isdisjoint(TIME_NAMES)


def _is_plain(name: str) -> bool:
    """Whether an option without "=" is a column that keeps its name."""
    signed_or_unit = name.startswith("-") or (":" in name and not name.endswith(("]", ")")))
    return not signed_or_unit and name.casefold() not in TIME_NAMES


def _without_name(pair: str) -> str:
    """Say what an option that lacks its "=" should look like."""
    column, _, unit_name = pair.strip().lstrip("-").partition(":")
    name = column.strip() or "NAME"
    in_time = is_unit(unit_name) and unit(unit_name).si == "s"
    if in_time or name.casefold() in TIME_NAMES:
        return f"{pair!r}: for the time column write {TIME_OPTION}={name}:{unit_name or 'ms'}"
    plain = name.partition(" [")[0].replace(" ", "_")
    return f"{pair!r}: write NAME=COLUMN or NAME=COLUMN:UNIT, for example {plain}={pair.strip()}"


def _check_unit(name: str) -> None:
    if not is_unit(name) and unit_hint(name):
        raise ConfigurationError(f"unknown unit {name!r}{unit_hint(name)}")
    unit(name)


def parse_options(pairs: Iterable[str]) -> ColumnMap:
    """Build a column map from command-line text such as ``force_aft=-F1:kN``.

    Each is ``NAME=SOURCE``: ``SOURCE`` is a column's header, with ``:UNIT`` after it where the
    header does not say the unit (or another one), and ``-`` before it to turn the sign. The names
    ``time`` and ``photocell`` are for the time stamps and the photocell's level.

    Raises
    ------
    ConfigurationError
        For text that is no such pair, unknown units and names given twice, all at once.
    """
    parsed: dict[str, ChannelColumn] = {}
    faults = []
    for pair in pairs:
        name, equals, source = (part.strip() for part in pair.partition("="))
        if not equals and not _is_plain(name):
            faults.append(_without_name(pair))
            continue
        try:
            channel = parse_source(name, source if equals else name)
        except ConfigurationError as error:
            faults.append(f"{pair!r}: {error}")
            continue
        name = TIME_OPTION if _is_time(channel) else name
        if not name:
            faults.append(f"{pair!r}: no name before '='; write NAME=COLUMN or NAME=COLUMN:UNIT")
        elif name in parsed:
            faults.append(f"{pair!r}: {name} is mapped twice")
        parsed[name] = channel
    faults += [
        f"{name}: a sign means nothing here; leave out '-'"
        for name in (TIME_OPTION, PHOTOCELL_OPTION)
        if name in parsed and parsed[name].sign < 0
    ]
    if faults:
        raise ConfigurationError("column map: " + "; ".join(faults))
    time, photocell = parsed.pop(TIME_OPTION, None), parsed.pop(PHOTOCELL_OPTION, None)
    return ColumnMap(
        channels=tuple(parsed.values()),
        time=TimeColumn(time.column, time.unit) if time else None,
        photocell=PhotocellColumn(photocell.column) if photocell else None,
        origin=COMMAND_LINE,
    )
