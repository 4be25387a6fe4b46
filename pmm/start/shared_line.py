"""The line that the columns of a recording share: the frequency at which the rig was driven.

What drives is the cleanest motion of all, and what it drives answers at the same frequency. Each
column's own fundamental is a candidate; the one is taken that a column carries most purely while
others carry it too.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import numpy as np

from analysis.recording import Recording
from analysis.resolver.estimate import resolve
from analysis.resolver.reference import PhaseReference
from analysis.resolver.signal_reference import from_signal
from analysis.resolver.sums import period_sums
from hardware.description.arrays import FloatArray
from hardware.description.errors import PmmError

HARMONICS: Final = 3
SAME_TIME: Final = 0.02  # relative: two counts of one motion
CARRIED: Final = 5.0  # standard errors that a first harmonic is above nothing
_PUREST: Final = 1e-6  # share beside the harmonics: sensors are no better, purer is not more likely
_SHARED: Final = 0.02  # of a column's variance, at least, for the line to be its own too
_ALONE: Final = 0.1  # what a line counts for that only one column has
_LARGEST_BESIDE: Final = (
    0.5  # share beside the harmonics: a line with more beside it drives nothing
)
_ROUNDING: Final = 1e-24  # of the values squared: what a constant leaves
_FEW: Final = "few_reference_periods"


@dataclass(frozen=True, eq=False)
class SharedLine:
    """What is common to the columns.

    Attributes
    ----------
    reference
        Its phase as that column has it.
    frequency_hz
        Its frequency, even over the stretch in which it is there, by least squares.
    channel
        The column that carries it most purely.
    residual
        Share of that column's variance that is neither in the line nor in its harmonics.
    other_columns
        Columns that carry it too.
    doubt
        Why it may be none of the rig's; empty where it is sure.
    """

    reference: PhaseReference
    frequency_hz: float
    channel: str
    residual: float
    other_columns: tuple[str, ...]
    doubt: str = ""


class Share(NamedTuple):
    """Of a column's variance without a drift: in the first harmonic, and in none."""

    first: float = 0.0
    residual: float = 1.0


@dataclass(frozen=True)
class LinePart:
    """A column's part in a line.

    Attributes
    ----------
    first
        First harmonic ``S_1 + i C_1``, in the column's unit.
    carried
        Whether it is well above its own scatter from period to period.
    residual
        Share of the variance that is in no harmonic.
    """

    first: complex = 0.0
    carried: bool = False
    residual: float = 1.0


NO_PART: Final = LinePart()


def shared_line(recording: Recording) -> SharedLine | None:
    """Return the line of a recording; ``None`` where nothing keeps time.

    Parameters
    ----------
    recording
        With all its columns; one in which nothing moves is none of a run.
    """
    names = sorted(recording.channel_names)
    references = {
        name: reference for name in names if (reference := _own_reference(recording, name))
    }
    asked = {
        name: reference for name, reference in references.items() if not _has_few_periods(reference)
    } or references
    lines = sorted(
        (_line_of_column(recording, *item) for item in asked.items()),
        key=lambda line: line.residual,
    )
    judged = [_judged(recording, line) for line in _distinct_lines(lines)]
    if not judged:
        return None
    line, _ = max(judged, key=lambda pair: pair[1])
    return replace(line, doubt=_doubt(line, len(asked) > 1))


def _line_of_column(recording: Recording, name: str, reference: PhaseReference) -> SharedLine:
    """Return the line that a column would be of by itself."""
    even = _even_reference(recording, name, reference)
    beside = shares(recording, even, [name])[name].residual
    return SharedLine(reference, even.frequency_hz, name, beside, ())


def _distinct_lines(lines: Sequence[SharedLine]) -> list[SharedLine]:
    """Return the first of all that are one line: the cleanest."""
    clean_lines: list[SharedLine] = []
    for line in lines:
        if all(
            abs(line.frequency_hz / clean_line.frequency_hz - 1.0) > SAME_TIME
            for clean_line in clean_lines
        ):
            clean_lines.append(line)
    return clean_lines


def _judged(recording: Recording, line: SharedLine) -> tuple[SharedLine, float]:
    names = [
        channel_name for channel_name in recording.channel_names if channel_name != line.channel
    ]
    column_shares = shares(recording, line.reference, names)
    other_names = tuple(
        sorted(name for name, share in column_shares.items() if share.first > _SHARED)
    )
    alike = max([_ALONE, *(share.first for share in column_shares.values())])
    return replace(line, other_columns=other_names), -math.log10(
        max(line.residual, _PUREST)
    ) * alike


def _doubt(line: SharedLine, rivals: bool) -> str:
    if line.residual > _LARGEST_BESIDE:
        return f"{100.0 * line.residual:.0f} % of the cleanest column, {line.channel}, is no line"
    if rivals and not line.other_columns:
        return f"{line.channel} has it alone, other columns keep another time"
    return (
        "so few periods keep time that noise might do so"
        if _has_few_periods(line.reference)
        else ""
    )


def _has_few_periods(reference: PhaseReference) -> bool:
    return any(flag.code == _FEW for flag in reference.flags)


def _own_reference(recording: Recording, name: str) -> PhaseReference | None:
    """Return the phase by one column alone, if it has a fundamental."""
    try:
        return from_signal(recording, name)
    except PmmError:
        return None


def _even_reference(recording: Recording, name: str, reference: PhaseReference) -> PhaseReference:
    """Return a reference that turns evenly, as fast as fits a column's samples best.

    One step of Gauss and Newton from the reference's mean: where the wave ``S sin + C cos`` needs a
    ``t (P sin + Q cos)`` beside it, its angular frequency is off by ``(S Q - C P) / (S² + C²)``.
    """
    ends_s = reference.times_s[[0, -1]]
    inside = recording.between(*ends_s.tolist())
    values, time_s = inside.values(name), inside.time_s() - ends_s.mean()
    turn = 2.0 * np.pi * reference.frequency_hz * time_s
    constant = np.ones_like(turn)
    rows = np.stack(
        [by * wave for by in (constant, time_s) for wave in (constant, np.sin(turn), np.cos(turn))]
    )
    good = np.isfinite(values)
    rows, values = rows[:, good], values[good]
    _, s, c, _, p, q = np.linalg.lstsq(rows @ rows.T, rows @ values, rcond=None)[0].tolist()
    off_hz = (s * q - c * p) / max(s * s + c * c, 1e-300) / (2.0 * np.pi)
    near = abs(off_hz) < SAME_TIME * reference.frequency_hz
    frequency_hz = reference.frequency_hz + (off_hz if near else 0.0)
    return PhaseReference(reference.source, ends_s, frequency_hz * (ends_s - ends_s[0]))


def shares(
    recording: Recording, reference: PhaseReference, names: Sequence[str]
) -> dict[str, Share]:
    """Return what part of some columns' variance a line explains, by least squares."""
    inside = recording.between(float(reference.times_s[0]), float(reference.times_s[-1]))
    time_s = inside.time_s()
    turn = 2.0 * np.pi * reference.cycles_at(time_s)
    waves = (wave(n * turn) for n in range(1, HARMONICS + 1) for wave in (np.sin, np.cos))
    rows = np.stack((np.ones_like(turn), time_s - time_s.mean(), *waves))
    return {name: _share(rows, inside.values(name)) for name in names}


def _share(rows: FloatArray, values: FloatArray) -> Share:
    good = np.isfinite(values)
    if not good.all():
        rows, values = rows[:, good], values[good]
    if values.size < 2 * len(rows):
        return Share()
    level = values - _fitted(rows[:2], values)
    power = float(level @ level)
    if not power > _ROUNDING * float(values @ values):
        return Share()
    first, residual = (level - _fitted(rows[:count], level) for count in (4, None))
    return Share(1.0 - float(first @ first) / power, float(residual @ residual) / power)


def _fitted(rows: FloatArray, values: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.lstsq(rows @ rows.T, rows @ values, rcond=None)[0] @ rows)


def parts_in(
    recording: Recording, names: Sequence[str], reference: PhaseReference
) -> list[LinePart]:
    """Return what columns have of a line; nothing where no period of one is whole."""
    column_shares = shares(recording, reference, names)
    return [
        _part(recording.select([name]), reference, column_shares[name].residual) for name in names
    ]


def _part(chosen: Recording, reference: PhaseReference, beside: float) -> LinePart:
    samples = chosen.sample_rate_hz / reference.frequency_hz
    harmonics = max(1, min(HARMONICS, int((samples - 1.0) // 2)))
    try:
        reading = resolve(chosen, period_sums(chosen, reference, harmonics))
    except PmmError:
        return NO_PART
    first = complex(*reading.coefficients[0, 1:3])
    # A wave maker that starts and stops inside the stretch has memory, and its line all the same.
    alone = reading.standard_uncertainty / reading.widening
    scatter = float(np.hypot(*alone[0, 1:3]))
    rounding = _ROUNDING**0.5 * abs(float(reading.mean[0]))
    return LinePart(first, abs(first) > max(CARRIED * scatter, rounding), beside)
