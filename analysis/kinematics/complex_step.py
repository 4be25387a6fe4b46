"""Derivatives by complex step, exact to rounding, for the propagation of covariances.

What is reckoned at each instant alone has a slope at each instant; harmonics follow by their waves.
"""

from collections.abc import Callable

import numpy as np

from analysis.kinematics.cycle import harmonics
from analysis.kinematics.geometry import Waves
from hardware.description.arrays import FloatArray

_STEP = 1e-30  # its square is lost in rounding: the slope has no truncation error

Pointwise = Callable[[Waves], Waves]
"""Of waves ``(..., k, instants)`` to ``(..., m, instants)``, each instant by itself; analytic:
nothing conjugated, no absolute values."""


def pointwise(function: Pointwise, inputs: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return a function's value for given waves, and its derivative.

    The results are values, slope: their shapes are ``(m, instants)`` and ``(m, k, instants)``.

    Parameters
    ----------
    inputs
        Shape ``(k, instants)``.
    """
    stepped = inputs + 1j * _STEP * np.eye(len(inputs))[:, :, None]
    value = function(stepped)
    slope = np.moveaxis(value.imag, 0, 1) / _STEP
    return np.asarray(value[0].real), np.asarray(slope, dtype=np.float64)


def by_parts(slope: FloatArray, inputs: FloatArray, orders: int) -> FloatArray:
    """Return the slope of the outputs' harmonics by the inputs' interleaved parts.

    The result has the shape ``(2 * m * (orders + 1), parts)``.

    Parameters
    ----------
    slope
        Of :func:`pointwise`, shape ``(m, k, instants)``.
    inputs
        Waves of each input per part, shape ``(k, parts, instants)``.
    """
    part_waves = np.einsum("mkt,kpt->pmt", slope, inputs, optimize=True)
    return np.asarray(harmonics(part_waves, orders).T)
