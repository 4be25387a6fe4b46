"""The walk along the chain as rows: the difference step by step, and what an answer leaves."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Final

import numpy as np

from analysis.gap.fit import Problem
from analysis.gap.where import CHAIN, Gap, Walk, gap_of, left_by_step, step_of
from hardware.description.arrays import FloatArray

FAR: Final = 3.0  # tolerances, beyond which a number is said to be off


@dataclass(frozen=True)
class StepRow:
    """One step of the walk, or one contrast.

    Attributes
    ----------
    gap_u
        Root mean square of E/u after the free numbers have taken what they may.
    stated_u
        That of the simulation as it is stated; NaN where it is not told.
    tells
        False where the input that was fed is so uncertain that the gap would not show anyway.
    strained
        Free numbers that have to be off by more than three tolerances for it to be so small, with
        by how many.
    """

    what: str
    gap_u: float
    count: int
    beyond: bool
    worst: str
    stated_u: float
    tells: bool = True
    strained: Mapping[str, float] = field(default_factory=dict)

    @property
    def gap(self) -> bool:
        """Whether more differs than noise and the tolerances of what is free let expect."""
        return self.beyond or bool(self.strained)

    @property
    def verdict(self) -> str:
        """Whether there is a gap, in words."""
        if self.beyond:
            return "gap"
        if self.strained:
            return "out of tolerance"
        return "no gap" if self.tells else "cannot tell"

    @property
    def largest(self) -> str:
        """The largest number, and what is out of its tolerance."""
        off = [f"{name} off by {units:+.1f} tolerances" for name, units in self.strained.items()]
        return "; ".join([self.worst, *off])


def step_row(one: Gap, strained: Mapping[str, float] = MappingProxyType({})) -> StepRow:
    """Return a part of the difference as a row."""
    return StepRow(
        one.what, one.rms, one.count, one.beyond, one.worst, one.stated, one.tells, dict(strained)
    )


def walk_rows(problem: Problem, walk: Walk) -> tuple[StepRow, ...]:
    """Return the steps of a walk."""
    out = strained(problem, problem.stated)
    return tuple(step_row(one, out.get(one.what, {})) for one in walk.steps)


def remains(problem: Problem, residual: FloatArray) -> Iterator[StepRow]:
    """Yield what an answer leaves of a whitened difference, step by step along the chain."""
    left = left_by_step(problem, residual)
    out = strained(problem, residual + problem.stated - problem.residual)
    stack = problem.simulator.stack
    for what in CHAIN:
        rows = np.array([step_of(one) == what for one in stack.components])
        if rows.any():
            yield step_row(gap_of(stack, left, what, rows), out[what])


def strained(problem: Problem, residual: FloatArray) -> dict[str, dict[str, float]]:
    """Return which free numbers each step pulls beyond three tolerances, and by how many they are.

    Each step is fitted with those upstream of it, as the walk does; a number counts where it is
    pulled so far first.
    """
    steps = np.array([step_of(one) for one in problem.simulator.stack.components])
    upstream, seen = np.zeros(len(steps), dtype=bool), set[str]()
    found: dict[str, dict[str, float]] = {}
    for what in CHAIN:
        if (steps == what).any():
            upstream |= steps == what
            units = problem.nuisances.among(upstream).fitted(residual[upstream])
            pulled = zip(problem.free, units.tolist(), strict=False)
            far = {name: unit for name, unit in pulled if abs(unit) > FAR and name not in seen}
            seen |= far.keys()
            found[what] = far
    return found
