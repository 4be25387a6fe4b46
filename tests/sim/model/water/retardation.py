"""The retardation function of a memory of the water."""

import numpy as np
from scipy.linalg import expm

from hardware.description.arrays import FloatArray
from sim.model.water.radiation import Radiation


def retardation(radiation: Radiation, time_s: FloatArray) -> FloatArray:
    """Return C exp(A t) B, shape ``(k, 2, 2)`` over the times, from 0 s on."""
    decayed = expm(time_s[:, None, None] * radiation.state_matrix)
    return np.asarray(radiation.output_matrix @ decayed @ radiation.input_matrix)
