"""What each column of a recording does, whatever it is called and wherever it stands."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np

from analysis.readers.photocell import edges_of_level
from analysis.recording import Recording
from hardware.description.arrays import FloatArray
from hardware.description.channels import SHAFT_ANGLE
from pmm.start.shared_line import NO_PART, SAME_TIME, LinePart, SharedLine, parts_in, shared_line

TURNS: Final[Mapping[str, float]] = {"deg": 360.0, "rad": 2.0 * np.pi, "rev": 1.0}
_STRAIGHT: Final = 0.1  # turns, standard deviation about an even turn: a drive's ripple is less
_LEVEL: Final = 0.15  # of the span: what a pulse's high and low keep within
_MOSTLY: Final = 0.95  # of the samples
_EVEN: Final = 0.1  # relative scatter of the pulses' intervals


@dataclass(frozen=True)
class Turn:
    """A column that turns once in each period of the line.

    ``unit`` is that of its numbers; ``wraps`` whether it jumps back after each turn.
    """

    unit: str
    wraps: bool


@dataclass(frozen=True, eq=False)
class Behaviour:
    """What one column does.

    Attributes
    ----------
    unit
        SI, of the numbers here; empty where the header says none.
    mean, spread
        Of all samples; the spread is the standard deviation.
    part
        In the recording's line.
    turn
        Where it counts the shaft's turns.
    pulses
        Whether it has two levels and one pulse in each period of the line.
    """

    unit: str
    mean: float
    spread: float
    part: LinePart = NO_PART
    turn: Turn | None = None
    pulses: bool = False


@dataclass(frozen=True, eq=False)
class RecordingBehaviour:
    """A recording's line, if it has one, and its columns by name."""

    line: SharedLine | None
    columns: Mapping[str, Behaviour]


def watch(recording: Recording) -> RecordingBehaviour:
    """Return what the columns of a recording do."""
    line = shared_line(recording)
    names = recording.channel_names
    parts = [NO_PART] * len(names) if line is None else parts_in(recording, names, line.reference)
    behaviours = map(partial(_behaviour, recording, line), names, parts)
    return RecordingBehaviour(line, dict(zip(names, behaviours, strict=True)))


def _behaviour(
    recording: Recording, line: SharedLine | None, name: str, part: LinePart
) -> Behaviour:
    unit = recording.channels[recording.index(name)].unit
    values = recording.values(name)
    finite = values[np.isfinite(values)]
    if not finite.size:
        return Behaviour(unit, 0.0, 0.0)
    mean, spread = float(finite.mean()), float(finite.std())
    if line is None:
        return Behaviour(unit, mean, spread)
    turn = _turn(recording, name, line)
    return Behaviour(
        unit, mean, spread, NO_PART if turn else part, turn, _pulses(recording, values, line)
    )


def _turn(recording: Recording, name: str, line: SharedLine) -> Turn | None:
    """Tell whether a column rises by one turn, in some unit, in each period of the line."""
    start_s, end_s = line.reference.times_s[[0, -1]].tolist()
    inside = recording.between(start_s, end_s)
    values = inside.values(name)
    good = np.isfinite(values)
    values, time_s = values[good], inside.time_s()[good]
    if values.size < 3 or not np.ptp(values):
        return None
    stated = recording.channels[recording.index(name)].unit
    units = ("rad",) if stated == SHAFT_ANGLE.unit else tuple(TURNS) if not stated else ()
    for unit in units:
        turns = np.unwrap(values, period=TURNS[unit]) / TURNS[unit]
        slope, level = np.polyfit(time_s - time_s[0], turns, 1)
        even = float(np.std(turns - level - slope * (time_s - time_s[0]))) < _STRAIGHT
        if even and abs(abs(slope) / line.frequency_hz - 1.0) < SAME_TIME:
            return Turn(unit, bool(np.abs(np.diff(values)).max() > 0.5 * TURNS[unit]))
    return None


def _pulses(recording: Recording, values: FloatArray, line: SharedLine) -> bool:
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    margin = _LEVEL * (high - low)
    if not margin or np.mean((values < low + margin) | (values > high - margin)) < _MOSTLY:
        return False
    apart_s = np.diff(edges_of_level(values)) / recording.sample_rate_hz
    if apart_s.size < 2 or np.std(apart_s) > _EVEN * np.mean(apart_s):
        return False
    return bool(abs(float(np.mean(apart_s)) * line.frequency_hz - 1.0) < SAME_TIME)


_STANDS: Final = 0.02  # of a run's amplitude: what moves no more in any column stands
_TIMELESS: Final = 0.2  # the same where nothing keeps time either


def at_rest(watched: Sequence[RecordingBehaviour]) -> list[bool]:
    """Tell of each recording whether it is one at rest.

    Judged by the columns that carry the line of the recording with the cleanest one: at rest none
    of them moves by more than a small part of its amplitude there.
    """
    timed = [
        recording
        for recording in watched
        if recording.line is not None and not recording.line.doubt
    ]
    if not timed:
        return [False] * len(watched)
    cleanest = min(timed, key=lambda recording: recording.line.residual if recording.line else 1.0)
    amplitudes = {
        name: abs(column.part.first)
        for name, column in cleanest.columns.items()
        if column.part.carried
    }
    return [_stands(recording, amplitudes, in_time=recording in timed) for recording in watched]


def _stands(recording: RecordingBehaviour, amplitudes: dict[str, float], *, in_time: bool) -> bool:
    moved = [
        recording.columns[name].spread / amplitude
        for name, amplitude in amplitudes.items()
        if name in recording.columns
    ]
    return bool(moved) and max(moved) < (_STANDS if in_time else _TIMELESS)
