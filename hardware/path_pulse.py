"""The pulse of a shaft that is a program: one for each whole turn of the master angle."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from hardware.driver import Driver, Services
from hardware.led_shaft import led_shaft
from hardware.roles import Cycle, Pulse, Role

_TURN = 2.0 * math.pi


@dataclass(frozen=True)
class PathPulseSettings:
    """There is nothing to set."""


class PathPulse:
    """A :class:`hardware.roles.Photocell` without a lamp: no pulse can be missed.

    Raises
    ------
    ConfigurationError
        If the rig's shaft has no struts that follow a path.
    """

    def __init__(self, name: str, settings: PathPulseSettings, services: Services) -> None:
        self.name = name
        self._shaft = led_shaft(name, services)
        self._period_s = 1.0 / services.sample_rate_hz
        self._pulses: list[Pulse] = []
        self._count = 0

    def expect(self, frequency_hz: float | None) -> None:
        """Nothing to wait for: the turns are the program's own."""

    def tick(self, cycle: Cycle) -> None:
        """Tell the whole turn that the master angle has passed since the last SYNC."""
        before, now = self._shaft.angle_at(cycle.number - 1), self._shaft.angle_at(cycle.number)
        if math.isnan(before) or math.isnan(now):
            return
        turn = math.floor(now / _TURN)
        if turn > math.floor(before / _TURN):
            share = (turn * _TURN - before) / (now - before)
            self._count += 1
            time_s = (cycle.number - 1 + share) * self._period_s
            self._pulses.append(Pulse(self._count, time_s, turn * _TURN))

    def take(self) -> tuple[Pulse, ...]:
        """Return the pulses since the last call."""
        taken, self._pulses = tuple(self._pulses), []
        return taken

    def carried(self) -> dict[str, Any]:
        """Return the count; see :mod:`hardware.carry_over`."""
        return {"count": self._count}

    def carry_on(self, carried: Mapping[str, Any]) -> None:
        """Count on from there."""
        self._count = int(carried["count"])

    def prepare(self) -> None:
        """Nothing to write."""

    def reset_fault(self) -> None:
        """Nothing to reset."""

    def close(self) -> None:
        """Nothing to let go of."""


DRIVER = Driver(Role.PHOTOCELL, PathPulseSettings, PathPulse)
