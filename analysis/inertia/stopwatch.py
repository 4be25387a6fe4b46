"""Periods by stopwatch: times of counted swings."""

import math
from dataclasses import dataclass, replace

import numpy as np

from analysis.inertia.repeats import RepeatedValue
from analysis.uncertainty.estimate import Estimate, joint
from analysis.uncertainty.redundancy import scattered_fit
from hardware.description.errors import DataError

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
    subject: str = "stopwatch",
) -> RepeatedValue:
    """Return the period of one swing.

    Several readings give their mean and the scatter between them; a single one rests on the
    person's reaction.

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
    count = len(reading_periods)
    mean = Estimate(joint(reading_periods).mapped(np.full((1, count), 1.0 / count)), "s")
    if count < 2:
        return RepeatedValue(mean, (usual,), math.nan)
    names = [f"reading {k}" for k in range(1, count + 1)]
    agreement = scattered_fit(
        np.ones((count, 1)),
        periods,
        subject=subject,
        results=("period_s",),
        data=names,
    )
    reactions = np.array([period.uncertainty for period in reading_periods])
    chi_squared = float((((periods - mean.value) / reactions) ** 2).sum())
    scatter = float(periods.std(ddof=1))
    between = scatter / math.sqrt(periods.size)
    estimate, wide, cause = mean, 1.0, ""
    if between > mean.uncertainty:
        estimate = Estimate.of(mean.value, between, "s", float(periods.size - 1))
        wide, cause = between / mean.uncertainty, "the scatter between readings"
    agreement = replace(agreement, chi_squared=chi_squared, widening=wide, cause=cause)
    return RepeatedValue(
        estimate,
        tuple(periods.tolist()),
        scatter,
        agreement.flags(),
        (agreement,),
    )


def _check_readings(readings: tuple[StopwatchReading, ...]) -> None:
    for number, reading in enumerate(readings, 1):
        if reading.swings < 3 or not reading.duration_s > 0.0:
            raise DataError(
                f"stopwatch reading {number}: {reading.swings} swing(s) in "
                f"{reading.duration_s:g} s; too few swings, at least 3 in a time above 0"
            )
    if not readings:
        raise DataError("no stopwatch reading; at least one is needed")
