"""Recordings from LabVIEW: TDMS files, by the package npTDMS (extra ``tdms``).

Each channel is a column under its own name, with its group's before it (``group/channel``) where
two groups have one of that name. The unit is its property ``unit_string`` (or
``NI_UnitDescription``), the rate one over ``wf_increment``; a channel of times goes before that.
"""

import struct
from collections import Counter
from pathlib import Path
from typing import Any, Final

import numpy as np

from analysis.foreign.columns import ForeignColumns
from analysis.readers.foreign import foreign_reader
from hardware.description.errors import DataError

_UNITS: Final = ("unit_string", "NI_UnitDescription")


def read_tdms(path: Path) -> ForeignColumns:
    """Return the columns of a TDMS file.

    Raises
    ------
    DataError
        If it is none that can be read, or its channels have several rates.
    """
    from nptdms import TdmsFile

    try:
        with path.open("rb") as raw, TdmsFile.open(raw) as file:
            channels = [channel for group in file.groups() for channel in group.channels()]
            return _columns(channels)
    except (OSError, ValueError, KeyError, IndexError, EOFError, struct.error) as error:
        raise DataError(f"not a sound TDMS file: {error}") from None


READER: Final = foreign_reader("tdms", read_tdms, "nptdms")


def _columns(channels: list[Any]) -> ForeignColumns:
    numbers = [channel for channel in channels if len(channel) > 1 and channel.dtype.kind in "fiu"]
    counts = Counter(channel.name for channel in numbers)
    names = [
        channel.name if counts[channel.name] == 1 else f"{channel.group_name}/{channel.name}"
        for channel in numbers
    ]
    values = {
        name: np.asarray(channel[:], dtype=np.float64)
        for name, channel in zip(names, numbers, strict=True)
    }
    units = {name: _unit(channel) for name, channel in zip(names, numbers, strict=True)}
    return ForeignColumns(values, units, _rate(numbers))


def _unit(channel: Any) -> str:
    return next((str(channel.properties[key]) for key in _UNITS if key in channel.properties), "")


def _rate(channels: list[Any]) -> float | None:
    """Return the rate of the longest channels, which has to be one."""
    longest = max(map(len, channels), default=0)
    steps = {
        float(channel.properties["wf_increment"])
        for channel in channels
        if len(channel) == longest and float(channel.properties.get("wf_increment", 0.0)) > 0.0
    }
    if len(steps) > 1:
        rates = ", ".join(f"{1.0 / step:g}" for step in sorted(steps))
        raise DataError(f"channels of one length have several rates ({rates} Hz)")
    return 1.0 / steps.pop() if steps else None
