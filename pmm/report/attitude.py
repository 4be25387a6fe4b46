"""Sinkage and trim of a campaign's runs, by carriage speed and drift."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from operator import attrgetter
from typing import Final

from analysis.attitude import AttitudeChannel
from pmm.coefficients.workflow import CampaignOutcome
from pmm.document.content import Column, Table, data_only, number, word
from pmm.document.notation import NOT_KNOWN, rounded, written
from pmm.report.conditions import condition_columns


@dataclass(frozen=True)
class AttitudeRow:
    """One run: sinkage in metres, positive down, and trim in radians, positive bow up."""

    run: str
    speed_m_s: float
    drift_rad: float
    frequency_hz: float
    heave_and_pitch: str
    sinkage_x_m: float
    sinkage: AttitudeChannel
    trim: AttitudeChannel

    @property
    def drift_deg(self) -> float:
        """Drift, for people."""
        return math.degrees(self.drift_rad)


_MM: Final = 1e3
_DEGREES: Final = 180.0 / math.pi


def _mean(key: str, factor: float, unit: str) -> Column[AttitudeRow]:
    def told(row: AttitudeRow) -> str:
        one: AttitudeChannel = getattr(row, key)
        return rounded(factor * one.mean, factor * one.mean_u)

    return Column(key, told, unit=unit, number=True)


def _harmonic(key: str, order: int, factor: float, unit: str) -> Column[AttitudeRow]:
    def told(row: AttitudeRow) -> str:
        one: AttitudeChannel = getattr(row, key)
        if len(one.amplitude) < order:
            return NOT_KNOWN
        return rounded(factor * one.amplitude[order - 1], factor * one.amplitude_u[order - 1])

    return Column(f"{key}, harmonic {order}", told, unit=unit, number=True)


_COLUMNS: Final[tuple[Column[AttitudeRow], ...]] = (
    word("run", "run"),
    number("U", "speed_m_s", written("g"), "m/s"),
    Column("drift", lambda row: row.drift_deg, written=written(".3g"), unit="deg", number=True),
    word("heave and pitch", "heave_and_pitch"),
    *(_mean(key, factor, unit) for key, factor, unit in (
        ("sinkage", _MM, "mm"), ("trim", _DEGREES, "deg"),
    )),
    *(_harmonic(key, order, factor, unit) for key, factor, unit in (
        ("sinkage", _MM, "mm"), ("trim", _DEGREES, "deg"),
    ) for order in (1, 2)),
    *data_only("drift_rad", "frequency_hz", "sinkage_x_m", "sinkage", "trim"),
)  # fmt: skip
_SPEED: Final = attrgetter("speed_m_s")
_NOTE: Final = (
    "Sinkage positive down, trim positive bow up, from rest; value ± standard uncertainty. "
    "Harmonics are amplitudes at the oscillator's frequency and twice it."
)


def attitude_table(outcome: CampaignOutcome) -> Table[AttitudeRow]:
    """Return sinkage and trim of all runs that told them, by speed, drift and frequency."""
    rows = attitude_rows(outcome)
    ship = outcome.settings.ship
    at = condition_columns(_SPEED, ship.length_m, outcome.water, ship.gravity_m_s2)
    columns = (*_COLUMNS, *at)
    return Table(
        "Sinkage and trim", columns, rows, "attitude", titled=True, notes=(_NOTE,), filled=True
    )


def attitude_rows(outcome: CampaignOutcome) -> list[AttitudeRow]:
    """Return the runs that told sinkage and trim, by speed, drift and frequency."""
    return sorted(_rows(outcome), key=lambda row: (row.speed_m_s, row.drift_rad, row.frequency_hz))


def _rows(outcome: CampaignOutcome) -> Iterator[AttitudeRow]:
    cycles = {cycle.name: cycle for cycle in outcome.cycles}
    for one in outcome.runs:
        if one.attitude is None or one.name not in cycles:
            continue
        cycle, sensors = cycles[one.name], one.attitude.sensors
        yield AttitudeRow(
            one.name,
            cycle.speed_m_s,
            cycle.drift_rad,
            cycle.frequency_hz,
            str(sensors.heave_and_pitch),
            sensors.sinkage_x_m,
            one.attitude.sinkage,
            one.attitude.trim,
        )
