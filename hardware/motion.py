"""Whether an axis moves, from the positions that its drive sends: what was commanded counts not."""

import math
from collections import deque
from collections.abc import Iterable

from hardware.limits import REST_COUNTS, REST_WINDOW_S, SPEED_WINDOW_S


class EncoderMotion:
    """Follows the positions of one drive.

    Parameters
    ----------
    counts_per_unit
        Increments of a turn, a metre or a radian.
    unit
        Of the speed: ``"Hz"``, ``"m/s"`` or ``"rad/s"``.
    rest_speed
        Below it the axis is at rest, in ``unit``.
    sample_rate_hz
        Positions per second.
    gap_cycles
        So many cycles without a position are in order; after more the position is stale.

    Attributes
    ----------
    counts
        The position in counts since the start, never wrapping; ``None`` before the first.
    sample_rate_hz
        As given.
    """

    def __init__(
        self,
        counts_per_unit: float,
        unit: str,
        rest_speed: float,
        sample_rate_hz: float,
        gap_cycles: int,
    ) -> None:
        self.counts: int | None = None
        self._counts_per_unit, self._unit, self._rest_speed = counts_per_unit, unit, rest_speed
        self.sample_rate_hz, self._gap = sample_rate_hz, gap_cycles
        per_cycle = abs(counts_per_unit) * rest_speed / sample_rate_hz
        self._speed_window = max(2, math.ceil(SPEED_WINDOW_S * sample_rate_hz))
        shortest, longest = (max(2, math.ceil(time_s * sample_rate_hz)) for time_s in REST_WINDOW_S)
        window = min(max(shortest, math.ceil((REST_COUNTS + 1) / per_cycle)), longest)
        # A count less than the speed of rest makes: positions are rounded at both ends.
        self._allowed = max(per_cycle * window - 1.0, REST_COUNTS)
        self._window = window
        self._counts: deque[int] = deque(maxlen=window + 1)
        self._track: deque[tuple[int, int]] = deque(maxlen=self._speed_window + 1)
        self._now = self._disturbed = 0

    def take(self, now: int, positions: Iterable[tuple[int, int]]) -> list[tuple[int, int]]:
        """Take what came in cycle ``now``, (number, 32-bit position); return it unwrapped."""
        self._now = now
        taken = []
        for number, raw in positions:
            self.counts = raw if self.counts is None else self.near(raw)
            self._counts.append(self.counts)
            taken.append((number, self.counts))
        self._track += taken
        return taken

    def near(self, raw: int) -> int:
        """Return the count, never wrapping, of a 32-bit position near the present one."""
        counts = self.counts or 0
        return counts + (raw - counts + 2**31) % 2**32 - 2**31

    def disturb(self) -> None:
        """Believe no rest from positions of before now: a motion that was commanded ends."""
        self._disturbed = self._now

    @property
    def is_current(self) -> bool:
        """Whether there are positions, and they are not stale."""
        return len(self._track) > 1 and self._now - self._track[-1][0] <= self._gap

    @property
    def at_rest(self) -> bool:
        """Whether the positions have stayed where they are; unknown and stale ones have not."""
        fresh = self._now - self._disturbed > self._window or not self._disturbed
        if not self.is_current or not fresh or len(self._counts) <= self._window:
            return False
        return max(self._counts) - min(self._counts) <= self._allowed

    @property
    def speed(self) -> float:
        """Speed over :data:`SPEED_WINDOW_S`, with its sign; NaN while it is not known."""
        if not self.is_current:
            return math.nan
        (first, start), (last, end) = self._track[0], self._track[-1]
        return (end - start) / (last - first) * self.sample_rate_hz / self._counts_per_unit

    def __str__(self) -> str:
        """Say how fast it moves, for messages."""
        if not self.is_current:
            return "its position is not known, which counts as moving"
        rest = f"rest is below {self._rest_speed:g} {self._unit}"
        return f"it moves at {self.speed:.4g} {self._unit} ({rest})"
