"""The Gaussian of a hypothesis, reduced to the few numbers that its evidence needs."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import cholesky, solve_triangular

from hardware.description.arrays import BoolArray, FloatArray


@dataclass(frozen=True, eq=False)
class Reduced:
    """Products under the inverse of a covariance S.

    Attributes
    ----------
    gram
        ``X^T S^-1 X`` of the columns X that were asked for.
    log_determinant
        Log of the determinant of S.
    """

    gram: FloatArray
    log_determinant: float

    def widened(self, count: int, at: Sequence[int], scale: FloatArray | float) -> "Reduced":
        """Return the products of the first columns under a covariance with some others in it.

        Parameters
        ----------
        count
            How many of the columns X are asked for.
        at
            Which of the others, M, are in it: ``S + M M^T``.
        scale
            What each of them counts, shape ``(len(at),)`` or one for all.
        """
        if not len(at):
            return Reduced(self.gram[:count, :count], self.log_determinant)
        scales = np.broadcast_to(scale, len(at))
        across = scales[:, None] * self.gram[at, :count]
        within = scales[:, None] * self.gram[np.ix_(at, at)] * scales
        return _with_columns(self.gram[:count, :count], across, within, self.log_determinant)


def _with_columns(
    gram: FloatArray, across: FloatArray, within: FloatArray, log_determinant: float
) -> Reduced:
    """Return products under ``S + M M^T``, of ``X^T S^-1 X``, ``M^T S^-1 X``, ``M^T S^-1 M``.

    The last is written over.
    """
    lower, more = _factor(within)
    half = _solve(lower, across)
    return Reduced(np.asarray(gram - half.T @ half, np.float64), log_determinant + more)


def _factor(within: FloatArray) -> tuple[FloatArray, float]:
    """Return the Cholesky factor and log determinant of 1 and a matrix, which is written over."""
    within.flat[:: len(within) + 1] += 1.0
    lower = cholesky(within, lower=True, overwrite_a=True, check_finite=False)
    return lower, 2.0 * float(np.sum(np.log(np.diagonal(lower))))


def _solve(lower: FloatArray, columns: FloatArray) -> FloatArray:
    return np.asarray(solve_triangular(lower, columns, lower=True, check_finite=False), np.float64)


@dataclass(frozen=True, eq=False)
class Weighted:
    """What all hypotheses have, and columns of which each chooses some: ``S = D + A A^T + C C^T``.

    Attributes
    ----------
    columns
        A and C side by side, shape ``(observations, columns)``.
    diagonal
        D, shape ``(observations,)``.
    shared
        How many columns A has: it is worked into S once for all hypotheses.
    """

    columns: FloatArray
    diagonal: FloatArray
    shared: int = 0

    @cached_property
    def _under_shared(self) -> tuple[FloatArray, float, FloatArray, FloatArray]:
        """Factor and log determinant of D and A, what A has in common with C, and C's products."""
        rooted = self.columns / np.sqrt(self.diagonal)[:, None]
        gram = rooted.T @ rooted  # half the work of a product of two
        count = self.shared
        lower, log_determinant = _factor(gram[:count, :count].copy())
        half = _solve(lower, gram[:count, count:])
        log_determinant += float(np.sum(np.log(self.diagonal)))
        return lower, log_determinant, half, gram[count:, count:] - half.T @ half

    def reduced(self, scale: FloatArray, of: FloatArray) -> Reduced:
        """Return products of some columns under ``D + A A^T + C C^T``.

        Parameters
        ----------
        scale
            What each of the columns behind A counts in C, shape ``(columns - shared,)``; 0 for what
            is not in it.
        of
            The columns X, shape ``(observations, any)``.
        """
        return next(self.each([scale], [of]))

    def at_rows(self, of: FloatArray, rows: BoolArray) -> Reduced:
        """Return products of columns X, and behind them of a 1 in each of some rows, without C.

        Parameters
        ----------
        of
            The columns X, shape ``(observations, any)``.
        """
        lower, log_determinant, _, _ = self._under_shared
        over = of / self.diagonal[:, None]
        own = self.columns[:, : self.shared]
        of_rows = own[rows].T / self.diagonal[rows]
        shared = _solve(lower, np.hstack((own.T @ over, of_rows)))
        gram = -shared.T @ shared
        count = of.shape[1]
        gram[:count, :count] += of.T @ over
        gram[:count, count:] += over[rows].T
        gram[count:, :count] += over[rows]
        gram[count:, count:] += np.diag(1.0 / self.diagonal[rows])
        return Reduced(gram, log_determinant)

    def each(self, scales: Sequence[FloatArray], sets: Sequence[FloatArray]) -> Iterator[Reduced]:
        """Yield the same of several sets of columns X, each with what the others count beside it.

        One product with all of them at once costs a fraction of as many with a few columns each.
        """
        lower, log_determinant, half, products = self._under_shared
        columns = np.hstack([np.empty((len(self.diagonal), 0)), *sets])
        over = columns / self.diagonal[:, None]
        common = self.columns.T @ over
        shared = _solve(lower, common[: self.shared])
        across = common[self.shared :] - half.T @ shared
        ends = np.cumsum([0, *(columns.shape[1] for columns in sets)])
        for scale, first, last in zip(scales, ends[:-1], ends[1:], strict=True):
            at, rows = slice(first, last), np.flatnonzero(scale)
            gram = columns[:, at].T @ over[:, at] - shared[:, at].T @ shared[:, at]
            if not len(rows):
                yield Reduced(gram, log_determinant)
                continue
            weights = scale[rows]
            within = products[np.ix_(rows, rows)]
            within *= weights
            within *= weights[:, None]
            yield _with_columns(gram, weights[:, None] * across[rows, at], within, log_determinant)
