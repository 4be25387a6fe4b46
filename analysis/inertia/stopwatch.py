"""Periods by stopwatch: times of counted swings."""

import math
from dataclasses import dataclass

import numpy as np

from analysis.uncertainty.estimate import Estimate
from hardware.description.errors import DataError

REACTION_S = 0.1  # standard deviation of a person's start and stop together


@dataclass(frozen=True)
class StopwatchReading:
    """One reading: the time that a counted number of swings took."""

    swings: int
    duration_s: float


def stopwatch_period(
    readings: tuple[StopwatchReading, ...], *, reaction_s: float = REACTION_S
) -> Estimate:
    """Return the period of one swing.

    Several readings give their mean and the scatter between them; a single one rests on the
    person's reaction.

    Raises
    ------
    DataError
        Under three swings in a reading, a duration not above zero, and for readings that differ
        by more than half a swing (miscounted).
    """
    for number, reading in enumerate(readings, 1):
        if reading.swings < 3 or not reading.duration_s > 0.0:
            raise DataError(
                f"stopwatch reading {number}: {reading.swings} swing(s) in "
                f"{reading.duration_s:g} s; too few swings, at least 3 in a time above 0"
            )
    if not readings:
        raise DataError("no stopwatch reading; at least one is needed")
    periods = np.array([reading.duration_s / reading.swings for reading in readings])
    swings = np.array([float(reading.swings) for reading in readings])
    usual = float(np.median(periods))
    off = np.abs(periods / usual - 1.0) * swings
    if off.max() > 0.5:
        worst = int(np.argmax(off))
        raise DataError(
            f"stopwatch reading {worst + 1}: {periods[worst]:.4g} s a swing against {usual:.4g} s "
            f"of the others: {off[worst]:.2g} swings over {swings[worst]:.0f}; miscounted?"
        )
    reaction = float(reaction_s * math.sqrt((1.0 / swings**2).sum()) / swings.size)
    if periods.size < 2:
        return Estimate.of(usual, reaction, "s")
    scatter = float(periods.std(ddof=1)) / math.sqrt(periods.size)
    if scatter > reaction:
        return Estimate.of(float(periods.mean()), scatter, "s", float(periods.size - 1))
    return Estimate.of(float(periods.mean()), reaction, "s")
