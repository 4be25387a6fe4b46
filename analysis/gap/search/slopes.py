"""How a hypothesis changes with its parameters: one simulation aside of it for each."""

from collections.abc import Sequence
from typing import Final

import numpy as np

from analysis.gap.forward.candidate import Candidate, least_step
from analysis.gap.forward.problem import ComparedProblem
from hardware.description.arrays import FloatArray

# Of a posterior deviation, by which slopes are found: over the whole of one they change by up to
# 0.8 of themselves, over this by 0.01, and rounding is a millionth of it.
FINE: Final = 0.01
_USUAL: Final = 0.1  # of a parameter, by which slopes are found before its uncertainty is known
# Of the size of what is simulated in time: hum of 0.3 N reads 0.28 to 0.31 N, known to 0.04 N. By
# half as much to 0.03 N, by twice as much the same; by a tenth 0.27 to 0.31 N, as if known to 0.02.
_COARSE: Final = 0.5


def into_range(parts: Sequence[Candidate], units: FloatArray) -> FloatArray:
    """Return parameters drawn back into their plausible ranges."""
    low, high = bounds(parts)
    return np.asarray(np.clip(units, low, high), np.float64)


def bounds(parts: Sequence[Candidate]) -> FloatArray:
    """Return the plausible ranges of all parameters in prior units, shape ``(2, p)``."""
    return np.concatenate([np.empty((2, 0)), *(part.bounds for part in parts)], axis=1)


def usual_steps(parts: Sequence[Candidate], units: FloatArray) -> FloatArray:
    """Return the steps by which slopes are found, in prior deviations, shape ``(p,)``.

    Of what is simulated in time a digitiser rounds each simulation in another way, as another noise
    would: the slope of a size is that over half of it there.
    """
    least = np.array([least_step(parts, axis) for axis in range(len(units))])
    rounded = [axis.is_size and not part.repeats for part in parts for axis in part.axes]
    shares = np.where(rounded, _COARSE, _USUAL)
    return np.asarray(np.maximum(least, shares * np.abs(units)), np.float64)


def slopes(
    problem: ComparedProblem,
    parts: tuple[Candidate, ...],
    units: FloatArray,
    base: FloatArray,
    steps: FloatArray,
) -> list[FloatArray]:
    """Return what a prior deviation of each parameter changes, in sigma, one after the other.

    Parameters
    ----------
    base
        What the hypothesis changes where it is, in sigma, shape ``(observations,)``.
    steps
        In prior deviations, shape ``(p,)``; backwards where the range ends.

    Raises
    ------
    PmmError
        If the simulator cannot run it.
    """
    return [
        _slope(problem, parts, units, base, axis, float(step)) for axis, step in enumerate(steps)
    ]


def _slope(
    problem: ComparedProblem,
    parts: tuple[Candidate, ...],
    units: FloatArray,
    base: FloatArray,
    axis: int,
    step: float,
) -> FloatArray:
    for sign in (1.0, -1.0):
        aside = units.copy()
        aside[axis] += sign * step
        moved_units = into_range(parts, aside)
        if abs(moved_units[axis] - units[axis]) > 0.5 * step:
            change = problem.signature(parts, moved_units) - base
            return np.asarray(change / (moved_units[axis] - units[axis]), np.float64)
    return np.zeros_like(base)
