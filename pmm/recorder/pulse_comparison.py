"""Holds a run's journal of pulses against its raw log, and finds where it may have lost some."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final

import numpy as np

from hardware.roles import Pulse
from pmm.recorder.files import PULSES
from pmm.recorder.recording import RunData

IN_FLIGHT_S: Final = 1.0
"""Of what a run has brought the last may be in one journal and not in the other after a crash: the
run's ``flush_s``, a second unless the rig's file says less."""

Row = Sequence[Any]


@dataclass(frozen=True)
class PulseComparison:
    """What the pulses of a journal are beside those of the raw log.

    Attributes
    ----------
    missing
        Pulses of the log that the journal does not have, and that no crash leaves in flight.
    differing
        Lines of the journal that are not the pulse of their number in the log, bit by bit, or not
        in their place.
    """

    missing: tuple[Pulse, ...]
    differing: int

    @property
    def same(self) -> bool:
        """Whether the journal has what the log has."""
        return not self.missing and not self.differing


def as_row(pulse: Pulse) -> list[Any]:
    """Return a pulse as a line of the journal has it."""
    angle = pulse.shaft_angle_rad
    return [pulse.number, pulse.time_s, None if np.isnan(angle) else angle]


def compare_pulses(
    recorded: Sequence[Row], decoded: Sequence[Pulse], end_s: float
) -> PulseComparison:
    """Hold the lines of a journal against the pulses of the raw log.

    Parameters
    ----------
    end_s
        Time of the last cycle that was decoded.
    """
    numbers = {row[0] for row in recorded}
    there = [as_row(pulse) for pulse in decoded if pulse.number in numbers]
    differing = sum(list(row) != again for row, again in zip(recorded, there, strict=False))
    missing = tuple(
        pulse
        for pulse in decoded
        if pulse.number not in numbers and pulse.time_s < end_s - IN_FLIGHT_S
    )
    return PulseComparison(missing, differing + abs(len(recorded) - len(there)))


def united_pulses(recorded: Sequence[Row], decoded: Sequence[Pulse]) -> list[Row]:
    """Return the lines of all pulses by their numbers, as the log has them where it has them."""
    rows = {row[0]: row for row in recorded} | {pulse.number: as_row(pulse) for pulse in decoded}
    return [rows[number] for number in sorted(rows)]


def doubtful_pulses(run: RunData) -> str:
    """Say why the journal of a run that was not closed may have lost pulses; nothing if it has not.

    Pulses are numbered without gaps and, while the shaft turns, follow each other to the end.
    """
    if run.marker is not None or not run.header.photocell or run.samples is None:
        return ""
    rows, rate_hz = run.texts[PULSES], run.header.sample_rate_hz
    for before, after in pairwise(rows):
        if after[0] != before[0] + 1:
            return f"number {after[0]} follows number {before[0]}"
    times_s = [row[1] for row in rows]
    usual_s = float(np.median(np.diff(times_s))) if len(times_s) > 1 else 0.0
    first_s = run.samples.first_sync / rate_hz
    last_s = first_s + (run.samples.sample_count - 1) / rate_hz
    # Half a period more, so that an uneven shaft is no reason.
    longest_s = IN_FLIGHT_S + 1.5 * usual_s
    for begin_s, end_s in pairwise([first_s, *times_s[:1], *times_s[-1:], last_s]):
        if end_s - begin_s > longest_s and (begin_s == first_s or end_s == last_s):
            return f"none between {begin_s:.2f} and {end_s:.2f} s"
    return ""
