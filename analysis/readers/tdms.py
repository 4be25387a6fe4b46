"""Recordings from LabVIEW: TDMS files, by the package npTDMS (extra ``tdms``).

Each channel is a column under its own name, with its group's before it (``group/channel``) where
two groups have one of that name. The unit is its property ``unit_string`` (or
``NI_UnitDescription``), the rate one over ``wf_increment``, if the longest channels have the same
one and the same start (``wf_start_time`` and ``wf_start_offset``); a channel of times goes before
that.
"""

import struct
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np

from analysis.foreign.columns import ForeignColumns
from analysis.readers.foreign import foreign_reader
from analysis.readers.time_base import NOTED_DEVIATION
from hardware.description.errors import DataError

Properties = Mapping[str, Any]

_UNITS: Final = ("unit_string", "NI_UnitDescription")
_START: Final = "wf_start_time"
_OFFSET: Final = "wf_start_offset"  # s, from there to the first sample


def read_tdms(path: Path) -> ForeignColumns:
    """Return the columns of a TDMS file.

    Raises
    ------
    DataError
        If it is none that can be read.
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
    longest = max(map(len, numbers), default=0)
    alike = {
        name: channel.properties
        for name, channel in zip(names, numbers, strict=True)
        if len(channel) == longest
    }
    return ForeignColumns(values, units, *_rate(alike))


def _unit(channel: Any) -> str:
    return next((str(channel.properties[key]) for key in _UNITS if key in channel.properties), "")


def _rate(channels: Mapping[str, Properties]) -> tuple[float | None, str]:
    """Return the rate that channels of one length state, or why there is none."""
    steps_s = {name: _step_s(properties) for name, properties in channels.items()}
    stating = [name for name, step_s in steps_s.items() if step_s > 0.0]
    if not stating:
        return None, ""
    first = stating[0]
    interval_s = steps_s[first]
    for name, step_s in steps_s.items():
        if step_s != interval_s:
            rate = f"{1.0 / step_s:g} Hz" if step_s > 0.0 else "no rate"
            return None, f"{first!r} states {1.0 / interval_s:g} Hz and {name!r} {rate}"
        later_s = _start_s(channels[name], channels[first])
        if abs(later_s) > NOTED_DEVIATION * interval_s:
            return None, f"{name!r} starts {later_s:.9g} s after {first!r}"
    return 1.0 / interval_s, ""


def _step_s(properties: Properties) -> float:
    return float(properties.get("wf_increment", 0.0))


def _start_s(properties: Properties, first: Properties) -> float:
    """Return the time from the first channel's start; one that states no time of day has its."""
    offset_s = float(properties.get(_OFFSET, 0.0)) - float(first.get(_OFFSET, 0.0))
    if not (_START in properties and _START in first):
        return offset_s
    return offset_s + float((properties[_START] - first[_START]) / np.timedelta64(1, "s"))
