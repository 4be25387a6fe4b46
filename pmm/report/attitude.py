"""How the model of each run sinks, trims and heels, by carriage speed and drift: two tables."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from operator import attrgetter
from typing import Any, Final, TypeVar

import numpy as np

from analysis.attitude import AttitudeChannel
from analysis.coefficients.body_cycle import BodyCycle, at_order
from analysis.coefficients.phasors import Phasors
from analysis.kinematics.body_frame import HEEL, ROLL_MOMENT
from pmm.coefficients.workflow import CampaignOutcome
from pmm.document.content import Column, Table, data_only, number, word
from pmm.document.notation import NOT_KNOWN, rounded, written
from pmm.report.conditions import condition_columns

_MM: Final = 1e3
_DEGREES: Final = 180.0 / math.pi


@dataclass(frozen=True)
class _RowOfRun:
    """A run and its condition; frequency 0 of a tow."""

    run: str
    speed_m_s: float
    drift_rad: float
    frequency_hz: float

    @property
    def drift_deg(self) -> float:
        """Drift, for people."""
        return math.degrees(self.drift_rad)


@dataclass(frozen=True)
class AttitudeRow(_RowOfRun):
    """One run: sinkage in metres, positive down, and trim in radians, positive bow up."""

    heave_and_pitch: str
    sinkage_x_m: float
    sinkage: AttitudeChannel
    trim: AttitudeChannel


@dataclass(frozen=True)
class HeelRow(_RowOfRun):
    """One run: heel in radians and the water's moment on the hull in roll, both to starboard.

    Attributes
    ----------
    held
        ``"set"`` or ``"free"``.
    moment
        ``None`` without a roll gauge.
    """

    held: str
    heel: AttitudeChannel
    moment: AttitudeChannel | None


_Row = TypeVar("_Row", bound=_RowOfRun)


def _estimate_column(
    heading: str,
    key: str,
    factor: float,
    unit: str,
    estimate_of: Callable[[Any], tuple[float, float] | None],
) -> Column[Any]:
    """Return a column of values with uncertainties of a row's channel, as far as it has them."""

    def estimate_text(row: _RowOfRun) -> str:
        channel: AttitudeChannel | None = getattr(row, key)
        estimate = None if channel is None else estimate_of(channel)
        return (
            NOT_KNOWN if estimate is None else rounded(factor * estimate[0], factor * estimate[1])
        )

    return Column(heading, estimate_text, unit=unit, number=True)


def _mean(heading: str, key: str, factor: float, unit: str) -> Column[Any]:
    return _estimate_column(
        heading, key, factor, unit, lambda channel: (channel.mean, channel.mean_u)
    )


def _harmonic(heading: str, key: str, order: int, factor: float, unit: str) -> Column[Any]:
    def amplitude(channel: AttitudeChannel) -> tuple[float, float] | None:
        if len(channel.amplitude) < order:
            return None
        return channel.amplitude[order - 1], channel.amplitude_u[order - 1]

    return _estimate_column(f"{heading}, harmonic {order}", key, factor, unit, amplitude)


_HEAD: Final[tuple[Column[Any], ...]] = (
    word("run", "run"),
    number("U", "speed_m_s", written("g"), "m/s"),
    Column("drift", lambda row: row.drift_deg, written=written(".3g"), unit="deg", number=True),
)
_CHANNELS: Final = (("sinkage", _MM, "mm"), ("trim", _DEGREES, "deg"))
_ATTITUDE: Final[tuple[Column[Any], ...]] = (
    word("heave and pitch", "heave_and_pitch"),
    *(_mean(key, key, factor, unit) for key, factor, unit in _CHANNELS),
    *(_harmonic(key, key, order, factor, unit)
      for key, factor, unit in _CHANNELS for order in (1, 2)),
    *data_only("drift_rad", "frequency_hz", "sinkage_x_m", "sinkage", "trim"),
)  # fmt: skip
_HEEL: Final[tuple[Column[Any], ...]] = (
    word("held", "held"),
    _mean("heel", "heel", _DEGREES, "deg"),
    _harmonic("heel", "heel", 1, _DEGREES, "deg"),
    _mean("K", "moment", 1.0, "N m"),
    _harmonic("K", "moment", 1, 1.0, "N m"),
    *data_only("drift_rad", "frequency_hz", "heel", "moment"),
)
_ATTITUDE_NOTE: Final = (
    "Sinkage positive down, trim positive bow up, from rest; value ± standard uncertainty. "
    "Harmonics are amplitudes at the oscillator's frequency and twice it."
)
_HEEL_NOTE: Final = (
    "Heel and K, the water's moment on the hull in roll, are positive to starboard; value ± "
    "standard uncertainty. K is the mean against the zero runs, weight and inertia taken off; "
    "harmonics are amplitudes."
)


def attitude_table(outcome: CampaignOutcome) -> Table[AttitudeRow]:
    """Return sinkage and trim of all runs that told them, by speed, drift and frequency."""
    rows = attitude_rows(outcome)
    return _table(outcome, "Sinkage and trim", "attitude", _ATTITUDE, rows, _ATTITUDE_NOTE)


def heel_table(outcome: CampaignOutcome) -> Table[HeelRow]:
    """Return heel and roll moment of all runs of a model that heels."""
    return _table(outcome, "Heel", "heel", _HEEL, heel_rows(outcome), _HEEL_NOTE)


def _table(
    outcome: CampaignOutcome,
    name: str,
    key: str,
    value_columns: tuple[Column[Any], ...],
    rows: Sequence[_Row],
    note: str,
) -> Table[_Row]:
    ship, speed = outcome.settings.ship, attrgetter("speed_m_s")
    conditions = condition_columns(speed, ship.length_m, outcome.water, ship.gravity_m_s2)
    columns = (*_HEAD, *value_columns, *conditions)
    return Table(name, columns, rows, key, titled=True, notes=(note,), filled=True)


def attitude_rows(outcome: CampaignOutcome) -> list[AttitudeRow]:
    """Return the runs that told sinkage and trim, by speed, drift and frequency."""
    rows = _attitudes(outcome)
    return sorted(rows, key=lambda row: (row.speed_m_s, row.drift_rad, row.frequency_hz))


def heel_rows(outcome: CampaignOutcome) -> list[HeelRow]:
    """Return the runs of a model that heels, by speed, heel, drift and frequency."""
    rows = _heels(outcome)
    return sorted(
        rows, key=lambda row: (row.speed_m_s, row.heel.mean, row.drift_rad, row.frequency_hz)
    )


def _attitudes(outcome: CampaignOutcome) -> Iterator[AttitudeRow]:
    cycles = {cycle.name: cycle for cycle in outcome.cycles}
    for run in outcome.runs:
        if run.attitude is not None and run.name in cycles:
            sensors = run.attitude.sensors
            yield AttitudeRow(
                *_condition(cycles[run.name]),
                str(sensors.heave_and_pitch),
                sensors.sinkage_x_m,
                run.attitude.sinkage,
                run.attitude.trim,
            )


def _heels(outcome: CampaignOutcome) -> Iterator[HeelRow]:
    for cycle in outcome.cycles:
        if cycle.heel is not None:
            phasors = cycle.hull.phasors
            yield HeelRow(
                *_condition(cycle),
                str(cycle.heel.held),
                _channel(cycle, phasors, HEEL),
                _channel(cycle, phasors, ROLL_MOMENT) if cycle.has_roll else None,
            )


def _condition(cycle: BodyCycle) -> tuple[str, float, float, float]:
    return cycle.name, cycle.speed_m_s, cycle.drift_rad, cycle.frequency_hz


def _channel(cycle: BodyCycle, phasors: Phasors, name: str) -> AttitudeChannel:
    """Return the mean and the first harmonic, its uncertainty that along the phasor."""
    spread, place = phasors.standard_uncertainty, phasors.index(at_order(name, 0))
    mean, mean_u = float(phasors.values[place].real), float(spread[place].real)
    if cycle.orders < 1:
        return AttitudeChannel(mean, mean_u)
    place = phasors.index(at_order(name, 1))
    value, value_u = phasors.values[place], spread[place]
    size = abs(value)
    along = np.hypot(value.real * value_u.real, value.imag * value_u.imag) / max(size, 1e-300)
    return AttitudeChannel(mean, mean_u, (float(size),), (float(along),))
