"""How late the cycles of a run began."""

import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

LATE_SHARE: Final = 0.1  # of the period: later than that a cycle counts as late
_LOWEST_S: Final = 1e-7
_PER_DECADE: Final = 100
_BINS: Final = 9 * _PER_DECADE  # up to 100 s


@dataclass(frozen=True)
class CycleStatistics:
    """Lateness of a run's cycles, in seconds.

    ``p50_s`` and ``p99_s`` are upper bounds to 2.4 %; the others are exact. ``late`` cycles began
    later than a tenth of the period.
    """

    cycles: int
    p50_s: float
    p99_s: float
    worst_s: float
    late: int

    def as_text(self) -> dict[str, str]:
        """Return what a recording's provenance says of it."""
        return {
            "cycles": str(self.cycles),
            "cycle_lateness_p50_s": f"{self.p50_s:.3g}",
            "cycle_lateness_p99_s": f"{self.p99_s:.3g}",
            "cycle_lateness_worst_s": f"{self.worst_s:.3g}",
            "cycles_late": str(self.late),
        }


class Lateness:
    """Counts cycles by their lateness, in 100 classes a decade."""

    def __init__(self, period_s: float) -> None:
        self._limit_s = LATE_SHARE * period_s
        self._counts = [0] * (_BINS + 1)
        self._cycles = self._late = 0
        self._worst_s = 0.0

    def add(self, lateness_s: float) -> None:
        """Count a cycle that was ``lateness_s`` late."""
        self._cycles += 1
        if lateness_s <= _LOWEST_S:
            self._counts[0] += 1
            return
        place = int(math.log10(lateness_s / _LOWEST_S) * _PER_DECADE) + 1
        self._counts[min(place, _BINS)] += 1
        self._worst_s = max(self._worst_s, lateness_s)
        self._late += lateness_s > self._limit_s

    def statistics(self) -> CycleStatistics:
        """Return what the cycles so far were like."""
        below = np.cumsum(self._counts)
        p50_s, p99_s = (self._below(below, share) for share in (0.5, 0.99))
        return CycleStatistics(self._cycles, p50_s, p99_s, self._worst_s, self._late)

    def _below(self, below: Any, share: float) -> float:
        """Return a lateness that this share of the cycles does not exceed."""
        place = int(np.searchsorted(below, share * self._cycles))
        upper_s = _LOWEST_S * 10.0 ** (place / _PER_DECADE) if place else 0.0
        return min(upper_s, self._worst_s)
