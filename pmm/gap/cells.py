"""Where the difference lies, cell by cell: stage, channel, harmonic and run."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.gap.components import TRENDS, Component, Part
from analysis.gap.where import CHAIN, Gap, gap_of, left_by_step, step_of
from pmm.gap.examine import Examined

FloatArray = NDArray[np.float64]

HARMONIC: Final = "harmonic"


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
    """

    what: str
    gap_u: float
    count: int
    beyond: bool
    worst: str
    stated_u: float
    tells: bool = True

    @property
    def verdict(self) -> str:
        """Whether there is a gap, in words."""
        if self.beyond:
            return "gap"
        return "no gap" if self.tells else "cannot tell"

    @property
    def said(self) -> tuple[str, str, str]:
        """E/u as stated and after the free numbers, and how many numbers were compared."""
        stated = f"{self.stated_u:.2f}" if math.isfinite(self.stated_u) else "-"
        return stated, f"{self.gap_u:.2f}", str(self.count)


@dataclass(frozen=True)
class Cell:
    """One cell of the heat map: E/u of a harmonic, or of what has none, in a run.

    Attributes
    ----------
    what
        ``"harmonic"``, or what beside the harmonics: ``"trend"``, ``"cycle scatter"``, ``"line"``.
    order
        Of the harmonic; 0 is the mean, and what has none.
    """

    stage: str
    channel: str
    what: str
    order: int
    run: str
    before: float
    after: float


def step_row(one: Gap) -> StepRow:
    """Return a part of the difference as a row."""
    return StepRow(one.what, one.rms, one.count, one.beyond, one.worst, one.stated, one.tells)


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
    """Yield both parts of a harmonic as one number, and so all trends or bands of a channel."""
    problem = examined.diagnosis.problem
    stack = problem.simulator.stack
    sizes: dict[tuple[str, str, str, int, str], list[int]] = {}
    for at, (one, run) in enumerate(zip(stack.components, stack.run, strict=True)):
        key = (step_of(one), one.channel, *_kind(one), stack.runs[run].name)
        sizes.setdefault(key, []).append(at)
    first, second = (
        left_by_step(problem, problem.residual),
        left_by_step(problem, examined.diagnosis.left),
    )
    for key, rows in sizes.items():
        old, new = (float(np.sqrt(np.mean(left[rows] ** 2))) for left in (first, second))
        yield Cell(*key, old, new)


def _kind(one: Component) -> tuple[str, int]:
    """Return what a component is one number of, and its harmonic."""
    if one.part in (Part.MEAN, Part.IN_PHASE, Part.QUADRATURE):
        return HARMONIC, one.order
    return (str(Part.TREND) if one.part in TRENDS else str(one.part)), 0
