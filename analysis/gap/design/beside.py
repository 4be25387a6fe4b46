"""The answers that name no effect, and the deviation that stands beside any answer.

    r = N b + F t + d + e,    d ~ N(0, tau^2 K)

Tolerances N and a deviation d of no particular form are those of the evidence. As d is alike for
runs that are alike, what the campaign shows of it is expected of a further run too.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from analysis.gap.forward.problem import Problem
from analysis.gap.inference.constants import TAUS, TOLERATED, WIDE
from analysis.gap.inference.gaussian import Nuisances, null_evidence
from analysis.gap.search.deviation import channel_sizes, likeness, units_of
from hardware.description.arrays import BoolArray, FloatArray

if TYPE_CHECKING:
    from analysis.gap.observe.components import Component


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
class _Cell:
    """One component in all runs: a deviation of it is alike for runs that are alike.

    Attributes
    ----------
    made, after
        Its rows among the observations made that count, and among further ones.
    root
        Lower root of the covariance of those made, their noise in it.
    reach
        The covariance between them and further ones, whitened by it.
    left
        The covariance of further ones that those made leave.
    """

    made: NDArray[np.intp]
    after: NDArray[np.intp]
    root: FloatArray
    reach: FloatArray
    left: FloatArray


@dataclass(frozen=True, eq=False)
class Beside:
    """A deviation beside an answer, in the observations made and in further ones.

    Attributes
    ----------
    widths
        By what the first shared columns are wider than their priors.
    """

    cells: Sequence[_Cell]
    widths: FloatArray
    further_count: int

    def scaled(self, columns: FloatArray) -> FloatArray:
        """Return shared columns in units of this answer's priors."""
        widths = np.ones(columns.shape[1])
        widths[: len(self.widths)] = self.widths
        return columns * widths

    def white(self, columns: FloatArray) -> FloatArray:
        """Return columns over the observations made, whitened; 0 where these do not count."""
        white = np.zeros_like(columns)
        for cell in self.cells:
            white[cell.made] = np.linalg.solve(cell.root, columns[cell.made])
        return white

    def carried(self, white: FloatArray) -> FloatArray:
        """Return what whitened columns let expect of further observations."""
        carried = np.zeros((self.further_count, *white.shape[1:]))
        for cell in self.cells:
            carried[cell.after] = cell.reach.T @ white[cell.made]
        return carried

    @cached_property
    def deviation(self) -> csr_array:
        """What is left of it in further observations: its covariance."""
        rows = [np.repeat(cell.after, len(cell.after)) for cell in self.cells]
        columns = [np.tile(cell.after, len(cell.after)) for cell in self.cells]
        values = np.concatenate([cell.left.ravel() for cell in self.cells])
        places = np.concatenate(rows), np.concatenate(columns)
        return csr_array((values, places), shape=(self.further_count, self.further_count))


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
        counts = np.array([run.name != answer.odd_run for run in made.runs])[made.run]
        cells = [self._cell(rows[counts[rows]], after, tau) for rows, after in self._rows]
        widths = np.where(self.sought, answer.wide, 1.0)
        return Beside(cells, widths, len(self.ahead.simulator.stack.run))

    def _cell(self, rows: NDArray[np.intp], after: NDArray[np.intp], tau: float) -> _Cell:
        made = self.problem.simulator.stack
        run = np.concatenate(
            (made.run[rows], len(made.runs) + self.ahead.simulator.stack.run[after])
        )
        size = tau * np.concatenate((self._scales[0][rows], self._scales[1][after]))
        covariance, n = self._alike[np.ix_(run, run)] * np.outer(size, size), len(rows)
        root = np.asarray(np.linalg.cholesky(np.eye(n) + covariance[:n, :n]), np.float64)
        reach = np.asarray(np.linalg.solve(root, covariance[:n, n:]), np.float64)
        return _Cell(rows, after, root, reach, covariance[n:, n:] - reach.T @ reach)

    def _log_evidence(self, beside: Beside) -> float:
        """Return that of no effect, but for a constant that all sizes share."""
        columns, residual = self.problem.nuisances.columns, self.problem.residual
        white = beside.white(np.column_stack((beside.scaled(columns), residual)))
        volume = sum(float(np.log(np.diagonal(cell.root)).sum()) for cell in beside.cells)
        return null_evidence(white[:, -1], Nuisances(white[:, :-1])) - volume

    @cached_property
    def _rows(self) -> list[tuple[NDArray[np.intp], NDArray[np.intp]]]:
        """Rows of each component, among those made and further ones."""
        stacks = self.problem.simulator.stack, self.ahead.simulator.stack
        rows: dict[Component, tuple[list[int], list[int]]] = {}
        for number, stack in enumerate(stacks):
            for row, component in enumerate(stack.components):
                rows.setdefault(component, ([], []))[number].append(row)
        return [(np.array(made, int), np.array(after, int)) for made, after in rows.values()]

    @cached_property
    def _scales(self) -> tuple[FloatArray, FloatArray]:
        """How large a deviation of 1 is at each observation in sigma."""
        made, after = self.problem.simulator.stack, self.ahead.simulator.stack
        sizes = channel_sizes(made, self.problem.simulator.nominal)
        return units_of(made, sizes) / made.uncertainty, units_of(after, sizes) / after.uncertainty

    @cached_property
    def _alike(self) -> FloatArray:
        """How alike a deviation is between all runs, those made first."""
        runs = (*self.problem.simulator.stack.runs, *self.ahead.simulator.stack.runs)
        return likeness([run.set_point for run in runs])
