"""A deviation of no particular form: alike for observations that are alike."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from hardware.description.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class Kernel:
    """The covariance of a deviation, block by block.

    Attributes
    ----------
    cells
        Rows of each block; every observation is in one.
    blocks
        Covariances of them at ``tau = 1``, in sigma.
    """

    cells: tuple[NDArray[np.intp], ...]
    blocks: tuple[FloatArray, ...]

    @classmethod
    def of(
        cls, cells: Sequence[NDArray[np.intp]], alike: Sequence[FloatArray], scale: FloatArray
    ) -> "Kernel":
        """Return the covariance of deviations that are alike within cells.

        Parameters
        ----------
        alike
            Correlation of each cell's observations.
        scale
            How large a deviation of 1 is at each observation, in sigma.
        """
        blocks = [
            correlation * scale[rows][:, None] * scale[rows]
            for rows, correlation in zip(cells, alike, strict=True)
        ]
        return cls(tuple(cells), tuple(blocks))

    @cached_property
    def _spectrum(self) -> tuple[FloatArray, csr_array]:
        count = sum(len(cell) for cell in self.cells)
        values = np.zeros(count)
        rows, columns, entries = [], [], []
        for cell, block in zip(self.cells, self.blocks, strict=True):
            eigenvalues, vectors = np.linalg.eigh(block)
            values[cell] = np.maximum(eigenvalues, 0.0)
            rows.append(np.repeat(cell, len(cell)))
            columns.append(np.tile(cell, len(cell)))
            entries.append(vectors.ravel())
        where = (np.concatenate(rows), np.concatenate(columns))
        return values, csr_array((np.concatenate(entries), where), shape=(count, count))

    @property
    def values(self) -> FloatArray:
        """Eigenvalues, shape ``(observations,)``, each at a row of the cell that it belongs to."""
        return self._spectrum[0]

    def rotated(self, columns: FloatArray) -> FloatArray:
        """Return columns in the eigenvectors' coordinates."""
        return np.asarray(self._spectrum[1].T @ columns, np.float64)
