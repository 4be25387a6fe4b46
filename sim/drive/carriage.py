"""The carriage: how fast the rig moves along the tank, or round a circle."""

import math
from dataclasses import dataclass

import numpy as np

from hardware.description.motor import UNKNOWN_KEYS_REFUSED
from sim import signals
from sim.signals import Signals
from sim.solve.period import Period, Spectra
from sim.stage import Block


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
    """

    speed_error: float = 0.0
    fluctuations: tuple[Fluctuation, ...] = ()
    turn_error: float = 0.0

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED


@dataclass(frozen=True)
class Carriage:
    """A carriage, told to run at ``speed_m_s``; on a circle it turns at ``turn_rate_rad_s``."""

    speed_m_s: float
    settings: CarriageSettings = CarriageSettings()
    turn_rate_rad_s: float = 0.0

    name = "carriage"
    reads = ()
    writes = (signals.CARRIAGE_SPEED, signals.TURN_RATE)

    @property
    def mean_m_s(self) -> float:
        """The mean speed that it really has."""
        return self.speed_m_s * (1.0 + self.settings.speed_error)

    @property
    def mean_turn_rad_s(self) -> float:
        """The rate of turn that it really has."""
        return self.turn_rate_rad_s * (1.0 + self.settings.turn_error)

    def start(self, sample_rate_hz: float, seed: int) -> None:
        """Return no state: the speed follows from the time alone."""

    def run(self, state: None, block: Block, inputs: Signals) -> tuple[None, Signals]:
        """Return speed and rate of turn over the block."""
        speed = np.full(block.count, self.mean_m_s)
        for fluctuation in self.settings.fluctuations:
            turned = 2.0 * math.pi * fluctuation.frequency_hz * block.time_s + fluctuation.phase_rad
            speed += self.mean_m_s * fluctuation.relative * np.sin(turned)
        turn = np.full(block.count, self.mean_turn_rad_s)
        return state, {signals.CARRIAGE_SPEED.name: speed, signals.TURN_RATE.name: turn}

    def steady(self, period: Period, inputs: Spectra) -> tuple[Period, Spectra]:
        """Return the means; what fluctuates does so beside the period."""
        return period, {
            signals.CARRIAGE_SPEED.name: period.constant(self.mean_m_s),
            signals.TURN_RATE.name: period.constant(self.mean_turn_rad_s),
        }
