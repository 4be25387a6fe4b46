"""Block Schwarz form: every memory that is passive and vanishes at rest, and nothing else.

In units of the square root of energy the memory of m degrees of freedom is

    xi' = (J - R) xi + G v        mu = G^T xi        G = -J X

with J skew and block tridiagonal (energy handed along a ladder of N blocks of m states), R = L L^T
in the last block only (there the energy leaves with the waves) and X zero in the last block. Then

    d/dt (xi^T xi / 2) = v^T mu - xi^T R xi,

so that for any motion the work done on the water exceeds what is stored: the memory is passive
whatever the numbers are. R X = 0 makes K(0) = G^T (R - J)^-1 G = X^T R X = 0: no damping at zero
frequency. For m = 1 the 2 N - 1 numbers reach every positive real, strictly proper rational
function of degree N with a zero at the origin.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hardware.description.arrays import FloatArray, IntArray


@dataclass(frozen=True)
class Matrices:
    """J - R, G and the infinite-frequency added mass for one set of numbers."""

    state: FloatArray
    input: FloatArray
    added_mass: FloatArray


@dataclass(frozen=True)
class Ladder:
    """Where each of the form's numbers stands.

    The numbers of a form are one vector: those of J, of L, of X, of the added mass (which is
    symmetric).

    Attributes
    ----------
    blocks
        Number N of blocks, at least 2.
    size
        Number m of degrees of freedom, and of states in a block.
    """

    blocks: int
    size: int

    @property
    def states(self) -> int:
        """Number N m of states."""
        return self.blocks * self.size

    @cached_property
    def bases(self) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Unit matrices of J (p, n, n), L (p, n, m), X (p, n, m) and the added mass (p, m, m)."""
        n, m = self.states, self.size
        unit = np.eye(n)
        coupled = [(i, j) for i in range(n) for j in range(i + 1, n) if j // m - i // m < 2]
        skew = [np.outer(unit[i], unit[j]) - np.outer(unit[j], unit[i]) for i, j in coupled]
        lower = [np.outer(unit[n - m + i], np.eye(m)[j]) for i in range(m) for j in range(i + 1)]
        inner = [np.outer(unit[i], np.eye(m)[j]) for i in range(n - m) for j in range(m)]
        pairs = [np.outer(np.eye(m)[i], np.eye(m)[j]) for i in range(m) for j in range(i, m)]
        symmetric = [np.maximum(pair, pair.T) for pair in pairs]
        return np.array(skew), np.array(lower), np.array(inner), np.array(symmetric)

    @cached_property
    def cuts(self) -> IntArray:
        """Where the numbers of L, of X and of the added mass begin."""
        return np.cumsum([len(basis) for basis in self.bases[:-1]])

    def split(self, numbers: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Return J, L (in the last block of n rows), X and the added mass."""
        parts = np.split(numbers, self.cuts)
        j, low, x, a = (np.tensordot(p, b, 1) for p, b in zip(parts, self.bases, strict=True))
        return j, low, x, a

    def matrices(self, numbers: FloatArray) -> Matrices:
        """Return the state space that the numbers stand for."""
        skew, lower, inner, added = self.split(numbers)
        return Matrices(skew - lower @ lower.T, -skew @ inner, added)
