"""When the next cycle begins: at once, or on time."""

from collections.abc import Callable
from typing import Protocol


class Pacer(Protocol):
    """Decides when a cycle begins."""

    def wait(self) -> float:
        """Wait for the next cycle; return how late it begins, in seconds."""
        ...


class FreeRunning:
    """Begins at once: for simulated time."""

    def wait(self) -> float:
        """Return 0 at once."""
        return 0.0


class RealTime:
    """Begins every ``period_s`` of a clock.

    A late cycle begins at once, and the next ones keep to the grid: cycles that the host has slept
    through are not made up for, because each of them would be a SYNC at the wrong time.
    """

    def __init__(
        self, period_s: float, clock: Callable[[], float], sleep: Callable[[float], None]
    ) -> None:
        self._period_s = period_s
        self._clock = clock
        self._sleep = sleep
        self._due: float | None = None

    def wait(self) -> float:
        """Wait for the grid's next point; return the lateness."""
        now = self._clock()
        if self._due is None:
            self._due = now
        if now < self._due:
            self._sleep(self._due - now)
            now = self._clock()
        late = max(now - self._due, 0.0)
        self._due += self._period_s * (1 + late // self._period_s)
        return late
