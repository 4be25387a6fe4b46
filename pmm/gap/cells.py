"""Where the difference lies, cell by cell: stage, channel, harmonic and run."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analysis.gap.where import BESIDE, CHAIN, Gap, gap_of, left_by_step, step_of
from pmm.gap.examine import Examined

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class StepRow:
    """One step of the walk, or one contrast.

    Attributes
    ----------
    gap_u
        Root mean square of E/u after the free numbers have taken what they may.
    stated_u
        That of the simulation as it is stated; NaN where it is not told.
    """

    what: str
    gap_u: float
    count: int
    beyond: bool
    worst: str
    stated_u: float

    @property
    def said(self) -> tuple[str, str, str]:
        """E/u as stated and after the free numbers, and how many numbers were compared."""
        stated = f"{self.stated_u:.2f}" if math.isfinite(self.stated_u) else "-"
        return stated, f"{self.gap_u:.2f}", str(self.count)


@dataclass(frozen=True)
class Cell:
    """One cell of the heat map: E/u of a harmonic of a channel in a run."""

    stage: str
    channel: str
    order: int
    run: str
    before: float
    after: float


def step_row(one: Gap) -> StepRow:
    """Return a part of the difference as a row."""
    return StepRow(one.what, one.rms, one.count, one.beyond, one.worst, one.stated)


def remains(examined: Examined) -> Iterator[StepRow]:
    """Yield what the cause that is named leaves, step by step along the chain."""
    problem = examined.diagnosis.problem
    left = left_by_step(problem, examined.diagnosis.left)
    stack = problem.simulator.stack
    for what in CHAIN:
        rows = np.array([step_of(one) == what for one in stack.components])
        if rows.any():
            yield step_row(gap_of(stack, left, what, rows))


def heat_cells(examined: Examined) -> Iterator[Cell]:
    """Yield both parts of a harmonic as one number, and what has no parts by itself."""
    problem = examined.diagnosis.problem
    stack = problem.simulator.stack
    sizes: dict[tuple[str, str, int, str], list[int]] = {}
    for at, (one, run) in enumerate(zip(stack.components, stack.run, strict=True)):
        if step_of(one) != BESIDE:
            key = (step_of(one), one.channel, one.order, stack.runs[run].name)
            sizes.setdefault(key, []).append(at)
    first, second = (
        left_by_step(problem, problem.residual),
        left_by_step(problem, examined.diagnosis.left),
    )
    for (stage, channel, order, run), rows in sizes.items():
        old, new = (float(np.sqrt(np.mean(left[rows] ** 2))) for left in (first, second))
        yield Cell(stage, channel, order, run, old, new)
