"""Periods by stopwatch: times of counted swings."""

import math
from dataclasses import dataclass

import numpy as np

from analysis.inertia.repeats import KnownScatter, RepeatedValue, combine_runs
from analysis.uncertainty.estimate import Estimate
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

REACTION_S = 0.1  # standard deviation of a person's start and stop together


@dataclass(frozen=True)
class StopwatchReading:
    """One reading: the time that a counted number of swings took."""

    swings: int
    duration_s: float


def stopwatch_period(
    readings: tuple[StopwatchReading, ...],
    *,
    reaction_s: float = REACTION_S,
    known_scatter: KnownScatter | None = None,
    subject: str = "stopwatch",
) -> RepeatedValue:
    """Return the period of one swing.

    Several readings give their mean and the scatter between them; a single one rests on the
    scatter known from earlier, or else on the person's reaction and is flagged.

    Parameters
    ----------
    known_scatter
        Of the periods of single readings, s; see :func:`~analysis.inertia.repeats.combine_runs`.

    Raises
    ------
    DataError
        Under three swings in a reading, a duration not above zero, and for readings that differ
        by more than half a swing (miscounted).
    """
    _check_readings(readings)
    periods = np.array([reading.duration_s / reading.swings for reading in readings])
    swings = np.array([float(reading.swings) for reading in readings])
    usual = float(np.median(periods))
    miscount = np.abs(periods / usual - 1.0) * swings
    if miscount.max() > 0.5:
        worst = int(np.argmax(miscount))
        raise DataError(
            f"stopwatch reading {worst + 1}: {periods[worst]:.4g} s a swing against {usual:.4g} s "
            f"of the others: {miscount[worst]:.2g} swings over {swings[worst]:.0f}; miscounted?"
        )
    reading_periods = [
        Estimate.of(float(period), reaction_s / swing_count, "s")
        for period, swing_count in zip(periods, swings, strict=True)
    ]
    if len(reading_periods) < 2 and known_scatter is None:
        message = (
            f"{subject}: one reading only; a reaction ({reaction_s:.2g} s) stands in for "
            "the scatter between releases: repeat the release, or give known_scatter_s"
        )
        flag = Flag("single_run", Severity.WARNING, message)
        return RepeatedValue(reading_periods[0], (usual,), math.nan, (flag,))
    names = [f"reading {k}" for k in range(1, len(reading_periods) + 1)]
    return combine_runs(reading_periods, known_scatter=known_scatter, subject=subject, names=names)


def _check_readings(readings: tuple[StopwatchReading, ...]) -> None:
    for number, reading in enumerate(readings, 1):
        if reading.swings < 3 or not reading.duration_s > 0.0:
            raise DataError(
                f"stopwatch reading {number}: {reading.swings} swing(s) in "
                f"{reading.duration_s:g} s; too few swings, at least 3 in a time above 0"
            )
    if not readings:
        raise DataError("no stopwatch reading; at least one is needed")
