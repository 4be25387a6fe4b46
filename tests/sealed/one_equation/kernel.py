"""A deviation of no particular form: alike for runs alike in set-point, and of each run's own."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from analysis.gap.components import Component, Part, Stack
from analysis.gap.unknown import likeness
from hardware.description.arrays import BoolArray, FloatArray
from hardware.description.channels import DISPLACEMENTS, FORCES

_TRENDS: Final = (Part.TREND, Part.TREND_IN_PHASE, Part.TREND_QUADRATURE)
_HARMONIC: Final = (Part.MEAN, Part.IN_PHASE, Part.QUADRATURE, *_TRENDS)
# What a deviation of 1 is of what has no harmonics: an e-fold of noise, every pulse; of the
# frequency, which is known to 1e-4, a hundredth.
_UNITS: Final = {Part.FREQUENCY: 0.01}
_FLOORS: Final = dict.fromkeys(DISPLACEMENTS, 1e-3) | dict.fromkeys(FORCES, 1.0)  # m, N


@dataclass(frozen=True, eq=False)
class Kernel:
    """The covariance of a deviation, block by block: a block for each component of all runs.

    Attributes
    ----------
    cells
        Rows of each block.
    blocks
        Covariances of them at ``tau = 1``, in sigma.
    """

    cells: tuple[NDArray[np.intp], ...]
    blocks: tuple[FloatArray, ...]
    count: int

    def only(self, rows: BoolArray) -> "Kernel":
        """Return the covariance of a deviation that some observations have, and no others."""
        blocks = [
            np.where(np.outer(rows[cell], rows[cell]), block, 0.0)
            for cell, block in zip(self.cells, self.blocks, strict=True)
        ]
        return Kernel(self.cells, tuple(blocks), self.count)

    def times_share(self, share: float) -> "Kernel":
        """Return a share of the covariance."""
        return Kernel(self.cells, tuple(share * one for one in self.blocks), self.count)

    @classmethod
    def of(cls, stack: Stack, nominal: FloatArray) -> "Kernel":
        """Return the covariance for a stack of runs.

        Parameters
        ----------
        nominal
            What the simulation says, shape ``(observations,)``: a deviation is relative to it.
        """
        scale = units(stack, nominal) / stack.uncertainty
        alike = likeness([run.set_point for run in stack.runs])
        cells, blocks = [], []
        places: dict[Component, list[int]] = {}
        for at, one in enumerate(stack.components):
            places.setdefault(one, []).append(at)
        for found in places.values():
            rows = np.array(found)
            runs, own = stack.run[rows], scale[rows]
            cells.append(rows)
            blocks.append(alike[np.ix_(runs, runs)] * own[:, None] * own)
        return cls(tuple(cells), tuple(blocks), len(stack.components))

    @cached_property
    def _spectrum(self) -> tuple[FloatArray, csr_array]:
        values = np.zeros(self.count)
        rows, columns, entries = [], [], []
        for cell, block in zip(self.cells, self.blocks, strict=True):
            found, vectors = np.linalg.eigh(block)
            values[cell] = np.maximum(found, 0.0)
            rows.append(np.repeat(cell, len(cell)))
            columns.append(np.tile(cell, len(cell)))
            entries.append(vectors.ravel())
        shape = (self.count, self.count)
        where = (np.concatenate(rows), np.concatenate(columns))
        return values, csr_array((np.concatenate(entries), where), shape=shape)

    @property
    def values(self) -> FloatArray:
        """Eigenvalues, shape ``(observations,)``, in the order in which :meth:`turn` has them."""
        return self._spectrum[0]

    def turn(self, columns: FloatArray) -> FloatArray:
        """Return columns in the eigenvectors' coordinates."""
        return np.asarray(self._spectrum[1].T @ columns, np.float64)

    def back(self, columns: FloatArray) -> FloatArray:
        """Return columns from the eigenvectors' coordinates."""
        return np.asarray(self._spectrum[1] @ columns, np.float64)


def units(stack: Stack, nominal: FloatArray) -> FloatArray:
    """Return how large a deviation of 1 is at each observation, in the observation's unit.

    Of a channel its predicted first harmonic, root mean square over the campaign, over the order;
    of a mean the same; of a change per period that over the periods.
    """
    squares: dict[str, list[float]] = {}
    for one, value in zip(stack.components, nominal, strict=True):
        first = one.part in (Part.IN_PHASE, Part.QUADRATURE) and one.order == 1
        standing = one.part is Part.MEAN and one.channel not in (*FORCES, *DISPLACEMENTS)
        if first or standing:
            squares.setdefault(one.channel, []).append(float(value) ** 2)
    runs = max(len(stack.turning), 1)
    sizes = {name: math.sqrt(sum(found) / runs) for name, found in squares.items()}
    out = np.ones(len(stack.components))
    for at, one in enumerate(stack.components):
        if one.part in _HARMONIC:
            size = max(sizes.get(one.channel, 0.0), _FLOORS.get(one.channel, 0.1))
            out[at] = size / max(one.order, 1)
            if one.part in _TRENDS:
                out[at] /= max(stack.runs[stack.run[at]].periods, 1)
        else:
            out[at] = _UNITS.get(one.part, 1.0)
    return out
