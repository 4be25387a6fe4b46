"""What should come out the same each time: a coefficient over campaigns, a repeated run."""

import math
import sqlite3
from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.coefficients.alike import frequency_classes, speed_classes
from hardware.description.errors import DataError
from pmm.archive.queries import Row, rows_of, the_run, what_is_there
from pmm.archive.repeats import settings_alike

FEWEST = 3  # campaigns: two others tell a scatter
_PARTS: Final = {"in_phase": "in phase", "quadrature": "quadrature"}
# CROSS: the runs come first.
_REPEATS: Final = """
SELECT coalesce(runs.recorded_utc, campaigns.recorded_utc) AS recorded_utc, runs.run,
    campaigns.campaign, campaigns.folder, campaigns.hull, harmonics.unit,
    runs.carriage_speed_m_s AS speed_m_s, runs.frequency_hz, in_phase, quadrature,
    in_phase_half_width, quadrature_half_width, NULL AS standard_uncertainty
FROM runs JOIN campaigns ON campaigns.id = runs.campaign
CROSS JOIN harmonics ON harmonics.run = runs.id
    AND gate = (SELECT min(gate) FROM harmonics WHERE run = runs.id)
WHERE channel = :channel AND ord = :order AND hull = :hull AND kind = :kind
    AND settings IN (SELECT value FROM json_each(:alike))
ORDER BY 1, campaigns.folder, runs.id
"""


@dataclass(frozen=True)
class ChartPoint:
    """One campaign's value with the limits that the others set; NaN where they are too few."""

    value: float
    low: float
    high: float

    @property
    def outside(self) -> bool:
        """Whether it lies beyond its limits."""
        return not (math.isnan(self.low) or self.low <= self.value <= self.high)


def control_chart(values: Sequence[float], probability: float) -> tuple[ChartPoint, ...]:
    """Return each value with the interval that the other values foretell for it.

    Of n values of one normal distribution the interval of each has the stated probability:
    mean of the others +- t(n - 2) s sqrt(1 + 1 / (n - 1)), s their standard deviation (Student's
    prediction interval; the same as externally studentised residuals). A value that is off does
    not widen its own limits, as it would those of all values' mean +- 3 s, beyond which nothing
    can lie for n up to 10.

    Parameters
    ----------
    probability
        Two-sided, of the limits of one value.
    """
    from scipy.special import stdtrit

    n = len(values)
    if n < FEWEST:
        return tuple(ChartPoint(value, math.nan, math.nan) for value in values)
    factor = float(stdtrit(n - 2, 0.5 + 0.5 * probability)) * math.sqrt(1.0 + 1.0 / (n - 1))
    all_values = np.asarray(values, float)
    off = all_values - all_values.mean()
    middle = all_values - off * n / (n - 1)
    squares = np.sum(off**2) - off**2 * n / (n - 1)  # of the others about their own mean
    half = factor * np.sqrt(np.maximum(squares, 0.0) / (n - 2))
    return tuple(
        ChartPoint(*map(float, point))
        for point in zip(all_values, middle - half, middle + half, strict=True)
    )


@dataclass(frozen=True)
class Trend:
    """A value over time, of one model at one speed and frequency, with its control chart."""

    name: str
    hull: str
    unit: str
    speed_m_s: float
    frequency_hz: float
    rows: tuple[Row, ...]
    chart: tuple[ChartPoint, ...]


def _trend(name: str, rows: Sequence[Row], probability: float) -> Trend:
    first = rows[0]
    return Trend(
        name,
        first["hull"],
        first["unit"],
        first["speed_m_s"],
        first["frequency_hz"],
        tuple(rows),
        control_chart([row["value"] for row in rows], probability),
    )


def coefficient_trends(
    connection: sqlite3.Connection, name: str, probability: float
) -> tuple[Trend, ...]:
    """Return a coefficient's values, earliest first, a trend for what can be compared.

    Speeds and frequencies are the same as in a campaign (:mod:`analysis.coefficients.alike`).

    Raises
    ------
    DataError
        If no campaign has it; the message names the nearest and all.
    """
    rows = rows_of(
        connection,
        "SELECT campaigns.recorded_utc, campaigns.campaign, campaigns.folder, campaigns.hull, "
        "coefficients.unit, speed_m_s, frequency_hz, value, standard_uncertainty, half_width "
        "FROM coefficients JOIN campaigns ON campaigns.id = coefficients.campaign "
        "WHERE name = ? AND value IS NOT NULL ORDER BY campaigns.recorded_utc, campaigns.folder",
        (name,),
    )
    if not rows:
        name_rows = rows_of(connection, "SELECT DISTINCT name FROM coefficients")
        hint = what_is_there("coefficients", name, [row["name"] for row in name_rows])
        raise DataError(f"no coefficient {name!r}; {hint}")
    groups: dict[tuple[str, str, bool, bool], list[Row]] = defaultdict(list)
    for row in rows:
        known = (row["speed_m_s"] is not None, row["frequency_hz"] is not None)
        groups[row["hull"], row["unit"], *known].append(row)
    return tuple(
        _trend(name, alike, probability)
        for _, group in sorted(groups.items())
        for at_speed, _ in speed_classes(group, _value_of("speed_m_s"))
        for alike, _ in frequency_classes(at_speed, _value_of("frequency_hz"))
    )


def _value_of(key: str) -> Callable[[Row], float]:
    """Return a row's value; one that is not known is 0, and stands with its like alone."""
    return lambda row: float(row[key] or 0.0)


def repeat_trends(
    connection: sqlite3.Connection,
    run: str,
    campaign: str | None,
    channel: str,
    order: int,
    probability: float,
) -> tuple[Trend, ...]:
    """Return a harmonic of all runs of one run's hull, kind and settings, earliest first.

    A run's first gate counts. In phase and quadrature are a trend each, in each unit; a mean has
    the first only.

    Raises
    ------
    ConfigurationError
        As :func:`pmm.archive.queries.the_run`.
    DataError
        If the run has no such harmonic.
    """
    set_to = the_run(connection, run, campaign)
    asked = {"channel": channel, "order": order, "alike": settings_alike(connection, set_to)}
    rows = rows_of(connection, _REPEATS, {**set_to, **asked})
    if not any((row["folder"], row["run"]) == (set_to["folder"], run) for row in rows):
        channel_rows = rows_of(
            connection, "SELECT DISTINCT channel FROM harmonics WHERE run = ?", (set_to["id"],)
        )
        hint = what_is_there("channels", channel, [row["channel"] for row in channel_rows])
        raise DataError(f"run {run!r} has no harmonic {order} of {channel!r}; {hint}")
    trends = []
    for part, part_name in _PARTS.items():
        part_rows: list[Row] = [
            {**row, "value": row[part], "half_width": row[f"{part}_half_width"]}
            for row in rows
            if row[part] is not None
        ]
        name = f"{channel}, harmonic {order}, {part_name}" if order else f"{channel}, mean"
        for unit in dict.fromkeys(row["unit"] for row in part_rows):
            same_unit = [row for row in part_rows if row["unit"] == unit]
            trends.append(_trend(name, same_unit, probability))
    return tuple(trends)
