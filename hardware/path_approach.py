"""The way of two struts from where they stand to where their path is."""

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.drive import STEP_CYCLES
from hardware.limits import RAMP_MARGIN
from hardware.path_strut import PathStrut

_EASE_S: Final = 1.0  # from rest to the approach's speed: at 0.1 m/s 100 kg pull with 10 N


class Ramp:
    """Goes from 0 to ``way`` and stands there.

    Attributes
    ----------
    position
        How far it has come.
    """

    def __init__(self, way: float, speed: float, acceleration: float) -> None:
        self.position = 0.0
        self._way, self._top, self._slope = way, speed, acceleration
        self._speed = 0.0
        self._stopping = False

    @property
    def arrived(self) -> bool:
        """Whether the whole way is covered."""
        return self.position >= self._way

    @property
    def at_rest(self) -> bool:
        """Whether nothing moves any more: it has arrived, or has been stopped."""
        return self.arrived or (self._stopping and self._speed == 0.0)

    def stop(self) -> None:
        """Decelerate to rest before the end of the way."""
        self._stopping = True

    def step(self, period_s: float) -> None:
        """Move on by one cycle of ``period_s``, within speed and acceleration."""
        distance, more = self._way - self.position, self._slope * period_s
        if self._stopping:
            self._speed = max(self._speed - more, 0.0)
        else:
            braked = math.sqrt(2.0 * self._slope * max(distance, 0.0))
            self._speed = min(self._top, self._speed + more, braked)
        if self._speed * period_s >= distance or (not self._stopping and distance <= 1e-9):
            self.position, self._speed = self._way, 0.0
        else:
            self.position += self._speed * period_s


class PathApproach:
    """Both struts go straight, and in the same time.

    Parameters
    ----------
    speed_m_s
        Of the strut with the longer way.
    sample_rate_hz
        Of SYNCs.
    """

    def __init__(
        self, struts: Sequence[PathStrut], speed_m_s: float, sample_rate_hz: float
    ) -> None:
        self._struts, self._speed_m_s, self._rate_hz = struts, speed_m_s, sample_rate_hz
        self._due = False  # the path is another: the struts have to go to it
        self._ramp: Ramp | None = None
        self._from = self._goal = np.zeros(2)
        self._share = 0.0

    @property
    def under_way(self) -> bool:
        """Whether the struts are to go to their path, or go."""
        return self._due or self._ramp is not None

    @property
    def moves(self) -> bool:
        """Whether set-points of it change."""
        return self._ramp is not None and not self._ramp.at_rest

    def begin(self) -> None:
        """Go to where the path is now, as soon as the struts are led."""
        if self._ramp is not None:
            self._ramp.stop()
        self._due = True

    def stop(self) -> None:
        """Decelerate on the way."""
        self._due = False
        if self._ramp is not None:
            self._ramp.stop()

    def drop(self) -> None:
        """Leave the way at once: the drives decelerate by themselves."""
        self._due, self._ramp = False, None

    def step(self, points: FloatArray, wanted: FloatArray) -> FloatArray:
        """Return where the struts are to be in the next cycle, shape ``(2,)``.

        Parameters
        ----------
        points, wanted
            Where they are led now, and where the path is.
        """
        if self._ramp is None or (self._due and self._ramp.at_rest):
            if not all(strut.drive.in_mode for strut in self._struts):
                return points
            self._ramp = self._start_ramp(points, wanted)
        self._ramp.step(1.0 / self._rate_hz)
        share = 1.0 if self._ramp.arrived else self._ramp.position * self._share
        led = np.asarray(self._from + share * (self._goal - self._from))
        if self._ramp.at_rest and not self._due and (not self._ramp.arrived or self._is_at_goal()):
            self._ramp = None
            for strut in self._struts:
                strut.drive.cancel_deadline()
        return led

    def _start_ramp(self, points: FloatArray, wanted: FloatArray) -> Ramp:
        self._due = False
        self._from, self._goal = points, wanted
        way = float(np.abs(self._goal - self._from).max())
        slope = self._speed_m_s / _EASE_S
        self._share = 1.0 / way if way else 0.0
        time_s = way / self._speed_m_s + 2.0 * self._speed_m_s / slope
        for strut in self._struts:
            limit = 4 * STEP_CYCLES + RAMP_MARGIN * time_s * self._rate_hz
            strut.drive.set_deadline(limit, "way to the path")
        return Ramp(way, self._speed_m_s, slope)

    def _is_at_goal(self) -> bool:
        """Whether the struts stand at the goal by their encoders."""
        return all(
            abs(strut.position - goal) <= strut.near and strut.drive.motion.at_rest
            for strut, goal in zip(self._struts, self._goal, strict=True)
        )
