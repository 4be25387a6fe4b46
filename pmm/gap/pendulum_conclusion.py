"""What a pendulum's diagnosis comes to: the one value from which every word about it is made."""

import math
from dataclasses import dataclass
from typing import Final

from analysis.gap.pendulum.diagnose import Diagnosis
from analysis.gap.pendulum.verdict import NONE, UNKNOWN
from analysis.inertia.spread import SURE
from pmm.gap.conclusion import TAKES_IT

CAUSE: Final = "cause"
UNTOLD: Final = "untold"


@dataclass(frozen=True)
class Conclusion:
    """What is said of a record, and what it rests on.

    Attributes
    ----------
    verdict
        ``"none"``, ``"unknown"``, ``"cause"``, or ``"untold"`` where the likeliest cause foretells
        too little to be called it.
    names
        The likeliest causes; empty where none has any part in it.
    foretells
        Share of the gap that they foretell of what they were not fitted to; NaN if not asked.
    lean
        What the evidence prefers where no observable shows a gap; empty where there is no such.
    """

    verdict: str
    names: tuple[str, ...]
    foretells: float
    lean: tuple[str, ...] = ()

    @property
    def adds(self) -> bool:
        """Whether the causes are to be put into the simulation."""
        return self.verdict == CAUSE


def conclusion_of(found: Diagnosis) -> Conclusion:
    """Return what a diagnosis comes to."""
    gap = any(one.gap for one in found.where)
    return conclude(found.verdict.best, found.best.names, found.foretells, gap=gap)


def conclude(
    best: tuple[str, ...], names: tuple[str, ...], foretells: float, *, gap: bool
) -> Conclusion:
    """Hold what the evidence says against what the tables show.

    Parameters
    ----------
    best
        The most probable answer: causes, none, or ``("unknown",)``.
    names
        The most probable causes.
    gap
        Whether any observable is beyond noise without a cause.
    """
    if not gap:
        return Conclusion(NONE, (), math.nan, best)
    if not best:
        return Conclusion(NONE, (), math.nan)
    if best == (UNKNOWN,):
        verdict = CAUSE if names and foretells >= TAKES_IT else UNKNOWN
    else:
        verdict = CAUSE if foretells >= SURE else UNTOLD
    return Conclusion(verdict, names, foretells)
