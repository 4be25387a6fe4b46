"""From the struts' harmonics to the model's in body axes, exactly, with all that is uncertain.

What is stated of the struts and of the geometry (:mod:`analysis.coefficients.stated_uncertainties`)
acts here, as a slope beside the scatter: an amplitude, a lag, the spacing, the speed move the
model's motion and loads, and with these all coefficients.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from analysis.coefficients.phasors import Phasors, interleaved
from analysis.coefficients.stated_uncertainties import STATED
from analysis.coefficients.tare import Tare
from analysis.kinematics.body_frame import CHANNELS, HEEL, ROLL_MOMENT, UNIT_OF, in_body_axes
from analysis.kinematics.complex_step import by_parts, pointwise
from analysis.kinematics.cycle import driven, harmonics, per_part, waves
from analysis.kinematics.geometry import Geometry, Waves
from analysis.kinematics.motion import DrivenDisplacements
from hardware.description.arrays import ComplexArray, FloatArray

_AFT, _FORE = 0, 1
GAUGES, SURGE_GAUGE = 2, 4  # among a strut cycle's channels: the first of them, and force_x
_DRIVEN = ((0, 0), (1, 0), (0, 1), (1, 1), (0, 2), (1, 2))  # channel, times differentiated
_GEOMETRY = ("half_spacing_m", "speed_m_s", "alignment_rad")


def at_order(name: str, order: int) -> str:
    """Return what a phasor of a cycle is called."""
    return f"{name} {order}"


def labels(channels: Sequence[str], orders: int) -> tuple[str, ...]:
    """Return the names of all phasors, order by order."""
    return tuple(at_order(name, n) for n in range(orders + 1) for name in channels)


@dataclass(frozen=True, eq=False)
class InBodyAxes:
    """The model's phasors, and how they follow what is stated.

    Attributes
    ----------
    phasors
        Of :data:`analysis.kinematics.body_frame.CHANNELS`, order by order; the rotation from where
        the drift sets the model.
    sensitivity
        Slope of the phasors' real numbers by each stated quantity, shape ``(2 n, len(STATED))``.
    tare
        Where the drift sets the model, and what a zero run there takes off.
    """

    phasors: Phasors
    sensitivity: FloatArray
    tare: Tare


def of_struts(
    struts: Phasors,
    geometry: Geometry,
    frequency_hz: float,
    orders: int,
    *,
    asked: bool,
    roll: tuple[str, ...] = (),
) -> InBodyAxes:
    """Return the model's phasors about the midpoint.

    It raises what :func:`analysis.kinematics.body_frame.in_body_axes` raises.

    Parameters
    ----------
    struts
        Displacements and gauges of the aft and the fore strut, with or without ``force_x``, and
        those that ``roll`` names, order by order.
    geometry
        Numbers, not arrays.
    asked
        Whether the displacements are the set-point's: the photocell's latency acts on them.
    roll
        Which of roll moment and heel stand behind the gauges.
    """
    channels = len(struts.names) // (orders + 1)
    omega = 2.0 * math.pi * frequency_hz
    driven = (*_DRIVEN, *((k, 0) for k in range(2, channels)))
    maps = per_part(orders + 1, channels, driven, omega)
    parts = struts.real.values
    stated = np.array([[value] for value in _stated_geometry(geometry)])
    inputs = np.concatenate((parts @ maps, stated * np.ones(maps.shape[-1])))
    values, slope = pointwise(lambda waves: _model(geometry, waves, len(roll)), inputs)
    gauged = len(driven)
    by_struts = by_parts(slope[:, :gauged], maps, orders)
    harmonics_of_body = harmonics(values, orders)
    harmonics_of_body[2] -= geometry.drift_rad
    names = (*CHANNELS[: len(values) - len(roll)], *roll)
    phasors = Phasors(
        labels(names, orders),
        tuple(UNIT_OF[name] for name in names) * (orders + 1),
        struts.real.carried(harmonics_of_body, by_struts),
    )
    sensitivity = by_struts @ _by_stated(struts.values, channels, omega, roll, asked=asked)
    for k, name in enumerate(_GEOMETRY):
        sensitivity[:, STATED.index(name)] += harmonics(slope[:, gauged + k], orders)
    speeding = slope[:, gauged + _GEOMETRY.index("speed_m_s")] * _rate(geometry, omega)
    sensitivity[:, STATED.index("speed_age_s")] += harmonics(speeding, orders)
    sensitivity[2, STATED.index("alignment_rad")] -= 1.0  # the rotation is from the drift
    faster = slope[:, 2:4] * inputs[2:4] + 2.0 * slope[:, 4:6] * inputs[4:6]
    sensitivity[:, STATED.index("frequency_relative")] += harmonics(faster.sum(axis=1), orders)
    moved = _moved(harmonics_of_body.reshape(orders + 1, len(names), 2), geometry, omega)
    sensitivity[:, STATED.index("midpoint_x_m")] += moved.ravel()
    moving = DrivenDisplacements(inputs[0:2], inputs[2:4], inputs[4:6])
    gauges = channels - 2 - len(roll)
    return InBodyAxes(phasors, sensitivity, Tare.of(geometry, moving, gauges))


def parts_of_struts(
    readings: ComplexArray, geometry: Geometry, omega: FloatArray, rolling: int = 0
) -> tuple[FloatArray, Tare]:
    """Return the interleaved parts and the ``tare`` of :func:`of_struts` alone, of many runs.

    It raises what :func:`of_struts` raises.

    Parameters
    ----------
    readings
        Displacements and gauges, shape ``(runs, orders + 1, 4 or more)``; roll moment and heel
        last, ``rolling`` of them.
    geometry
        Speed and drift of shape ``(runs, 1)``.
    omega
        Angular frequencies, rad/s, shape ``(runs,)``.
    """
    runs, count, channels = readings.shape
    moved = driven(interleaved(readings[..., :2].reshape(runs, -1)), omega)
    read = waves(interleaved(readings[..., 2:].reshape(runs, -1)), channels - 2)
    gauges = channels - 2 - rolling
    parts = harmonics(in_body_axes(geometry, moved, *_split(read, gauges)), count - 1)
    parts[:, 2] -= np.ravel(geometry.drift_rad)
    return parts, Tare.of(geometry, moved, gauges)


def _split(readings: Waves, gauges: int) -> tuple[Waves, Waves | None]:
    """Return the struts' gauges, and roll moment and heel where there are any."""
    behind = readings[..., gauges:, :]
    return readings[..., :gauges, :], behind if behind.shape[-2] else None


def _rate(geometry: Geometry, omega: float) -> Waves:
    """Return the acceleration of a carriage that follows a path, m/s2; 0 of one that does not."""
    varies = np.atleast_1d(geometry.varies_m_s)
    order = np.arange(varies.size // 2 + 1)
    return np.asarray(np.fft.irfft(1j * omega * order * np.fft.rfft(varies), varies.size))


def _stated_geometry(geometry: Geometry) -> tuple[float, ...]:
    return (
        float(geometry.half_spacing_m),
        float(geometry.speed_m_s),
        float(geometry.drift_rad),
    )


def _model(geometry: Geometry, waves: Waves, rolling: int) -> Waves:
    half, speed, drift = (waves[..., -3 + k, :] for k in range(3))
    exact = replace(geometry, half_spacing_m=half, speed_m_s=speed, drift_rad=drift)
    driven = DrivenDisplacements(waves[..., 0:2, :], waves[..., 2:4, :], waves[..., 4:6, :])
    readings = waves[..., 6:-3, :]
    return in_body_axes(exact, driven, *_split(readings, readings.shape[-2] - rolling))


def _by_stated(
    values: ComplexArray, channels: int, omega: float, roll: tuple[str, ...], *, asked: bool
) -> FloatArray:
    """How the struts' phasors follow what is stated of displacements and gauges."""
    shaped = values.reshape(-1, channels)
    order = np.arange(len(shaped))
    aft, fore = GAUGES + _AFT, GAUGES + _FORE
    later = 1j * omega * order
    moves: dict[str, dict[int, ComplexArray]] = {
        "amplitude_relative": {_AFT: shaped[:, _AFT], _FORE: shaped[:, _FORE]},
        "strut_phase_rad": {_FORE: 1j * order * shaped[:, _FORE]},
        "lag_s": {aft: later * shaped[:, aft], fore: later * shaped[:, fore]},
        "skew_s": {fore: later * shaped[:, fore]},
        "force_gain_relative": {aft: shaped[:, aft], fore: shaped[:, fore]},
        "gauge_aft_relative": {aft: shaped[:, aft]},
        "gauge_fore_relative": {fore: shaped[:, fore]},
        "cross_talk_aft": {aft: shaped[:, fore]},
        "cross_talk_fore": {fore: shaped[:, aft]},
    }
    if asked:
        moves["latency_s"] = {_AFT: later * shaped[:, _AFT], _FORE: later * shaped[:, _FORE]}
    if channels - len(roll) > SURGE_GAUGE:
        moves["surge_gauge_relative"] = {SURGE_GAUGE: shaped[:, SURGE_GAUGE]}
    if ROLL_MOMENT in roll:
        place = channels - len(roll) + roll.index(ROLL_MOMENT)
        moves["roll_gauge_relative"] = {place: shaped[:, place]}
    sensitivity = np.zeros((len(shaped), channels, 2, len(STATED)))
    if HEEL in roll:
        sensitivity[0, channels - 1, 0, STATED.index("heel_rad")] = 1.0
    for name, columns in moves.items():
        for channel, change in columns.items():
            sensitivity[:, channel, 0, STATED.index(name)] = change.real
            sensitivity[:, channel, 1, STATED.index(name)] = change.imag
    return sensitivity.reshape(2 * len(values), len(STATED))


def _moved(parts: FloatArray, geometry: Geometry, omega: float) -> FloatArray:
    """How motion and loads follow the place of the midpoint on the model, ahead."""
    rotation = parts[:, 1, 0] + 1j * parts[:, 1, 1]
    turning = 1j * omega * np.arange(len(parts)) * rotation
    changed = np.zeros_like(parts)
    for channel, change in (
        (0, -geometry.side * rotation),
        (3, -geometry.side * turning),
        (5, geometry.side * (parts[:, 4, 0] + 1j * parts[:, 4, 1])),
    ):
        changed[:, channel, 0], changed[:, channel, 1] = change.real, change.imag
    return changed
