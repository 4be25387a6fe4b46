"""The commanded motion of the shaft, and a drive that follows it whatever the load."""

import math
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.motor import UNKNOWN_KEYS_REFUSED, Guides, Servo, ShuntMotor
from sim import signals
from sim.drive.gear import Gear
from sim.signals import Signals
from sim.solve.period import Period, Spectra
from sim.stage import Block

SHAFT = (signals.SHAFT_ANGLE, signals.SHAFT_SPEED, signals.SHAFT_ACCELERATION)


class ShaftMotion(NamedTuple):
    """Angle (rad), speed (rad/s) and acceleration (rad/s2) of the shaft, one value a sample."""

    angle: FloatArray
    speed: FloatArray
    acceleration: FloatArray

    @property
    def signals(self) -> Signals:
        """The three by their signals' names."""
        return {signal.name: values for signal, values in zip(SHAFT, self, strict=True)}

    def beyond(self, moved: FloatArray) -> "ShaftMotion":
        """Return it with a deviation of angle, speed and acceleration, shape ``(samples, 3)``."""
        return ShaftMotion(*(value + more for value, more in zip(self, moved.T[:3], strict=True)))


@dataclass(frozen=True)
class SpeedRipple:
    """A speed that varies with the shaft's angle: eccentric gears, a joint.

    The angle is ``th + (rho/k) sin(k th + psi)`` where it should be th.

    Attributes
    ----------
    order
        k: times a revolution. Where it is no whole number (a belt), the ripple has no part in the
        periodic steady state.
    relative
        rho: amplitude of the speed, relative to its mean.
    phase_rad
        psi.
    """

    order: float
    relative: float
    phase_rad: float = 0.0

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED


@dataclass(frozen=True)
class DriveSettings:
    """What a drive is, whatever the run.

    Attributes
    ----------
    initial_angle_rad
        Shaft angle at time 0. With half a revolution before the photocell's mark, a record that
        begins after whole periods holds whole periods and half of one at either end.
    start_ramp_s
        Time in which the speed rises from zero, smoothly; 0 to turn at full speed from the start.
    stop_at_s, stop_ramp_s
        When the speed begins to fall to zero, and in what time; ``None`` to turn on.
    speed_error
        By how much the speed differs from the one that was set, relative to it.
    ripple
        How the speed varies over a revolution.
    motor
        What turns the shaft and feels its load; ``None`` for a drive that holds its speed.
    gear
        The last gear, where it has backlash: what is behind it feels the load, with or without a
        motor that does.
    guides
        Friction of the struts' guides, besides the motor's own: a load of the shaft.
    """

    initial_angle_rad: float = -math.pi
    start_ramp_s: float = 0.0
    stop_at_s: float | None = None
    stop_ramp_s: float = 1.0
    speed_error: float = 0.0
    ripple: tuple[SpeedRipple, ...] = ()
    motor: ShuntMotor | Servo | None = None
    gear: Gear | None = None
    guides: Guides = field(default_factory=Guides)

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def frequency_hz(self, set_hz: float) -> float:
        """Return the frequency at which the shaft turns without load if ``set_hz`` is set."""
        return set_hz * (1.0 + self.speed_error)

    def commanded(self, set_hz: float, time_s: FloatArray) -> ShaftMotion:
        """Return the motion that the drive is told to make, ramps and ripple included.

        During a ramp the speed follows the fifth-order step 10 u^3 - 15 u^4 + 6 u^5 of
        u = t / ramp, so that angle, speed, acceleration and jerk are continuous; afterwards the
        shaft is half a ramp time behind one that had turned at full speed from the start.
        """
        turned, fraction, rate = _ramp(time_s, self.start_ramp_s)
        if self.stop_at_s is not None:
            less = _ramp(np.maximum(time_s - self.stop_at_s, 0.0), self.stop_ramp_s)
            started = time_s > self.stop_at_s
            turned = turned - less[0]
            fraction = fraction - started * less[1]
            rate = rate - less[2]
        omega = 2.0 * math.pi * self.frequency_hz(set_hz)
        steady = ShaftMotion(
            self.initial_angle_rad + omega * turned, omega * fraction, omega * rate
        )
        return self._rippled(steady)

    def _rippled(self, shaft: ShaftMotion) -> ShaftMotion:
        if not self.ripple:
            return shaft
        angle = shaft.angle.copy()
        factor, change = np.ones_like(angle), np.zeros_like(angle)
        for ripple in self.ripple:
            phase = ripple.order * shaft.angle + ripple.phase_rad
            angle += (ripple.relative / ripple.order) * np.sin(phase)
            factor += ripple.relative * np.cos(phase)
            change -= ripple.relative * ripple.order * np.sin(phase)
        return ShaftMotion(
            angle, shaft.speed * factor, shaft.acceleration * factor + shaft.speed**2 * change
        )

    def ripple_over(self, period: Period) -> Spectra:
        """Return the shaft's harmonics over a period: of its angle, what it has beyond w t."""
        beyond = period.constant(0.0)
        for ripple in self.ripple:
            order = round(ripple.order)
            if order == ripple.order and order <= period.orders:
                turn = np.exp(1j * ripple.phase_rad)
                beyond[order] += -1j * (ripple.relative / ripple.order) * turn
        return shaft_over(period, beyond)


def shaft_over(period: Period, beyond: np.ndarray) -> Spectra:
    """Return angle, speed and acceleration over a period, from the angle's part beyond w t."""
    speed = period.s * beyond
    acceleration = period.s * speed
    speed = speed + period.constant(period.omega_rad_s)
    return {
        signal.name: values
        for signal, values in zip(SHAFT, (beyond, speed, acceleration), strict=True)
    }


def _ramp(time_s: FloatArray, ramp_s: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return time turned at full speed, fraction of the speed, and its rate (1/s)."""
    if ramp_s <= 0.0:
        return time_s, np.ones_like(time_s), np.zeros_like(time_s)
    u = np.minimum(time_s / ramp_s, 1.0)
    turned = ramp_s * u**4 * (2.5 + u * (u - 3.0)) + np.maximum(time_s - ramp_s, 0.0)
    fraction = u**3 * (10.0 + u * (6.0 * u - 15.0))
    return turned, fraction, 30.0 * (u * (1.0 - u)) ** 2 / ramp_s


@dataclass(frozen=True)
class ConstantSpeedDrive:
    """A drive that turns as it is told, whatever the load."""

    frequency_hz: float
    settings: DriveSettings = DriveSettings()

    name = "drive"
    reads = ()
    writes = SHAFT

    def start(self, sample_rate_hz: float, seed: int) -> None:
        """Return no state: the motion follows from the time alone."""

    def run(self, state: None, block: Block, inputs: Signals) -> tuple[None, Signals]:
        """Return the shaft's angle, speed and acceleration over the block."""
        return state, self.settings.commanded(self.frequency_hz, block.time_s).signals

    def steady(self, period: Period, inputs: Spectra) -> tuple[Period, Spectra]:
        """Return the period that the shaft really has, and its harmonics."""
        real = period.at(self.settings.frequency_hz(self.frequency_hz))
        return real, self.settings.ripple_over(real)
