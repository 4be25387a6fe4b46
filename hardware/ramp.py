"""A way that is gone at a limited speed and acceleration, cycle by cycle."""

import math


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
        """Whether all of the way is done."""
        return self.position >= self._way

    @property
    def at_rest(self) -> bool:
        """Whether nothing moves any more: it has arrived, or has been stopped."""
        return self.arrived or (self._stopping and self._speed == 0.0)

    def stop(self) -> None:
        """Come to rest on the way."""
        self._stopping = True

    def step(self, period_s: float) -> None:
        """Go on for a cycle."""
        left, more = self._way - self.position, self._slope * period_s
        if self._stopping:
            self._speed = max(self._speed - more, 0.0)
        else:
            braked = math.sqrt(2.0 * self._slope * max(left, 0.0))
            self._speed = min(self._top, self._speed + more, braked)
        if self._speed * period_s >= left or (not self._stopping and left <= 1e-9):
            self.position, self._speed = self._way, 0.0
        else:
            self.position += self._speed * period_s
