"""The Gaussian of a hypothesis, reduced to the few numbers that its evidence needs."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import cho_factor, cho_solve

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
    def _over(self) -> FloatArray:
        return np.asarray(self.columns / self.diagonal[:, None], np.float64)

    @cached_property
    def _gram(self) -> FloatArray:
        return np.asarray(self.columns.T @ self._over, np.float64)

    @cached_property
    def _log_diagonal(self) -> float:
        return float(np.sum(np.log(self.diagonal)))

    def reduced(self, scale: FloatArray, of: FloatArray, more: FloatArray | None = None) -> Reduced:
        """Return products of some columns under ``D + C C^T``.

        Parameters
        ----------
        scale
            What each of the columns counts in C, shape ``(columns,)``; 0 for what is not in it.
        of
            The columns X, shape ``(observations, any)``.
        more
            Further columns of C, shape ``(observations, any)``.
        """
        kept = np.flatnonzero(scale)
        own = scale[kept]
        within = self._gram[np.ix_(kept, kept)] * own[:, None] * own
        across = own[:, None] * (self._over[:, kept].T @ of)
        of_over = of / self.diagonal[:, None]
        if more is not None and more.shape[1]:
            beside = own[:, None] * (self._over[:, kept].T @ more)
            more_over = more / self.diagonal[:, None]
            within = np.block([[within, beside], [beside.T, more.T @ more_over]])
            across = np.vstack((across, more.T @ of_over))
        gram = of.T @ of_over
        if not len(within):
            return Reduced(gram, self._log_diagonal)
        factor = cho_factor(np.eye(len(within)) + within, lower=True)
        gram = gram - across.T @ cho_solve(factor, across)
        logs = 2.0 * float(np.sum(np.log(np.diagonal(factor[0]))))
        return Reduced(np.asarray(gram, np.float64), self._log_diagonal + logs)
