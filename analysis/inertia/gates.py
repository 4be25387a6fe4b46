"""Photogate edges, of one gate or two, to passages: when the body hung straight.

A passage is the middle between a flag's entry and exit, so that its width does not matter. Of two
gates at either end the mean of both passages is free of sway, which moves both the same way.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hardware.description.arrays import BoolArray, FloatArray, IntArray
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

SHORTEST_SHARE = 0.15  # of the usual width: a bounce between or a scratch on the flag
LONGEST_SHARE = 3.0  # of the usual width: an edge was lost
OFF_BEAT = 0.25  # of half a period
_REACH = 7  # widths to either side, of which the usual one is the median


@dataclass(frozen=True)
class GateEvents:
    """Edges as a timer wrote them.

    Attributes
    ----------
    time_s
        When any gate changed, shape ``(events,)``, increasing.
    blocked
        Whether each gate was blocked from then on, shape ``(gates, events)``.
    """

    name: str
    time_s: FloatArray
    blocked: BoolArray
    gates: tuple[str, ...]
    flags: tuple[Flag, ...] = ()


@dataclass(frozen=True)
class Passages:
    """When the body passed its rest position.

    Attributes
    ----------
    number
        Half-swing each passage belongs to, shape ``(passages,)``, increasing; gaps where one was
        missed.
    time_s
        When, shape ``(passages,)``.
    speed
        Inverse of the time in the gate, 1/s: a measure of amplitude, shape ``(passages,)``.
    """

    name: str
    number: IntArray
    time_s: FloatArray
    speed: FloatArray
    flags: tuple[Flag, ...] = ()


def read_gate_events(
    path: str | Path, *, time: str = "Time", gates: tuple[str, ...] = ("State at A", "State at B")
) -> GateEvents:
    """Read a timer's text file: a time column and a column of 0 and 1 for each gate.

    Lines under the header that hold no numbers (units, blanks) are passed over.

    Parameters
    ----------
    time, gates
        Names of the columns; one gate or several.

    Raises
    ------
    DataError
        If the file or a column is missing, a state is neither 0 nor 1, times run backwards, or
        fewer than eight events are there.
    """
    import csv

    path = Path(path)
    if not path.is_file():
        raise DataError(f"{path}: no such file")
    with path.open(newline="", encoding="utf-8-sig") as stream:
        rows = list(csv.reader(stream))
    header = [cell.strip() for cell in rows[0]] if rows else []
    missing = [name for name in (time, *gates) if name not in header]
    if missing:
        raise DataError(
            f"{path}: no column {', '.join(map(repr, missing))} (columns: {', '.join(header)})"
        )
    places = [header.index(name) for name in (time, *gates)]
    numbers = [number for row in rows[1:] if (number := _numbers(row, places)) is not None]
    table = np.array(numbers, dtype=np.float64).reshape(len(numbers), len(places))
    return gate_events(path.name, table[:, 0], table[:, 1:].T, gates)


def _numbers(row: list[str], places: list[int]) -> list[float] | None:
    try:
        return [float(row[place]) for place in places]
    except (ValueError, IndexError):
        return None


def gate_events(
    name: str, time_s: FloatArray, states: FloatArray, gates: tuple[str, ...] = ("A",)
) -> GateEvents:
    """Check edges that were read elsewhere.

    It raises what :func:`read_gate_events` raises.

    Parameters
    ----------
    states
        0 (free) or 1 (blocked) from each time on, shape ``(gates, events)``.
    """
    if time_s.size < 8:
        raise DataError(f"{name}: {time_s.size} gate event(s); at least 8 are needed (two swings)")
    if not np.isin(states, (0.0, 1.0)).all():
        raise DataError(f"{name}: a gate's state is neither 0 nor 1; is the column the right one?")
    reversals = np.flatnonzero(np.diff(time_s) < 0.0)
    if reversals.size:
        k = int(reversals[0])
        raise DataError(
            f"{name}: time runs backwards at event {k + 2}: {time_s[k + 1]:.9g} s after "
            f"{time_s[k]:.9g} s; sort the events or split the file"
        )
    return GateEvents(name, time_s, states.astype(bool), gates)


def passages(events: GateEvents) -> Passages:
    """Turn edges into passages, robust to bounces, scratches, and lost edges.

    Blocked stretches that a bounce has broken are joined; those under 15 % or over 3 times the
    usual width are dropped, and so are passages off the beat. With two gates only half-swings that
    both have seen count.

    Raises
    ------
    DataError
        If fewer than eight passages are left.
    """
    flags: list[Flag] = []
    gate_passages = []
    for gate, states in zip(events.gates, events.blocked, strict=True):
        middle, width, gate_flags = _one_gate(events.name, gate, events.time_s, states)
        flags += gate_flags
        gate_passages.append((middle, width))
    half = _half_period(gate_passages)
    numbered = [
        _number(middle, width, half, gate_passages[0][0][0]) for middle, width in gate_passages
    ]
    common = sorted(set.intersection(*[set(rows) for rows in numbered]))
    all_seen = set.union(*[set(rows) for rows in numbered])
    expected = max(all_seen) - min(all_seen) + 1
    if len(common) < 8:
        raise DataError(
            f"{events.name}: {len(common)} passages that all gates have seen; at least 8 are "
            "needed: too few swings, or the gates do not stand at the rest position"
        )
    if len(common) < expected:
        message = (
            f"{events.name}: {expected - len(common)} of {expected} half-swings are missed or "
            "dropped (lost edges, bounces); the others carry the count"
        )
        flags.append(Flag("missed_passages", Severity.NOTE, message))
    rows = np.array([[row[k] for row in numbered] for k in common])
    mean = rows.mean(axis=1)
    return Passages(
        events.name, np.array(common, dtype=np.int64), mean[:, 0], mean[:, 1], tuple(flags)
    )


def _one_gate(
    name: str, gate: str, time_s: FloatArray, blocked: BoolArray
) -> tuple[FloatArray, FloatArray, list[Flag]]:
    """Return middles and widths of one gate's blocked stretches."""
    change = np.flatnonzero(blocked[1:] != blocked[:-1]) + 1
    if blocked[0]:
        change = np.concatenate(([0], change))
    change = change[: change.size // 2 * 2]
    if change.size < 8:
        raise DataError(f"{name}: gate {gate!r} changed {change.size} times; it has seen no swings")
    start, stop = time_s[change[0::2]], time_s[change[1::2]]
    usual = float(np.median(stop - start))
    joined = np.concatenate(([True], start[1:] - stop[:-1] > SHORTEST_SHARE * usual))
    start, stop = start[joined], stop[np.append(np.flatnonzero(joined)[1:] - 1, stop.size - 1)]
    width = stop - start
    usual_width = _running_median(width)
    good = (width > SHORTEST_SHARE * usual_width) & (width < LONGEST_SHARE * usual_width)
    flags = []
    if not joined.all() or not good.all():
        message = (
            f"{name}, gate {gate!r}: {int((~joined).sum())} bounce(s) joined, "
            f"{int((~good).sum())} stretch(es) of an unlikely width dropped"
        )
        flags.append(Flag("gate_repaired", Severity.NOTE, message, gate))
    return 0.5 * (start + stop)[good], width[good], flags


def _running_median(width: FloatArray) -> FloatArray:
    padded = np.pad(width, _REACH, mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * _REACH + 1)
    return np.asarray(np.median(windows, axis=1))


def _half_period(gate_passages: list[tuple[FloatArray, FloatArray]]) -> float:
    """Half the usual time from one passage to the next but one, over all gates."""
    return float(np.median(np.concatenate([m[2:] - m[:-2] for m, _ in gate_passages]))) / 2.0


def _number(
    middle: FloatArray, width: FloatArray, half: float, origin: float
) -> dict[int, tuple[float, float]]:
    """Count half-swings from passage to passage; those off the beat are left out."""
    rows: dict[int, tuple[float, float]] = {}
    number, last = round((middle[0] - origin) / half), middle[0]
    rows[number] = (middle[0], 1.0 / width[0])
    for time, wide in zip(middle[1:], width[1:], strict=True):
        steps = (time - last) / half
        half_swings = round(steps)
        # An off-centre gate makes swings to one side shorter: the tolerance allows for it.
        if half_swings >= 1 and abs(steps - half_swings) <= OFF_BEAT + 0.02 * half_swings:
            number, last = number + half_swings, time
            rows[number] = (time, 1.0 / wide)
    return rows
