"""What is wrong with a photocell's pulses: judged from their numbers, times and shaft angles."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np

from hardware.roles import Pulse

MISSED: Final = 1.5  # turns, or usual intervals, between two pulses: more is a missed one
EXTRA: Final = 0.5  # less is one too many


@dataclass(frozen=True)
class Interval:
    """From one pulse to the next.

    Attributes
    ----------
    number, time_s
        Of the later pulse.
    seconds
        Between both.
    turns
        How far the shaft turned, always positive; NaN if the device does not know.
    missing, extra, lost
        Pulses that did not come; whether this one is too many; pulses that the device counted and
        that did not arrive.
    """

    number: int
    time_s: float
    seconds: float
    turns: float
    missing: int = 0
    extra: bool = False
    lost: int = 0

    @property
    def verdict(self) -> str:
        """What is wrong, in words; empty if nothing is."""
        words = [f"{self.missing} missing"] if self.missing else []
        words += ["one too many"] if self.extra else []
        words += [f"{self.lost} counted, not received"] if self.lost else []
        return ", ".join(words)


def judge_pulses(pulses: Sequence[Pulse]) -> tuple[Interval, ...]:
    """Return the intervals between pulses, each with what is wrong.

    Where the device knows the shaft's angle, a turn is the measure, so that the shaft may be turned
    by hand however unevenly. Elsewhere it is the median interval, and the shaft should turn evenly.
    """
    seconds = [later.time_s - earlier.time_s for earlier, later in pairwise(pulses)]
    usual_s = float(np.median(seconds)) if seconds else math.nan
    return tuple(_interval(earlier, later, usual_s) for earlier, later in pairwise(pulses))


def _interval(earlier: Pulse, later: Pulse, usual_s: float) -> Interval:
    seconds = later.time_s - earlier.time_s
    turns = abs(later.shaft_angle_rad - earlier.shaft_angle_rad) / (2.0 * math.pi)
    share = seconds / usual_s if math.isnan(turns) and usual_s > 0.0 else turns
    lost_count = max(later.number - earlier.number - 1, 0)
    share_each = share / (lost_count + 1)
    return Interval(
        later.number,
        later.time_s,
        seconds,
        turns,
        max(round(share) - 1 - lost_count, 0) if share_each > MISSED else 0,
        extra=share_each < EXTRA,
        lost=lost_count,
    )
