"""Heel and roll moment of a campaign's runs, by carriage speed, heel and drift."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from operator import attrgetter
from typing import Final

import numpy as np

from analysis.attitude import AttitudeChannel
from analysis.coefficients.body_cycle import BodyCycle, at_order
from analysis.coefficients.phasors import Phasors
from analysis.kinematics.body_frame import HEEL, ROLL_MOMENT
from pmm.coefficients.workflow import CampaignOutcome
from pmm.document.content import Column, Table, data_only, number, word
from pmm.document.notation import NOT_KNOWN, rounded, written
from pmm.report.conditions import condition_columns

_DEGREES: Final = 180.0 / math.pi


@dataclass(frozen=True)
class HeelRow:
    """One run: heel in radians and the water's moment on the hull in roll, both to starboard.

    Attributes
    ----------
    held
        ``"set"`` or ``"free"``.
    moment
        ``None`` without a roll gauge.
    """

    run: str
    speed_m_s: float
    drift_rad: float
    frequency_hz: float
    held: str
    heel: AttitudeChannel
    moment: AttitudeChannel | None

    @property
    def drift_deg(self) -> float:
        """Drift, for people."""
        return math.degrees(self.drift_rad)


def _mean(row: AttitudeChannel | None, factor: float) -> str:
    return NOT_KNOWN if row is None else rounded(factor * row.mean, factor * row.mean_u)


def _first(row: AttitudeChannel | None, factor: float) -> str:
    if row is None or not row.amplitude:
        return NOT_KNOWN
    return rounded(factor * row.amplitude[0], factor * row.amplitude_u[0])


_COLUMNS: Final[tuple[Column[HeelRow], ...]] = (
    word("run", "run"),
    number("U", "speed_m_s", written("g"), "m/s"),
    Column("drift", lambda row: row.drift_deg, written=written(".3g"), unit="deg", number=True),
    word("held", "held"),
    Column("heel", lambda row: _mean(row.heel, _DEGREES), unit="deg", number=True),
    Column("heel, harmonic 1", lambda row: _first(row.heel, _DEGREES), unit="deg", number=True),
    Column("K", lambda row: _mean(row.moment, 1.0), unit="N m", number=True),
    Column("K, harmonic 1", lambda row: _first(row.moment, 1.0), unit="N m", number=True),
    *data_only("drift_rad", "frequency_hz", "heel", "moment"),
)
_SPEED: Final = attrgetter("speed_m_s")
_NOTE: Final = (
    "Heel and K, the water's moment on the hull in roll, are positive to starboard; value ± "
    "standard uncertainty. K is the mean against the zero runs, weight and inertia taken off; "
    "harmonics are amplitudes."
)


def heel_table(outcome: CampaignOutcome) -> Table[HeelRow]:
    """Return heel and roll moment of all runs of a model that heels."""
    rows = heel_rows(outcome)
    ship = outcome.settings.ship
    at = condition_columns(_SPEED, ship.length_m, outcome.water, ship.gravity_m_s2)
    columns = (*_COLUMNS, *at)
    return Table("Heel", columns, rows, "heel", titled=True, notes=(_NOTE,), filled=True)


def heel_rows(outcome: CampaignOutcome) -> list[HeelRow]:
    """Return the runs of a model that heels, by speed, heel, drift and frequency."""
    rows = _rows(outcome)
    return sorted(
        rows, key=lambda row: (row.speed_m_s, row.heel.mean, row.drift_rad, row.frequency_hz)
    )


def _rows(outcome: CampaignOutcome) -> Iterator[HeelRow]:
    for cycle in outcome.cycles:
        if cycle.heel is not None:
            yield HeelRow(
                cycle.name,
                cycle.speed_m_s,
                cycle.drift_rad,
                cycle.frequency_hz,
                str(cycle.heel.held),
                _told(cycle, cycle.hull.phasors, HEEL),
                _told(cycle, cycle.hull.phasors, ROLL_MOMENT) if cycle.has_roll else None,
            )


def _told(cycle: BodyCycle, phasors: Phasors, name: str) -> AttitudeChannel:
    """Return the mean and the first harmonic, its uncertainty that along the phasor."""
    spread, place = phasors.standard_uncertainty, phasors.index(at_order(name, 0))
    mean, mean_u = float(phasors.values[place].real), float(spread[place].real)
    if cycle.orders < 1:
        return AttitudeChannel(mean, mean_u)
    place = phasors.index(at_order(name, 1))
    value, apart = phasors.values[place], spread[place]
    size = abs(value)
    along = np.hypot(value.real * apart.real, value.imag * apart.imag) / max(size, 1e-300)
    return AttitudeChannel(mean, mean_u, (float(size),), (float(along),))
