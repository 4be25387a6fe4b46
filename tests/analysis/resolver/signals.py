"""Synthetic runs of known content."""

import numpy as np
from numpy.typing import NDArray

from analysis.recording import Recording
from hardware.description.channels import Channel

FloatArray = NDArray[np.float64]


def recording(values: FloatArray, sample_rate_hz: float = 100.0, **fields: object) -> Recording:
    """Make a run of plain channels in newtons."""
    values = np.atleast_2d(values)
    channels = tuple(Channel(f"force_{k}", "N") for k in range(len(values)))
    return Recording("synthetic", channels, values, sample_rate_hz, **fields)  # type: ignore[arg-type]


def series(coefficients: FloatArray, cycles: FloatArray) -> FloatArray:
    """``A0 + sum S_n sin + C_n cos`` for coefficients ``[A0, S1, C1, ...]``."""
    theta = 2.0 * np.pi * cycles
    values = np.full_like(theta, coefficients[0])
    for n in range(1, (len(coefficients) - 1) // 2 + 1):
        values += coefficients[2 * n - 1] * np.sin(n * theta)
        values += coefficients[2 * n] * np.cos(n * theta)
    return values
