"""A pacer that keeps account of how late the cycles began."""

from hardware.pacing import Pacer
from pmm.recorder.lateness import CycleStatistics, Lateness


class CountingPacer:
    """Counts the lateness of every cycle of another pacer.

    Parameters
    ----------
    period_s
        Of the cycles on the clock.
    refresh
        After how many cycles the statistics are worked out anew: it costs more than a cycle's
        share of it.
    """

    def __init__(self, inner: Pacer, period_s: float, refresh: int) -> None:
        self._inner, self._refresh = inner, refresh
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
        """Return lateness so far, as of the last time it was worked out."""
        if self._count >= self._refresh or not self._known.cycles:
            self._count = 0
            self._known = self._lateness.statistics()
        return self._known
