"""When a signal passes zero between two samples that are known with two derivatives."""

import numpy as np

from hardware.description.arrays import FloatArray

_MOST_STEPS = 100


def quintic(before: FloatArray, after: FloatArray) -> FloatArray:
    """Return the coefficients, constant first, of the polynomials on 0 to 1 with both ends' values.

    Each end has the rows value, first and second derivative; the result has shape (6, edges).
    """
    (f0, d0, c0), (f1, d1, c1) = before, after
    rise = f1 - f0
    return np.stack(
        [
            f0,
            d0,
            c0 / 2.0,
            10.0 * rise - 6.0 * d0 - 4.0 * d1 - 1.5 * c0 + 0.5 * c1,
            -15.0 * rise + 8.0 * d0 + 7.0 * d1 + 1.5 * c0 - c1,
            6.0 * rise - 3.0 * (d0 + d1) - 0.5 * (c0 - c1),
        ]
    )


def root(coefficients: FloatArray, at_1: FloatArray) -> FloatArray:
    """Return the root between 0 and 1 of each polynomial that changes sign to ``at_1`` at 1.

    Newton's method from the chord; a step that leaves the bracket is replaced by halving it.
    """
    low, high = np.zeros_like(at_1), np.ones_like(at_1)
    u: FloatArray = coefficients[0] / (coefficients[0] - at_1)
    slopes = coefficients[1:] * np.arange(1, 6)[:, np.newaxis]
    for _ in range(_MOST_STEPS):
        value, slope = _polynomial(coefficients, u), _polynomial(slopes, u)
        beyond = value * at_1 > 0.0
        low, high = np.where(beyond, low, u), np.where(beyond, u, high)
        newton = u - value / np.where(slope == 0.0, np.inf, slope)
        inside = (low <= newton) & (newton <= high) & (slope != 0.0)
        moved: FloatArray = np.where(inside, newton, (low + high) / 2.0)
        if not np.any(np.abs(moved - u) > np.finfo(np.float64).eps):
            return moved
        u = moved
    return u


def _polynomial(coefficients: FloatArray, u: FloatArray) -> FloatArray:
    value: FloatArray = coefficients[-1]
    for lower in coefficients[-2::-1]:
        value = value * u + lower
    return value
