"""A simulated run: as the dataset that a recorder would have written, or one period of it."""

import json
import math
from dataclasses import asdict, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from hardware.description import dataset as schema
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from hardware.description.flags import Flag, Severity
from hardware.description.setpoint import SetPoint
from hardware.description.version import program
from sim import signals
from sim.periodic import SteadyState, steady_state
from sim.rig import SimulatedRig
from sim.signals import Signals
from sim.solve.period import Period

if TYPE_CHECKING:
    import xarray as xr


# Samples of a simulated run: an hour at 2.7 kHz. Some 30 signals are held at a time, 2.4 GB.
MOST = 1e7


# Of the highest line: what a cubic force makes of it is kept. Points of a period, per order kept.
_OVERTONES, _POINTS = 3, 4


_FINITE = (
    "strut_phase_rad", "carriage_speed_m_s", "drift_rad", "rudder_angle_rad", "revolutions_hz",
    "heel_rad", "turn_rate_rad_s", "release_rad",
    "wave_frequency_hz", "wave_amplitude_m", "wave_heading_rad",
)  # fmt: skip


def simulate(
    rig: SimulatedRig,
    set_point: SetPoint,
    *,
    periods: int,
    settling_periods: int = 3,
    sample_rate_hz: float = 200.0,
    seed: int,
    name: str = "simulated",
) -> "xr.Dataset":
    """Simulate one run and return its record.

    The record is in the schema of :mod:`hardware.description.dataset`; its clock starts with the
    record, and so do the drifts of the dynamometers' zeros and of the channels.

    Parameters
    ----------
    periods
        Whole periods wanted between photocell pulses. The record is one period longer than that, so
        that they fit in wherever the shaft stands when the record begins.
    settling_periods
        Periods that pass before the record begins.
    seed
        Of all noise: the same seed gives the same record.

    Raises
    ------
    ConfigurationError
        If the oscillator cannot run the set-point, if a strut would have to carry more than it may,
        or if another argument is out of range.
    """
    timing = periods, settling_periods, sample_rate_hz
    run, skipped = signals_of_run(rig, set_point, *timing, seed)
    flags = _overloads(rig, run) + _ramp_in_record(rig, skipped / sample_rate_hz)
    attributes: dict[str, str | float] = {
        schema.ATTR_SCHEMA: schema.SCHEMA,
        schema.ATTR_NAME: name,
        schema.ATTR_SAMPLE_RATE: float(sample_rate_hz),
        schema.ATTR_SET_POINT: json.dumps(asdict(set_point)),
        schema.ATTR_PROVENANCE: json.dumps(_provenance(rig, seed, settling_periods)),
        schema.ATTR_FLAGS: json.dumps([asdict(flag) for flag in flags]),
    }
    return _dataset(rig, run, skipped, sample_rate_hz, attributes)


def signals_of_run(
    rig: SimulatedRig,
    set_point: SetPoint,
    periods: int,
    settling_periods: int,
    sample_rate_hz: float,
    seed: int,
) -> tuple[Signals, int]:
    """Return every signal of a run by name, and how many samples pass before the record begins.

    For parameters and errors see :func:`simulate`.
    """
    _check_arguments(set_point, periods, settling_periods, sample_rate_hz, seed)
    samples_per_period = sample_rate_hz / set_point.frequency_hz
    skipped = math.ceil(settling_periods * samples_per_period)
    count = math.ceil((periods + 1) * samples_per_period) + 1
    zeroed = _zeroed(rig, skipped / sample_rate_hz)
    chain = zeroed.chain(set_point)
    _, run = chain.run(chain.start(sample_rate_hz, seed), skipped + count)
    _check_strut_forces(rig, run)
    return run, skipped


def steady_run(
    rig: SimulatedRig, set_point: SetPoint, *, orders: int = 12, points: int = 128
) -> SteadyState:
    """Return the periodic steady state of a rig at a set-point; see :func:`steady_state`."""
    if set_point.lines:
        orders = max(orders, _OVERTONES * max(line.order for line in set_point.lines))
        points = max(points, _POINTS * orders)
    return steady_state(rig.chain(set_point), Period(set_point.frequency_hz, orders, points))


def _zeroed(rig: SimulatedRig, time_s: float) -> SimulatedRig:
    """Return the rig with all drifts zero at this time."""
    return replace(
        rig,
        dynamometers=rig.dynamometers.drifting_from(time_s),
        acquisition=rig.acquisition.drifting_from(time_s),
    )


def _check_arguments(
    set_point: SetPoint, periods: int, settling_periods: int, sample_rate_hz: float, seed: int
) -> None:
    faults = []
    if periods < 1:
        faults.append(f"periods = {periods} must be at least 1")
    if settling_periods < 0:
        faults.append(f"settling_periods = {settling_periods} must not be negative")
    if not (math.isfinite(sample_rate_hz) and sample_rate_hz > 2.0 * set_point.frequency_hz):
        faults.append(
            f"sample_rate_hz = {sample_rate_hz:g} must exceed twice the frequency "
            f"of {set_point.frequency_hz:g} Hz"
        )
    else:
        faults += _too_many(set_point.frequency_hz, settling_periods + periods + 1, sample_rate_hz)
    for field in _FINITE:
        value = getattr(set_point, field)
        if not math.isfinite(value):
            faults.append(f"{field} = {value} of the set-point must be a finite number")
    if seed < 0:
        faults.append(f"seed = {seed} must not be negative")
    if faults:
        raise ConfigurationError("; ".join(faults))


def _too_many(frequency_hz: float, periods: int, sample_rate_hz: float) -> list[str]:
    """Return what is to be said of a run that no memory holds."""
    if periods * sample_rate_hz / frequency_hz <= MOST:
        return []
    return [
        f"{periods} periods at {frequency_hz:g} Hz are more than {MOST:g} samples at "
        f"{sample_rate_hz:g} Hz; lower periods or sample_rate_hz"
    ]


def _check_strut_forces(rig: SimulatedRig, run: Signals) -> None:
    limit = rig.oscillator.force_per_strut_n
    for signal in (signals.FORCE_AFT, signals.FORCE_FORE):
        peak = _peak(run[signal.name])
        if peak > limit:
            raise ConfigurationError(
                f"{signal.name} would reach {peak:.4g} N, beyond the {limit:.4g} N that a strut of "
                f"the {rig.oscillator.plane} oscillator may carry (force_per_strut_n); "
                f"lower the frequency or the eccentricity"
            )


def _overloads(rig: SimulatedRig, run: Signals) -> tuple[Flag, ...]:
    """Flag each dynamometer whose force goes beyond its full scale."""
    overloads = []
    for signal in (signals.FORCE_AFT, signals.FORCE_FORE):
        peak, limit = _peak(run[signal.name]), _gauge_full_scale(rig, signal.name)
        if limit is not None and peak > limit:
            message = (
                f"{signal.name}: {peak:.4g} N is beyond the dynamometer's full scale of "
                f"{limit:.4g} N; lower the frequency or the eccentricity"
            )
            overloads.append(Flag("dynamometer-overload", Severity.WARNING, message, signal.name))
    return tuple(overloads)


def _ramp_in_record(rig: SimulatedRig, settling_s: float) -> tuple[Flag, ...]:
    ramp_s = rig.drive.start_ramp_s
    if ramp_s <= settling_s:
        return ()
    message = (
        f"the drive's start ramp of {ramp_s:g} s outlasts the settling time of {settling_s:g} s: "
        f"the record begins before the shaft is at speed; use more settling periods"
    )
    return (Flag("start-ramp-in-record", Severity.WARNING, message),)


def _dataset(
    rig: SimulatedRig,
    run: Signals,
    skipped: int,
    sample_rate_hz: float,
    attributes: dict[str, str | float],
) -> "xr.Dataset":
    """Put the recorded samples after the skipped ones into the dataset's schema."""
    import xarray as xr

    variables: dict[str, tuple[str, FloatArray, dict[str, str | float]]] = {}
    for line in rig.acquisition.lines:
        values = run[signals.recorded(line.channel).name][skipped:]
        units: dict[str, str | float] = {schema.UNITS: line.channel.unit}
        limit = full_scale(rig, line.channel.name, line.digitiser.full_scale)
        if limit is not None:
            units[schema.FULL_SCALE] = limit
        variables[line.channel.name] = (schema.TIME, values, units)
    count = run[signals.SHAFT_ANGLE.name].size - skipped
    edges_s = edges_of(run, skipped, sample_rate_hz)
    if edges_s is not None:
        variables[schema.EDGE_TIME] = (schema.EDGE, edges_s, {schema.UNITS: "s"})
    time_s = (schema.TIME, np.arange(count) / sample_rate_hz, {schema.UNITS: "s"})
    return xr.Dataset(variables, coords={schema.TIME: time_s}, attrs=attributes)


def edges_of(run: Signals, skipped: int, sample_rate_hz: float) -> FloatArray | None:
    """Return the times of the photocell's pulses within the record; ``None`` without one."""
    if signals.PHOTOCELL_EDGE_TIME.name not in run:
        return None
    edges_s = run[signals.PHOTOCELL_EDGE_TIME.name] - skipped / sample_rate_hz
    last_s = (run[signals.SHAFT_ANGLE.name].size - skipped - 1) / sample_rate_hz
    return np.asarray(edges_s[(edges_s >= 0.0) & (edges_s <= last_s)], np.float64)


def full_scale(rig: SimulatedRig, channel: str, converter: float | None) -> float | None:
    """Return the smaller of the limits that dynamometer and converter set for a channel."""
    limits = (_gauge_full_scale(rig, channel), converter)
    return min((limit for limit in limits if limit is not None), default=None)


def _gauge_full_scale(rig: SimulatedRig, channel: str) -> float | None:
    gauges = {
        signals.FORCE_AFT.name: rig.dynamometers.aft,
        signals.FORCE_FORE.name: rig.dynamometers.fore,
    }
    return gauges[channel].full_scale_n if channel in gauges else None


def _provenance(rig: SimulatedRig, seed: int, settling_periods: int) -> dict[str, str]:
    """Return what it takes to simulate the same run again, text to text."""
    return {
        "origin": "simulated",
        "simulator": program(),
        "seed": str(seed),
        "settling_periods": str(settling_periods),
        "rig": json.dumps(asdict(rig), default=_as_list),
    }


def _as_list(matrix: FloatArray) -> list[Any]:
    """Return a matrix as JSON can hold it."""
    return list(matrix.tolist())


def _peak(values: FloatArray) -> float:
    return float(np.abs(values).max())
