"""The answers that name no effect, and the deviation that stands beside any answer.

    r = N b + F t + d + e,    d ~ N(0, tau^2 K)

Tolerances N and a deviation d of no particular form are those of the evidence. As d is alike for
runs that are alike, what the campaign shows of it is expected of a further run too.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from analysis.gap.forward.problem import Problem
from analysis.gap.inference.constants import TAUS, TOLERATED, WIDE
from analysis.gap.search.deviation import channel_sizes, likeness, units_of
from hardware.description.arrays import BoolArray, FloatArray


@dataclass(frozen=True)
class Unnamed:
    """An answer that names no effect.

    Attributes
    ----------
    name
        As people read it.
    tau
        Size of the deviation; NaN for the visible one that suits the campaign best.
    wide
        Tolerances by which those coefficients may be off that a test is made to find.
    odd_run
        Name of the run from which nothing is expected of others.
    """

    name: str
    tau: float = TOLERATED
    wide: float = 1.0
    odd_run: str = ""


NO_GAP: Final = Unnamed("no gap")
SOMETHING_UNKNOWN: Final = Unnamed("something unknown", tau=math.nan)
OTHER_COEFFICIENTS: Final = Unnamed("other coefficients", wide=WIDE)


def odd(run: str) -> Unnamed:
    """Return the answer that one run went wrong by itself."""
    return Unnamed(f"run {run} alone", odd_run=run)


@dataclass(frozen=True, eq=False)
class Beside:
    """A deviation beside an answer, in the observations made and in further ones.

    Attributes
    ----------
    counts
        Which of the observations made tell anything, shape ``(made,)``.
    widths
        By what the first shared columns are wider than their priors.
    root
        Lower root of the covariance of the observations that count, their noise in it.
    reach
        The covariance between them and further ones, whitened by it, ``(counting, further)``.
    further
        Covariance of the deviation in further observations.
    """

    counts: BoolArray
    widths: FloatArray
    root: FloatArray
    reach: FloatArray
    further: FloatArray

    def scaled(self, columns: FloatArray) -> FloatArray:
        """Return shared columns in units of this answer's priors."""
        widths = np.ones(columns.shape[1])
        widths[: len(self.widths)] = self.widths
        return columns * widths

    def white(self, columns: FloatArray) -> FloatArray:
        """Return columns over the observations made, whitened, of those that count."""
        return np.asarray(np.linalg.solve(self.root, columns[self.counts]), np.float64)


@dataclass(frozen=True, eq=False)
class Deviation:
    """A deviation of 1 over a campaign and further runs.

    Attributes
    ----------
    sought
        Which of the free numbers a test is made to find, shape ``(free,)``.
    """

    problem: Problem
    ahead: Problem
    sought: BoolArray

    def beside(self, answer: Unnamed) -> Beside:
        """Return what stands beside an answer."""
        if not math.isnan(answer.tau):
            return self._of_size(answer, answer.tau)
        visible = [self._of_size(answer, tau) for tau in TAUS if tau > TOLERATED]
        return max(visible, key=self._log_evidence)

    def _of_size(self, answer: Unnamed, tau: float) -> Beside:
        made = self.problem.simulator.stack
        names = [run.name != answer.odd_run for run in made.runs]
        counts, n = np.array(names)[made.run], len(made.run)
        kernel = tau**2 * self._kernel
        root = np.linalg.cholesky(np.eye(int(counts.sum())) + kernel[:n, :n][counts][:, counts])
        reach = np.linalg.solve(root, kernel[:n, n:][counts])
        widths = np.where(self.sought, answer.wide, 1.0)
        return Beside(counts, widths, root, reach, kernel[n:, n:])

    def _log_evidence(self, beside: Beside) -> float:
        """Return that of no effect, but for a constant that all sizes share."""
        columns, residual = self.problem.nuisances.columns, self.problem.residual
        white = beside.white(np.column_stack((beside.scaled(columns), residual)))
        slopes, target = white[:, :-1], white[:, -1]
        precision = np.eye(slopes.shape[1]) + slopes.T @ slopes
        pull = slopes.T @ target
        misfit = target @ target - pull @ np.linalg.solve(precision, pull)
        volume = 2.0 * np.log(np.diagonal(beside.root)).sum() + np.linalg.slogdet(precision)[1]
        return -0.5 * float(misfit + volume)

    @cached_property
    def _kernel(self) -> FloatArray:
        """Covariance in all observations, those made first, in sigma."""
        made, after = self.problem.simulator.stack, self.ahead.simulator.stack
        sizes = channel_sizes(made, self.problem.simulator.nominal)
        scale = np.concatenate(
            [units_of(stack, sizes) / stack.uncertainty for stack in (made, after)]
        )
        numbers: dict[object, int] = {}
        components = (*made.components, *after.components)
        cell = np.array([numbers.setdefault(component, len(numbers)) for component in components])
        run = np.concatenate((made.run, len(made.runs) + after.run))
        alike = likeness([run.set_point for run in (*made.runs, *after.runs)])
        same = cell[:, None] == cell
        return np.asarray(same * alike[np.ix_(run, run)] * np.outer(scale, scale), np.float64)
