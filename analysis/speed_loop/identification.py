"""A speed loop found from a record of its shaft: the speed is changed, the angle looks late.

A drive in profile velocity follows a trapezoid: constant speed, a ramp of constant acceleration,
constant speed. What the ramp asks of the shaft is a load, the inertia's J a and the bearings' b w,
and the angle falls behind by what the loop gives way. Each corner of the trapezoid is a step of
that load, so the whole is a sum of the loop's responses to a step and a ramp, in closed form.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from analysis.speed_loop.loop import ShaftLoop
from analysis.uncertainty.estimate import Estimate
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from hardware.description.motor import Servo, ShuntMotor

_FEWEST: Final = 50  # samples: some ten for each number that is found
_SEEN: Final = 10.0  # standard deviations of the angle's noise by which the ramps have to show
_BEARING: Final = 0.1  # rad/s, viscous friction over inertia, to begin with
_GRID_S: Final = 1e-3  # between it the loop's responses are taken as straight: 1e-7 rad off at most


@dataclass(frozen=True)
class SpeedRecord:
    """A shaft whose speed is changed while its angle is recorded.

    Attributes
    ----------
    time_s, angle_rad
        Of the samples, shape ``(n,)``; the angle never wraps.
    speed_rad_s
        At the beginning, settled.
    changes
        When the drive was told, and which speed (rad/s), in the order of time.
    acceleration_rad_s2
        Of its ramps.
    """

    time_s: FloatArray
    angle_rad: FloatArray
    speed_rad_s: float
    changes: Sequence[tuple[float, float]]
    acceleration_rad_s2: float

    @property
    def corners(self) -> list[tuple[float, float]]:
        """When the trapezoid's acceleration changes, and by how much (rad/s2)."""
        corners, speed = [], self.speed_rad_s
        for at_s, target in self.changes:
            slope = math.copysign(self.acceleration_rad_s2, target - speed)
            corners += [(at_s, slope), (at_s + (target - speed) / slope, -slope)]
            speed = target
        return corners


@dataclass(frozen=True)
class IdentifiedLoop:
    """What a record tells of a loop whose integral gain is as stated.

    Attributes
    ----------
    loop
        With the numbers that were found.
    inertia
        Of all that turns, at the shaft, in kg m2.
    proportional
        The gain, in the motor's unit; ``None`` where it is taken as stated, since nothing else
        gives the scale.
    bearing
        Viscous, in N m s/rad.
    latency_s
        From the command to the ramp, less that of the encoder.
    noise_rad
        Standard deviation of what is left.
    lag_rad, fitted_rad
        By how much the angle is behind the trapezoid, measured and of the loop found; one value a
        sample.
    """

    loop: ShaftLoop
    inertia: Estimate
    proportional: Estimate | None
    bearing: Estimate
    latency_s: Estimate
    noise_rad: float
    lag_rad: FloatArray
    fitted_rad: FloatArray


def identified(
    record: SpeedRecord, motor: Servo | ShuntMotor, delay_s: float = 0.0
) -> IdentifiedLoop:
    """Find inertia, proportional gain, bearing and latency by least squares.

    Parameters
    ----------
    delay_s
        Dead time in the loop. A record can hardly tell it from inertia and friction, so it is
        taken to lie between 0 and twice as much, and what that makes uncertain is counted.

    Raises
    ------
    ConfigurationError
        If the record is too short, its speed never changes, or the ramps do not show in it.
    """
    if len(record.time_s) < _FEWEST or not record.changes:
        raise ConfigurationError(
            f"{len(record.time_s)} samples and {len(record.changes)} changes of speed; "
            f"{_FEWEST} samples with one change at least tell a loop"
        )
    stated = np.array([motor.shaft_inertia_kg_m2, motor.loop.proportional, motor.bearing_n_m_s, 0])
    none = _fit(record, motor, 0.0, stated)
    fit = most = none
    if delay_s:
        fit = _fit(record, motor, delay_s, none.numbers)
        most = _fit(record, motor, 2.0 * delay_s, fit.numbers)
    if not np.ptp(fit.lag_rad) > _SEEN * fit.noise_rad:
        raise ConfigurationError(
            f"the ramps move the shaft by {np.ptp(fit.lag_rad):.2g} rad, its angle scatters by "
            f"{fit.noise_rad:.2g} rad: change the speed by more, or with a larger acceleration"
        )
    by_delay = np.abs(most.numbers - none.numbers) / math.sqrt(12.0)
    units = ("kg m2", "", "N m s/rad", "s")
    inertia, gain, bearing, latency = (
        Estimate.of(float(value), float(u), unit, fit.freedom).widened(float(delay_spread))
        for value, u, delay_spread, unit in zip(
            fit.numbers, fit.spread, by_delay, units, strict=True
        )
    )
    return IdentifiedLoop(
        _loop_with(motor, fit.numbers, delay_s),
        inertia,
        gain if _gain_shows(motor) else None,
        bearing,
        latency,
        fit.noise_rad,
        fit.lag_rad - fit.left_rad,
        fit.lag_rad,
    )


def _gain_shows(motor: Servo | ShuntMotor) -> bool:
    """Whether the proportional gain can be told: the integral one gives the scale then."""
    return motor.loop.integral > 0.0 and motor.loop.proportional > 0.0


@dataclass(frozen=True)
class _Fit:
    """Inertia, gain, bearing and latency at one dead time, their spread, and what they leave."""

    numbers: FloatArray
    spread: FloatArray
    noise_rad: float
    freedom: float
    lag_rad: FloatArray
    left_rad: FloatArray


def _fit(record: SpeedRecord, motor: Servo | ShuntMotor, delay_s: float, start: FloatArray) -> _Fit:
    from scipy.optimize import least_squares

    free = [0, 1, 2, 3] if _gain_shows(motor) else [0, 2, 3]
    scale = np.array([start[0], start[1] or 1.0, start[0], 0.01])
    lowest = np.array([1e-3, 1e-3, 0.0, -np.inf])
    # What the clock of the drive and the place of its zero add: a line, taken off both.
    line = np.stack([np.ones_like(record.time_s), record.time_s - record.time_s.mean()], axis=1)
    basis = np.linalg.qr(line)[0]
    command_rad = _trapezoid_angle(record, 0.0)

    def numbers(scaled: FloatArray) -> FloatArray:
        all_four = start.copy()
        all_four[free] = scaled * scale[free]
        return all_four

    def lag(scaled: FloatArray) -> FloatArray:
        return _lag(record, _loop_with(motor, numbers(scaled), delay_s), numbers(scaled))

    def residual(scaled: FloatArray) -> FloatArray:
        error = record.angle_rad - command_rad + lag(scaled)
        return np.asarray(error - basis @ (basis.T @ error))

    begin = start / scale
    begin[2] += _BEARING  # off its bound, from which a search hardly leaves
    outcome = least_squares(
        residual, begin[free], bounds=(lowest[free], np.inf), x_scale="jac", ftol=1e-10, xtol=1e-10
    )
    freedom = len(record.time_s) - len(free) - line.shape[1]
    noise = math.sqrt(2.0 * outcome.cost / freedom)
    jacobian, spread = np.asarray(outcome.jac), np.zeros(4)
    inverse = np.linalg.inv(jacobian.T @ jacobian)
    spread[free] = noise * scale[free] * np.sqrt(np.diag(inverse))
    return _Fit(numbers(outcome.x), spread, noise, freedom, lag(outcome.x), residual(outcome.x))


def _loop_with(motor: Servo | ShuntMotor, numbers: FloatArray, delay_s: float) -> ShaftLoop:
    """Return the loop with inertia, proportional gain and bearing of the numbers."""
    inertia, gain, bearing, _ = map(float, numbers)
    controller = replace(motor.loop, proportional=gain)
    turned = replace(motor, loop=controller, bearing_n_m_s=bearing)
    return ShaftLoop(turned, controller, inertia - motor.shaft_inertia_kg_m2, delay_s)


def _trapezoid_angle(record: SpeedRecord, late_s: float) -> FloatArray:
    """Return the trapezoid's angle from the first sample on, so much later."""
    since = record.time_s - record.time_s[0]
    angle = record.speed_rad_s * since
    for at_s, jump in record.corners:
        angle = angle + jump / 2.0 * np.maximum(record.time_s - at_s - late_s, 0.0) ** 2
    return np.asarray(angle)


def _lag(record: SpeedRecord, loop: ShaftLoop, numbers: FloatArray) -> FloatArray:
    """Return by how much the shaft is behind the trapezoid that begins when it was told."""
    inertia, _, bearing, late_s = map(float, numbers)
    span_s = float(record.time_s[-1] - record.corners[0][0]) + max(-late_s, 0.0)
    count = math.ceil(span_s / _GRID_S) + 2
    response = _angles(loop, inertia, bearing, count)
    grid = _GRID_S * np.arange(len(response))
    behind = _trapezoid_angle(record, 0.0) - _trapezoid_angle(record, late_s)
    for at_s, jump in record.corners:
        since = np.maximum(record.time_s - at_s - late_s, 0.0)
        behind = behind - jump * np.interp(since, grid, response)
    return behind


def _angles(loop: ShaftLoop, inertia: float, bearing: float, count: int) -> FloatArray:
    """Return the angle that the load ``inertia + bearing t`` gives, at ``count`` steps or more.

    Angle, load and the load's slope are taken as states, so that the steps are powers of one
    matrix; each pass has twice as many.
    """
    from scipy.linalg import expm

    system = loop.speed_per_load
    n = system.nstates
    rates = np.zeros((n + 3, n + 3))
    rates[:n, :n], rates[:n, [n + 1]] = system.A, system.B
    rates[n, :n], rates[n + 1, n + 2] = system.C[0], 1.0
    states = np.zeros((n + 3, 1))
    states[n + 1 :, 0] = inertia, bearing
    further = expm(_GRID_S * rates)
    while states.shape[1] < count:
        states = np.hstack([states, further @ states])
        further = further @ further
    return np.asarray(states[n])
