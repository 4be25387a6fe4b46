"""The walk along the chain as rows: the difference step by step, and what an answer leaves."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from analysis.gap.forward.problem import Problem
from analysis.gap.locate.walk import (
    CHAIN,
    Gap,
    Walk,
    gap_of,
    left_by_step,
    step_of,
    strained_numbers,
)
from hardware.description.arrays import FloatArray

_TOLD: Final = 2  # numbers that are out of their tolerance


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
        most = sorted(self.strained.items(), key=lambda pair: -abs(pair[1]))
        off = [f"{name} off by {units:+.1f} tolerances" for name, units in most[:_TOLD]]
        more = [f"{len(most) - _TOLD} more"] if len(most) > _TOLD else []
        return "; ".join([self.worst, *off, *more])


def step_row(gap: Gap) -> StepRow:
    """Return a part of the difference as a row."""
    strains = dict(gap.strained)
    return StepRow(
        gap.step, gap.rms, gap.count, gap.is_beyond_noise, gap.worst, gap.stated, gap.tells, strains
    )


def walk_rows(walk: Walk) -> tuple[StepRow, ...]:
    """Return a row for each step of a walk."""
    return tuple(step_row(step) for step in walk.steps)


def remains(problem: Problem, residual: FloatArray) -> Iterator[StepRow]:
    """Yield what an answer leaves of a whitened difference, step by step along the chain."""
    remainder = left_by_step(problem, residual)
    out = strained_numbers(problem, residual + problem.stated - problem.residual)
    stack = problem.simulator.stack
    for step in CHAIN:
        rows = np.array([step_of(component) == step for component in stack.components])
        if rows.any():
            yield step_row(replace(gap_of(stack, remainder, step, rows), strained=out[step]))
