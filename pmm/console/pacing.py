"""A pacer that keeps account of how late the cycles began."""

from hardware.pacing import Pacer
from pmm.recorder.lateness import CycleStatistics, Lateness


class CountingPacer:
    """Counts the lateness of every cycle of another pacer.

    Parameters
    ----------
    period_s
        Of the cycles on the clock.
    window
        Over how many cycles statistics are taken: what was late long ago says nothing of now.
    """

    def __init__(self, inner: Pacer, period_s: float, window: int) -> None:
        self._inner, self._period_s, self._window = inner, period_s, window
        self._lateness = Lateness(period_s)
        self._count = 0
        self._known = CycleStatistics(0, 0.0, 0.0, 0.0, 0)

    def wait(self) -> float:
        """Wait for the next cycle; return how late it begins."""
        late_s = self._inner.wait()
        self._lateness.add(late_s)
        self._count += 1
        return late_s

    def statistics(self) -> CycleStatistics:
        """Return the lateness of the last full window; no cycles before there is one."""
        if self._count >= self._window:
            self._known = self._lateness.statistics()
            self._lateness, self._count = Lateness(self._period_s), 0
        return self._known
