"""What a pendulum's diagnosis comes to: the one value from which every word about it is made."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from analysis.gap.pendulum.diagnose import Diagnosis
from analysis.gap.pendulum.hypothesis import Hypothesis
from analysis.gap.pendulum.verdict import NONE, UNKNOWN, Verdict
from analysis.inertia.spread import SURE

CAUSE: Final = "cause"
UNTOLD: Final = "untold"
_TAKES_IT: Final = 0.95  # of the withheld gap: what takes as much is not refused as "unknown"
_SHOWN: Final = 8  # answers
_LEAST: Final = 1e-4  # probability that is worth a row


@dataclass(frozen=True)
class PendulumConclusion:
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


def conclusion_of(found: Diagnosis) -> PendulumConclusion:
    """Return what a diagnosis comes to."""
    gap = any(one.gap for one in found.where)
    return conclude(found.verdict.best, found.best.names, found.foretells, gap=gap)


def conclude(
    best: tuple[str, ...], names: tuple[str, ...], foretells: float, *, gap: bool
) -> PendulumConclusion:
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
        return PendulumConclusion(NONE, (), math.nan, best)
    if not best:
        return PendulumConclusion(NONE, (), math.nan)
    if best == (UNKNOWN,):
        verdict = CAUSE if names and foretells >= _TAKES_IT else UNKNOWN
    else:
        verdict = CAUSE if foretells >= SURE else UNTOLD
    return PendulumConclusion(verdict, names, foretells)


def ranking(verdict: Verdict) -> Iterator[tuple[str, float]]:
    """Yield the answers that are not out of the question, the most probable first."""
    for at, (names, share) in enumerate(verdict.by_set.items()):
        if at < _SHOWN and (share > _LEAST or not at):
            yield " and ".join(names) or "no gap", share


def classes(verdict: Verdict) -> Iterator[tuple[str, float]]:
    """Yield classes and single causes that are not out of the question, and both verdicts."""
    for name, share in {**verdict.by_class, **verdict.by_cause}.items():
        if share > _LEAST or name in (NONE, UNKNOWN):
            yield name, share


def parameters(best: Hypothesis) -> dict[str, dict[str, dict[str, float]]]:
    """Return each cause's parameters: value and standard uncertainty (before inflation)."""
    spread = best.posterior.covariance.diagonal() ** 0.5
    found: dict[str, dict[str, dict[str, float]]] = {}
    at = 0
    for one in best.causes:
        rows = found.setdefault(one.name, {})
        for axis in one.axes:
            value = axis.value(float(best.units[at]))
            rows[axis.name] = {"value": value, "uncertainty": axis.deviation * float(spread[at])}
            at += 1
    return found
