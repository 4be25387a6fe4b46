"""The short form of a mapped column, as options of a command line and strings of a TOML file."""

from collections.abc import Iterable

from analysis.readers.columns import ChannelColumn, ColumnMap, PhotocellColumn, TimeColumn
from hardware.description.errors import ConfigurationError
from hardware.description.units import unit

TIME_OPTION = "time"
PHOTOCELL_OPTION = "photocell"


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
        unit(unit_name)
    if not column:
        raise ConfigurationError(f"{name}: no column is named in {text!r}")
    return ChannelColumn(name, column, unit_name, sign)


def parse_options(pairs: Iterable[str]) -> ColumnMap:
    """Build a column map from ``NAME=SOURCE`` options; see :meth:`ColumnMap.from_options`."""
    parsed: dict[str, ChannelColumn] = {}
    faults = []
    for pair in pairs:
        name, equals, source = (part.strip() for part in pair.partition("="))
        try:
            channel = parse_source(name, source if equals else name)
        except ConfigurationError as error:
            faults.append(f"{pair!r}: {error}")
            continue
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
        origin="column map on the command line",
    )
