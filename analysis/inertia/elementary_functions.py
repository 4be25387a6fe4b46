"""Elementary functions that keep their argument's type: a number stays one, an array stays one.

The formulas of this package are written once and serve single values, the Monte Carlo's arrays and
the budget's differences alike.
"""

from collections.abc import Callable
from typing import TypeVar, cast

import numpy as np

from hardware.description.arrays import FloatArray

Value = TypeVar("Value", float, FloatArray)


def sqrt(x: Value) -> Value:
    """Square root; NaN where the argument is negative."""
    with np.errstate(invalid="ignore"):
        return cast("Value", np.sqrt(x))


def sin(x: Value) -> Value:
    """Sine of an angle in radians."""
    return cast("Value", np.sin(x))


def cos(x: Value) -> Value:
    """Cosine of an angle in radians."""
    return cast("Value", np.cos(x))


def tan(x: Value) -> Value:
    """Tangent of an angle in radians."""
    return cast("Value", np.tan(x))


def arctan(x: Value) -> Value:
    """Angle in radians of that tangent, within a quarter turn of zero."""
    return cast("Value", np.arctan(x))


def inner(first: FloatArray, second: FloatArray) -> float:
    """Return the sum of the products of two long rows.

    Not by BLAS, which hands such rows to threads: where other work keeps the cores busy, waiting
    for them takes a hundred times as long as the sum.
    """
    return float(np.einsum("i,i->", first, second))


def jacobian(function: Callable[[FloatArray], FloatArray], at: FloatArray) -> FloatArray:
    """Return the derivative of a real-analytic function by complex steps: exact to rounding.

    The result has the shape ``(m, n)``.

    Parameters
    ----------
    function
        Takes shape ``(n,)`` and gives ``(m,)``; sums, products, quotients and roots only.
    at
        Where, shape ``(n,)``.
    """
    step = 1e-30
    columns = []
    for k in range(at.size):
        shifted = at.astype(np.complex128)
        shifted[k] += 1j * step
        columns.append(np.imag(function(cast("FloatArray", shifted))) / step)
    return np.stack(columns, axis=1).astype(np.float64)
