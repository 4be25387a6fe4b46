"""Slopes by complex step: exact to rounding, for covariances to be carried with."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from analysis.kinematics.geometry import Waves

_STEP = 1e-30  # its square is lost in rounding: the slope has no truncation error


def slope(function: Callable[[Waves], Waves], values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the Jacobian of a function of real numbers.

    Parameters
    ----------
    function
        Of ``(trials, n)`` to ``(trials, m)``, analytic: nothing conjugated, no absolute values.
    values
        Shape ``(n,)``.

    Returns
    -------
    numpy.ndarray
        Shape ``(m, n)``.
    """
    stepped = values + 1j * _STEP * np.eye(len(values))
    return np.asarray(function(stepped).imag.T / _STEP, dtype=np.float64)
