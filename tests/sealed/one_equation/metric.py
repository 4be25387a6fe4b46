"""The covariance that a hypothesis gives the whitened difference, and what it weighs with it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from hardware.description.arrays import FloatArray
from tests.sealed.one_equation.kernel import Kernel


@dataclass(frozen=True, eq=False)
class Metric:
    """The covariance ``S = 1 + tau^2 K + N N^T`` of what a hypothesis does not name.

    Attributes
    ----------
    columns
        Columns N with unit normal priors, whitened by noise, shape ``(observations, columns)``.
    kernel
        Covariance K of a deviation of no particular form at ``tau = 1``; ``None`` for none.
    tau
        Size of that deviation.
    """

    columns: FloatArray
    kernel: Kernel | None = None
    tau: float = 0.0

    @cached_property
    def _rotated(self) -> FloatArray:
        return self._turn(self.columns)

    @cached_property
    def _diagonal(self) -> FloatArray:
        if self.kernel is None:
            return np.ones(len(self.columns))
        return np.asarray(1.0 + self.tau**2 * self.kernel.values, np.float64)

    @cached_property
    def _factor(self) -> tuple[FloatArray, bool]:
        gram = self._rotated.T @ (self._rotated / self._diagonal[:, None])
        if not len(gram):
            return gram, True
        factor, lower = cho_factor(np.eye(len(gram)) + gram)
        return np.asarray(factor, np.float64), bool(lower)

    @cached_property
    def log_determinant(self) -> float:
        """Log of the determinant of S."""
        own = float(np.sum(np.log(self._diagonal)))
        return own + 2.0 * float(np.sum(np.log(np.diagonal(self._factor[0]))))

    def whiten(self, columns: FloatArray) -> FloatArray:
        """Return ``S^-1`` times columns."""
        weight = self._diagonal if columns.ndim == 1 else self._diagonal[:, None]
        left = self._turn(columns) / weight
        if self.columns.shape[1]:
            inner = cho_solve(self._factor, self._rotated.T @ left)
            left = left - (self._rotated @ inner) / weight
        return left if self.kernel is None else self.kernel.back(left)

    def _turn(self, columns: FloatArray) -> FloatArray:
        return columns if self.kernel is None else self.kernel.turn(columns)
