"""Exact steps of the linear part of a body, for each set of coordinates held by friction."""

from dataclasses import dataclass
from functools import lru_cache
from itertools import product

import numpy as np

from hardware.description.arrays import BoolArray, FloatArray, IntArray
from sim.solve.linear_system import Rows

# A reversal is found to 2^-32 of a step, about a picosecond.
LEVELS = 32


@dataclass(frozen=True, eq=False)
class Propagators:
    """Matrices of ``x' = A x + B f`` and of its steps, one set for each pattern of stuck ones.

    Attributes
    ----------
    index
        Which set belongs to a pattern, shape ``(2^n,)``; -1 where that pattern cannot be.
    A, B
        Shapes ``(sets, 2n, 2n)`` and ``(sets, 2n, n)``; f are loads on the coordinates.
    E, G
        Steps of the length ``h / 2^level``: ``x -> E x + G f``, shapes ``(sets, levels, 2n, 2n)``
        and ``(sets, levels, 2n, n)``.
    """

    index: IntArray
    A: FloatArray
    B: FloatArray
    E: FloatArray
    G: FloatArray

    @property
    def arrays(self) -> tuple[IntArray, FloatArray, FloatArray, FloatArray, FloatArray]:
        """The five arrays as the compiled loop takes them."""
        return self.index, self.A, self.B, self.E, self.G


@lru_cache(maxsize=64)
def propagators(
    mass: Rows, damping: Rows, stiffness: Rows, rubbing: tuple[bool, ...], step_s: float
) -> Propagators:
    """Return the steps of ``M q'' + C q' + K q = f``.

    Parameters
    ----------
    rubbing
        Which coordinates have dry friction and so may stick.
    step_s
        Length of a whole step.
    """
    n = len(rubbing)
    levels = LEVELS + 2 if any(rubbing) else 2
    index = np.full(2**n, -1, dtype=np.int64)
    sets: list[tuple[FloatArray, FloatArray]] = []
    for stuck in product(*((False, True) if rubs else (False,) for rubs in rubbing)):
        index[sum(1 << i for i, held in enumerate(stuck) if held)] = len(sets)
        sets.append(_first_order(mass, damping, stiffness, np.array(stuck)))
    A, B = (
        np.array([matrices[0] for matrices in sets]),
        np.array([matrices[1] for matrices in sets]),
    )
    steps: FloatArray = np.ldexp(step_s, -np.arange(levels))
    E, G = _steps(A, B, steps)
    return Propagators(index, A, B, E, G)


def _first_order(
    mass: Rows, damping: Rows, stiffness: Rows, stuck: BoolArray
) -> tuple[FloatArray, FloatArray]:
    """Return A and B with the stuck coordinates at rest."""
    n = len(mass)
    (free,) = np.nonzero(~stuck)
    A, B = np.zeros((2 * n, 2 * n)), np.zeros((2 * n, n))
    A[free, n + free] = 1.0
    if free.size:
        inverse = np.linalg.inv(np.array(mass)[np.ix_(free, free)])
        rows = (n + free)[:, np.newaxis]
        A[rows, np.arange(n)] = -inverse @ np.array(stiffness)[free]
        A[rows, n + free] = -inverse @ np.array(damping)[np.ix_(free, free)]
        B[rows, free] = inverse
    return A, B


def _steps(A: FloatArray, B: FloatArray, steps_s: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return E and G for each set and each length, from one exponential of a larger matrix."""
    count, size, n = B.shape
    large = np.zeros((count, steps_s.size, size + n, size + n))
    large[:, :, :size, :size] = A[:, np.newaxis] * steps_s[:, np.newaxis, np.newaxis]
    large[:, :, :size, size:] = B[:, np.newaxis] * steps_s[:, np.newaxis, np.newaxis]
    exponential = _exponential(large)
    E = np.ascontiguousarray(exponential[:, :, :size, :size])
    return E, np.ascontiguousarray(exponential[:, :, :size, size:])


def _exponential(matrices: FloatArray) -> FloatArray:
    """Return ``exp(A)`` of many small matrices by its series, shape ``(..., n, n)``.

    A step is a tenth of a radian at most, so a dozen terms reach the last digit. A general routine
    solves a system for each matrix, and where the library shares such systems out to threads their
    start takes several hundred times as long as the sums do.
    """
    previous = np.zeros_like(matrices)
    total = term = np.broadcast_to(np.eye(matrices.shape[-1]), matrices.shape)
    k = 0
    while not np.array_equal(previous, total):
        k += 1
        term = term @ matrices / k
        previous, total = total, total + term
    return total
