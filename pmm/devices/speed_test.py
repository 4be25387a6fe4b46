"""A shaft whose speed is changed up and down, its encoder read in every cycle."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.speed_loop.identification import SpeedRecord
from hardware.command_limits import check_speed
from hardware.description.errors import ConfigurationError
from hardware.rig import Rig
from hardware.roles import Shaft
from pmm.devices.axis_move import NOTHING_MOVED, move, turn

_TURN: Final = 2.0 * math.pi


@dataclass(frozen=True)
class SpeedTest:
    """A test of the speed: from the slow one to the fast one and back.

    Attributes
    ----------
    slow_hz, fast_hz
        Turns per second.
    acceleration_hz_per_s
        Of the drive's ramps.
    settle_s
        How long each speed is kept.
    """

    slow_hz: float
    fast_hz: float
    acceleration_hz_per_s: float
    settle_s: float

    def check(self, rig: Rig) -> Shaft:
        """Return the shaft, if the rig can make the test.

        Raises
        ------
        ConfigurationError
            If the rig has no shaft, or the second speed is not above the first.
        LimitError
            If the shaft may not turn so fast or so slowly.
        """
        shaft = rig.shaft
        if shaft is None:
            raise ConfigurationError("the rig has no shaft; it needs a [shaft] table")
        if not 0.0 < self.slow_hz < self.fast_hz:
            raise ConfigurationError(
                f"from {self.slow_hz:g} Hz to {self.fast_hz:g} Hz: the second speed has to be "
                "above the first, and that above 0"
            )
        for speed_hz in (self.slow_hz, self.fast_hz):
            check_speed(shaft, speed_hz, remark=NOTHING_MOVED)
        return shaft

    def run(self, rig: Rig) -> SpeedRecord:
        """Make the test, at the smallest eccentricity.

        Raises
        ------
        HardwareError
            What the drives report on the way.
        """
        shaft = self.check(rig)
        if rig.eccentricity is not None:
            move(rig, rig.eccentricity, rig.eccentricity.limits.low)
        period_s = 1.0 / rig.configuration.sample_rate_hz
        turn(rig, shaft, self.slow_hz)
        self._settle(rig)
        shaft.take()
        self._settle(rig)  # the speed before the change counts too
        changes = []
        for speed_hz in (self.fast_hz, self.slow_hz):
            changes.append((rig.number * period_s, _TURN * speed_hz))
            shaft.turn(speed_hz)
            self._settle(rig)
        samples = shaft.take()
        shaft.stop()
        return SpeedRecord(
            period_s
            * np.concatenate([block.first + np.arange(block.values.shape[1]) for block in samples]),
            np.concatenate([block.values[0] for block in samples]),
            _TURN * self.slow_hz,
            tuple(changes),
            _TURN * self.acceleration_hz_per_s,
        )

    def _settle(self, rig: Rig) -> None:
        for _ in range(round(self.settle_s * rig.configuration.sample_rate_hz)):
            rig.cycle()
