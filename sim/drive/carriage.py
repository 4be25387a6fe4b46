"""The carriage: how fast the rig moves along the tank, or round a circle."""

import math
from dataclasses import dataclass

import numpy as np

from hardware.description.motor import UNKNOWN_KEYS_REFUSED
from sim import signals
from sim.signals import Signals
from sim.solve.period import Period, Spectra
from sim.stage import Block

# Speed in m/s and rate of turn in rad/s that it has by now, and mean acceleration of the last step.
Driven = tuple[float, float, float]
_SETTLED = 1e-12  # so near what it is told it has that


@dataclass(frozen=True)
class Fluctuation:
    """A speed that varies with a frequency of its own: rail joints, wheels."""

    relative: float
    frequency_hz: float
    phase_rad: float = 0.0

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED


@dataclass(frozen=True)
class CarriageSettings:
    """How the carriage differs from one that runs at the speed that was set.

    Attributes
    ----------
    speed_error
        Relative to the speed.
    fluctuations
        Each relative to the mean speed.
    turn_error
        Relative to the rate of turn on a circle.
    lag_s
        Time constant with which it follows another speed that it is told.
    """

    speed_error: float = 0.0
    fluctuations: tuple[Fluctuation, ...] = ()
    turn_error: float = 0.0
    lag_s: float = 0.0

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED


@dataclass(frozen=True)
class CarriageMotion:
    """A carriage, told to run at ``speed_m_s``; on a circle it turns at ``turn_rate_rad_s``."""

    speed_m_s: float
    settings: CarriageSettings = CarriageSettings()
    turn_rate_rad_s: float = 0.0

    name = "carriage"
    reads = ()
    writes = (signals.CARRIAGE_SPEED, signals.CARRIAGE_ACCELERATION, signals.TURN_RATE)

    @property
    def mean_m_s(self) -> float:
        """The mean speed, the speed's error included."""
        return self.speed_m_s * (1.0 + self.settings.speed_error)

    @property
    def mean_turn_rad_s(self) -> float:
        """The rate of turn that it really has."""
        return self.turn_rate_rad_s * (1.0 + self.settings.turn_error)

    def start(self, sample_rate_hz: float, seed: int) -> Driven:
        """Return that it has run as it is told for long."""
        return self.mean_m_s, self.mean_turn_rad_s, 0.0

    def run(self, state: Driven, block: Block, inputs: Signals) -> tuple[Driven, Signals]:
        """Return speed, its derivative and rate of turn over the block.

        Between samples the speed bends where it is told another: what samples hold of its
        derivative is the mean of the step and of the one before, carried on to the sample.
        """
        means = (self.mean_m_s, self.mean_turn_rad_s)
        deviation = np.subtract(state[:2], means)
        if not block.count or np.abs(deviation).max() < _SETTLED:
            deviation = np.zeros(2)
        lag_s = self.settings.lag_s
        after_s = np.arange(1, block.count + 1) / block.sample_rate_hz
        fading = np.exp(-after_s / lag_s) if lag_s else np.zeros(block.count)
        speed, turn = np.array(means)[:, np.newaxis] + np.outer(deviation, fading)
        steps = np.diff(speed, prepend=state[0]) * block.sample_rate_hz * bool(lag_s)
        gain = 1.5 * steps - 0.5 * np.append(state[2], steps)[:-1]
        state = (float(speed[-1]), float(turn[-1]), float(steps[-1])) if block.count else state
        for fluctuation in self.settings.fluctuations:
            turned = 2.0 * math.pi * fluctuation.frequency_hz * block.time_s + fluctuation.phase_rad
            speed += self.mean_m_s * fluctuation.relative * np.sin(turned)
        return state, {
            signals.CARRIAGE_SPEED.name: speed,
            signals.CARRIAGE_ACCELERATION.name: gain,
            signals.TURN_RATE.name: turn,
        }

    def steady(self, period: Period, inputs: Spectra) -> tuple[Period, Spectra]:
        """Return the means; what fluctuates does so beside the period."""
        return period, {
            signals.CARRIAGE_SPEED.name: period.constant(self.mean_m_s),
            signals.CARRIAGE_ACCELERATION.name: period.constant(0.0),
            signals.TURN_RATE.name: period.constant(self.mean_turn_rad_s),
        }
