"""The Gaussian of a hypothesis, reduced to the few numbers that its evidence needs."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import cholesky, solve_triangular

from hardware.description.arrays import FloatArray


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

    def widened(self, kept: int, at: Sequence[int], scale: FloatArray | float) -> "Reduced":
        """Return the products of the first columns under a covariance with some others in it.

        Parameters
        ----------
        kept
            How many of the columns X are asked for.
        at
            Which of the others, M, are in it: ``S + M M^T``.
        scale
            What each of them counts, shape ``(len(at),)`` or one for all.
        """
        if not len(at):
            return Reduced(self.gram[:kept, :kept], self.log_determinant)
        own = np.broadcast_to(scale, len(at))
        across = own[:, None] * self.gram[at, :kept]
        within = own[:, None] * self.gram[np.ix_(at, at)] * own
        return _absorbed(self.gram[:kept, :kept], across, within, self.log_determinant)


def _absorbed(
    gram: FloatArray, across: FloatArray, within: FloatArray, log_determinant: float
) -> Reduced:
    """Return products under ``S + M M^T``, of ``X^T S^-1 X``, ``M^T S^-1 X``, ``M^T S^-1 M``.

    The last is written over.
    """
    within.flat[:: len(within) + 1] += 1.0
    lower = cholesky(within, lower=True, overwrite_a=True, check_finite=False)
    half = solve_triangular(lower, across, lower=True, check_finite=False)
    logs = 2.0 * float(np.sum(np.log(np.diagonal(lower))))
    return Reduced(np.asarray(gram - half.T @ half, np.float64), log_determinant + logs)


@dataclass(frozen=True, eq=False)
class Weighted:
    """A diagonal D, and columns of which hypotheses choose some: ``S = D + C C^T``.

    Attributes
    ----------
    columns
        Of all hypotheses, shape ``(observations, columns)``.
    diagonal
        Shape ``(observations,)``.
    """

    columns: FloatArray
    diagonal: FloatArray

    @cached_property
    def _gram(self) -> FloatArray:
        return np.asarray(self.columns.T @ (self.columns / self.diagonal[:, None]), np.float64)

    @cached_property
    def _log_diagonal(self) -> float:
        return float(np.sum(np.log(self.diagonal)))

    def reduced(self, scale: FloatArray, of: FloatArray) -> Reduced:
        """Return products of some columns under ``D + C C^T``.

        Parameters
        ----------
        scale
            What each of the columns counts in C, shape ``(columns,)``; 0 for what is not in it.
        of
            The columns X, shape ``(observations, any)``.
        """
        kept = np.flatnonzero(scale)
        of_over = of / self.diagonal[:, None]
        gram = np.asarray(of.T @ of_over, np.float64)
        if not len(kept):
            return Reduced(gram, self._log_diagonal)
        own = scale[kept]
        within = self._gram[np.ix_(kept, kept)]
        within *= own
        within *= own[:, None]
        across = own[:, None] * (self.columns.T @ of_over)[kept]
        return _absorbed(gram, across, within, self._log_diagonal)
