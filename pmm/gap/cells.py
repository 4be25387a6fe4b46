"""Where the difference lies, cell by cell: stage, channel, harmonic and run."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.gap.forward.problem import Problem
from analysis.gap.locate.walk import left_by_step, step_of
from analysis.gap.observe.components import TRENDS, Component, Part
from hardware.description.arrays import FloatArray

HARMONIC: Final = "harmonic"


@dataclass(frozen=True)
class Cell:
    """One cell of the heat map: E/u of a harmonic, or of what has none, in a run.

    Attributes
    ----------
    what
        ``"harmonic"``, or what beside the harmonics: ``"trend"``, ``"cycle scatter"``, ``"line"``,
        ``"line of the mains of 50 Hz"``.
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


def heat_cells(problem: Problem, residual: FloatArray) -> Iterator[Cell]:
    """Yield both parts of a harmonic as one number, and so all trends or bands of a channel.

    Parameters
    ----------
    residual
        What the answer leaves of the whitened difference, shape ``(observations,)``.
    """
    stack = problem.simulator.stack
    sizes: dict[tuple[str, str, str, int, str], list[int]] = {}
    for at, (component, run) in enumerate(zip(stack.components, stack.run, strict=True)):
        key = (step_of(component), component.channel, *_kind(component), stack.runs[run].name)
        sizes.setdefault(key, []).append(at)
    first, second = (
        left_by_step(problem, difference) for difference in (problem.residual, residual)
    )
    for key, rows in sizes.items():
        old, new = (float(np.sqrt(np.mean(part[rows] ** 2))) for part in (first, second))
        yield Cell(*key, old, new)


def _kind(component: Component) -> tuple[str, int]:
    """Return what a component is one number of, and its harmonic."""
    if component.part in (Part.MEAN, Part.IN_PHASE, Part.QUADRATURE):
        return HARMONIC, component.order
    return (str(Part.TREND) if component.part in TRENDS else component.what), 0
