"""What the recordings of another system seem to hold: which column is what, and the set-points."""

import math
import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from analysis.first_harmonics import seen_in
from analysis.plausibility import Seen
from analysis.readers import ColumnMap, read_recording
from analysis.readers.columns import ChannelColumn
from analysis.recording import Recording
from analysis.resolver.analyse import analyse
from hardware.description.channels import (
    CARRIAGE_SPEED,
    DISPLACEMENT_AFT,
    DISPLACEMENT_FORE,
    FORCE_AFT,
    FORCE_FORE,
    SHAFT_ANGLE,
    Channel,
)
from hardware.description.errors import PmmError
from hardware.description.setpoint import SetPoint

_FORE: Final = ("fore", "front", "vorn", "bow", "bug", "stb b", "avant")
_KINDS: Final[tuple[tuple[tuple[Channel, ...], tuple[str, ...]], ...]] = (
    ((FORCE_AFT, FORCE_FORE), ("force", "kraft", "load", "gauge", "fy", "fz", "f1", "f2")),
    ((DISPLACEMENT_AFT, DISPLACEMENT_FORE),
     ("disp", "stroke", "strut", "weg", "hub", "heave", "sway", "pos")),
    ((SHAFT_ANGLE,), ("angle", "crank", "shaft", "winkel", "kurbel", "encoder")),
    ((CARRIAGE_SPEED,), ("speed", "carriage", "wagen")),
)  # fmt: skip
_NO_UNIT: Final = "no unit in the header: if it is kN, write {!r}"


@dataclass(frozen=True)
class Column:
    """A channel of the campaign and the column that it is taken from, as a column map has it."""

    name: str
    source: str
    remark: str = ""


@dataclass(frozen=True)
class FoundRun:
    """A recording as a run of the campaign; ``remark`` says where a number was not found."""

    name: str
    file: str
    frequency_hz: float
    eccentricity_mm: float
    strut_phase_deg: float
    remark: str = ""


def find_columns(recording: Recording) -> tuple[list[Column], list[str]]:
    """Return the columns that seem to be channels of a rig, and the names of the others."""
    taken: dict[str, Channel] = {}
    for channels, words in _KINDS:
        fitting = [
            one
            for one in recording.channels
            if one.name not in taken and _fits(one, channels[0], words)
        ]
        taken |= _placed(fitting, channels)
    found = [_column(wanted.name, name, recording) for name, wanted in taken.items()]
    order = [channel.name for channels, _ in _KINDS for channel in channels]
    found.sort(key=lambda one: order.index(one.name))
    return found, [name for name in recording.channel_names if name not in taken]


def _fits(one: Channel, wanted: Channel, words: Sequence[str]) -> bool:
    """By its unit where it has one, else by its name."""
    if one.unit:
        return one.unit == wanted.unit
    return any(word in one.name.casefold() for word in words)


def _placed(fitting: Sequence[Channel], channels: Sequence[Channel]) -> dict[str, Channel]:
    """Aft first, unless a name says fore."""
    fore = [one for one in fitting if any(word in one.name.casefold() for word in _FORE)]
    if len(channels) > 1 and len(fitting) > 1 and fore and fore[0] is fitting[0]:
        fitting = [fitting[1], fitting[0]]
    return {one.name: channel for one, channel in zip(fitting, channels, strict=False)}


def _column(name: str, source: str, recording: Recording) -> Column:
    if recording.channels[recording.index(source)].unit:
        return Column(name, source)
    if name == SHAFT_ANGLE.name:
        turned = f"{source}:deg"
        degrees = float(abs(recording.values(source)).max(initial=0.0)) > 4.0 * math.pi
        return Column(name, turned if degrees else f"{source}:rad", "no unit in the header")
    return Column(name, source, _NO_UNIT.format(f"{source}:kN"))


def find_runs(paths: Sequence[Path], columns: Sequence[Column], folder: Path) -> Iterator[FoundRun]:
    """Return each recording as a run, with frequency, amplitude and phase where they show.

    Raises
    ------
    DataError, ConfigurationError
        If a recording cannot be read.
    """
    channels = tuple(_mapped(one) for one in columns)
    for path in paths:
        recording = read_recording(path, ColumnMap(channels=channels))
        seen = _seen(recording)
        name = Path(path.name.removesuffix(".gz")).stem
        file = Path(os.path.relpath(path, folder)).as_posix()
        if seen is None:
            yield FoundRun(name, file, 0.5, 20.0, 0.0, "not found in it: put in what was set")
        else:
            phase_deg = _phase_deg(seen)
            amplitude_mm = 1e3 * abs(seen.first.get(DISPLACEMENT_AFT.name, 0.02))
            yield FoundRun(
                name, file, _rounded(seen.frequency_hz, 4), _rounded(amplitude_mm, 3), phase_deg
            )


def _mapped(one: Column) -> ChannelColumn:
    source, _, unit = one.source.partition(":")
    return ChannelColumn(one.name, source, unit or None)


def _seen(recording: Recording) -> Seen | None:
    """Return the first harmonics, where displacement or encoder tells the phase."""
    told = replace(recording, set_point=SetPoint(1.0, 0.02))
    try:
        return seen_in(told, analyse(recording))
    except PmmError:
        return None


def _phase_deg(seen: Seen) -> float:
    """Return the fore strut's phase ahead of the aft one, in whole degrees."""
    try:
        ratio = seen.first[DISPLACEMENT_FORE.name] / seen.first[DISPLACEMENT_AFT.name]
    except (KeyError, ZeroDivisionError):
        return 0.0
    return float(round(math.degrees(math.atan2(ratio.imag, ratio.real)))) % 360.0


def _rounded(value: float, digits: int) -> float:
    return float(f"{value:.{digits}g}")
