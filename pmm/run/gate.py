"""The gate of 1963: armed, opened by a pulse, closed by the one m periods later, held, reset.

It only arms, holds and resets. Which samples belong to the window is the resolver's affair.
"""

import math
from enum import StrEnum


class GateState(StrEnum):
    """Where the gate stands."""

    CLOSED = "closed"
    ARMED = "armed"
    OPEN = "open"
    HELD = "held"


class Gate:
    """Counts periods by pulses.

    Attributes
    ----------
    periods
        Whole periods since the opening pulse.
    opened_s, closed_s
        Times of the pulses; NaN before.
    wanted
        Periods after which it closes by itself.
    """

    def __init__(self, wanted: int) -> None:
        self.wanted = wanted
        self.reset()

    def reset(self) -> None:
        """Close the gate and forget its periods and times."""
        self.state = GateState.CLOSED
        self.periods = 0
        self.opened_s = self.closed_s = self.last_s = math.nan
        self._closing = False

    def arm(self) -> None:
        """Wait for the pulse that opens it."""
        self.reset()
        self.state = GateState.ARMED

    def hold(self) -> None:
        """Close at the next pulse, however many periods there are."""
        self._closing = True

    def hold_at_last(self) -> None:
        """Close at the last pulse: what came after it does not count."""
        self.state, self.closed_s = GateState.HELD, self.last_s

    def pulse(self, time_s: float) -> None:
        """Take a pulse of the photocell at ``time_s``: it opens, counts or closes."""
        self.last_s = time_s
        if self.state is GateState.ARMED:
            self.state, self.opened_s = GateState.OPEN, time_s
        elif self.state is GateState.OPEN:
            self.periods += 1
            if self._closing or self.periods >= self.wanted:
                self.state, self.closed_s = GateState.HELD, time_s
