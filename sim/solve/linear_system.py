"""Linear systems: exact response to a frequency, and exact steps under a polynomial input.

Between two samples the input is a polynomial, and the system's answer to it is exact (one matrix
exponential). So the only error is that of the polynomial:

* :func:`hermite_hold`, for inputs known with their first two derivatives: fifth degree through both
  ends, relative error (w h)^6 / 46080 at the angular frequency w and the sample interval h
  (2e-14 at 1 Hz and 200 Hz);
* :func:`causal_hold`, for inputs known at the samples only: the polynomial through the newest
  ``degree + 1`` samples; relative error 0.013 (w h)^4 for degree 3 and 0.014 (w h)^6 for degree 5.
"""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import TypeAlias

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray
from sim.solve.compilation import follow

# A matrix or vector as a value that can be hashed, kept in a state or read from a file.
Rows: TypeAlias = tuple[tuple[float, ...], ...]

_HERMITE = 6  # data of an input at both ends of a step, and coefficients of its polynomial


@dataclass(frozen=True, eq=False)
class LinearSystem:
    """``x' = A x + B u``, ``y = C x + D u``; shapes (n, n), (n, p), (q, n), (q, p)."""

    A: FloatArray
    B: FloatArray
    C: FloatArray
    D: FloatArray

    def response(self, s: ComplexArray) -> ComplexArray:
        """Return the transfer matrices at the Laplace variables ``s``, shape ``(k, q, p)``."""
        resolvent = s[:, np.newaxis, np.newaxis] * np.eye(len(self.A)) - self.A
        response: ComplexArray = self.C @ np.linalg.solve(
            resolvent, np.broadcast_to(self.B.astype(complex), (s.size, *self.B.shape))
        )
        return response + self.D


@dataclass(frozen=True, eq=False)
class Hold:
    """One sample's step of ``x' = A x + B u`` under an input that is a polynomial between samples.

    Attributes
    ----------
    step
        Shape ``(n, n)``.
    weights
        What each datum of the input adds to the state, shape ``(data, n, p)``.
    """

    step: FloatArray
    weights: FloatArray

    @property
    def past(self) -> int:
        """How many samples before a block its first step needs."""
        return len(self.weights) - 1

    def forcing(self, inputs: FloatArray) -> FloatArray:
        """Return what the inputs add to the state in each step.

        The result has the shape ``(samples, n)``.

        Parameters
        ----------
        inputs
            Shape ``(past + samples, p)``.
        """
        count = len(inputs) - self.past
        total: FloatArray = inputs[:count] @ self.weights[0].T
        for j in range(1, len(self.weights)):
            total += inputs[j : j + count] @ self.weights[j].T
        return total

    def run(self, state: FloatArray, inputs: FloatArray) -> FloatArray:
        """Return the states at the samples, shape ``(samples, n)``; inputs as for `forcing`."""
        return follow(self.step, self.forcing(inputs), state)


def causal_hold(system: LinearSystem, step_s: float, degree: int) -> Hold:
    """Return the step under the polynomial through the newest ``degree + 1`` samples."""
    step, moments = _moments(as_rows(system.A), step_s, degree)
    nodes = np.arange(1 - degree, 2, dtype=np.float64)
    coefficients = np.linalg.inv(np.vander(nodes, increasing=True))  # (power, datum)
    return Hold(step, np.einsum("mj,mab,bp->jap", coefficients, moments, system.B))


def hermite_hold(
    A: FloatArray, inputs: tuple[FloatArray, FloatArray, FloatArray], step_s: float
) -> Hold:
    """Return the step of ``x' = A x + B0 y + B1 y' + B2 y''`` with y known with two derivatives.

    Its inputs are ``(y, y', y'')`` side by side, p = 3 times the width of y; one sample is needed
    before a block.
    """
    step, moments = _moments(as_rows(A), step_s, _HERMITE - 1)
    powers = np.arange(_HERMITE)
    gains = moments @ inputs[0]
    gains[1:] += (powers[1:, None, None] / step_s) * (moments[:-1] @ inputs[1])
    twice = powers[2:] * (powers[2:] - 1) / step_s**2
    gains[2:] += twice[:, None, None] * (moments[:-2] @ inputs[2])
    data = np.einsum("md,map->dap", _hermite(step_s), gains)
    return Hold(step, np.stack([np.hstack(data[:3].tolist()), np.hstack(data[3:].tolist())]))


def _hermite(step_s: float) -> FloatArray:
    """Return the matrix from value, slope and curvature at both ends to coefficients on 0 to 1."""
    at_0 = [np.eye(_HERMITE)[d] * math.factorial(d) for d in range(3)]
    powers = np.arange(_HERMITE)
    at_1 = [np.array([math.perm(int(m), d) for m in powers], dtype=np.float64) for d in range(3)]
    scale = np.array([1.0, step_s, step_s**2] * 2)
    inverse: FloatArray = np.linalg.inv(np.array(at_0 + at_1)) * scale
    return inverse


@lru_cache(maxsize=256)
def _moments(A: Rows, step_s: float, degree: int) -> tuple[FloatArray, FloatArray]:
    """Return ``exp(A h)`` and the integrals of ``exp(A (h - t)) (t/h)^m dt`` over a step.

    One exponential of a larger matrix, in which the powers of t/h are states as well.
    """
    from scipy.linalg import expm

    n = len(A)
    large = np.zeros(((degree + 2) * n, (degree + 2) * n))
    large[:n, :n] = np.array(A) * step_s
    for m in range(degree + 1):
        large[m * n : (m + 1) * n, (m + 1) * n : (m + 2) * n] = np.eye(n)
    exponential = expm(large)
    scale = [math.factorial(m) * step_s for m in range(degree + 1)]
    blocks = [exponential[:n, (m + 1) * n : (m + 2) * n] * scale[m] for m in range(degree + 1)]
    return exponential[:n, :n], np.array(blocks)


def as_rows(matrix: FloatArray) -> Rows:
    """Return a matrix as a value that can be hashed."""
    return tuple(tuple(float(value) for value in row) for row in matrix)
