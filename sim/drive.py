"""The drive: how the shaft turns."""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from sim import signals
from sim.signals import Signal, Signals
from sim.stage import UNKNOWN_KEYS_REFUSED, Block


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
    """

    initial_angle_rad: float = -math.pi
    start_ramp_s: float = 0.0

    __pydantic_config__: ClassVar = UNKNOWN_KEYS_REFUSED


@dataclass(frozen=True)
class ConstantSpeedDrive:
    """A drive that holds its speed whatever the load.

    During the ramp the speed follows the fifth-order step 10 u^3 - 15 u^4 + 6 u^5 of u = t / ramp,
    so that angle, speed, acceleration and jerk are continuous; afterwards the shaft is half a ramp
    time behind one that had turned at full speed from the start.
    """

    frequency_hz: float
    settings: DriveSettings = DriveSettings()

    name: ClassVar[str] = "drive"
    reads: ClassVar[tuple[Signal, ...]] = ()
    writes: ClassVar[tuple[Signal, ...]] = (
        signals.SHAFT_ANGLE,
        signals.SHAFT_SPEED,
        signals.SHAFT_ACCELERATION,
    )

    def start(self, sample_rate_hz: float, seed: int) -> None:
        """Return no state: the motion follows from the time alone."""

    def run(self, state: None, block: Block, inputs: Signals) -> tuple[None, Signals]:  # noqa: ARG002
        """Return the shaft's angle, speed and acceleration over the block."""
        time_s = block.time_s
        ramp_s = self.settings.start_ramp_s
        turned_s, fraction, rate = time_s, np.ones_like(time_s), np.zeros_like(time_s)
        if ramp_s > 0.0:
            u = np.minimum(time_s / ramp_s, 1.0)
            turned_s = ramp_s * u**4 * (2.5 + u * (u - 3.0)) + np.maximum(time_s - ramp_s, 0.0)
            fraction = u**3 * (10.0 + u * (6.0 * u - 15.0))
            rate = 30.0 * (u * (1.0 - u)) ** 2 / ramp_s
        omega = 2.0 * math.pi * self.frequency_hz
        return state, {
            signals.SHAFT_ANGLE.name: self.settings.initial_angle_rad + omega * turned_s,
            signals.SHAFT_SPEED.name: omega * fraction,
            signals.SHAFT_ACCELERATION.name: omega * rate,
        }
