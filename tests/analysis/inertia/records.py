"""Records of pendulums from closed forms: the oracle of the tests beside it."""

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
G = 9.81


def amplitude(
    t: FloatArray, first: float, *, friction: float, viscous: float, quadratic: float
) -> FloatArray:
    """Solve ``dA/dt = -(f + v A + q A^2)`` exactly; 0 once friction has stopped it."""
    root = np.sqrt(complex(viscous**2 - 4.0 * friction * quadratic))
    r1, r2 = (-viscous + root) / (2.0 * quadratic), (-viscous - root) / (2.0 * quadratic)
    ratio = (first - r1) / (first - r2) * np.exp(-root * t)
    value = np.real((r1 - r2 * ratio) / (1.0 - ratio))
    stopped = np.minimum.accumulate(np.where(value > 0.0, 1.0, 0.0))
    return np.asarray(np.clip(value, 0.0, first) * stopped)


def swinging(
    t: FloatArray,
    period_s: float,
    size: FloatArray,
    *,
    phase_rad: float = 0.0,
    softening: float = 0.0,
) -> FloatArray:
    """Oscillation of amplitude ``size`` whose period is ``T (1 + softening A^2)``."""
    rate = 2.0 * np.pi / (period_s * (1.0 + softening * size**2))
    step = np.diff(t) * 0.5 * (rate[1:] + rate[:-1])
    return np.asarray(size * np.cos(phase_rad + np.concatenate(([0.0], np.cumsum(step)))))


def damped(
    t: FloatArray, period_s: float, decay_1_s: float, size: float, phase_rad: float = 0.0
) -> FloatArray:
    """Damped cosine, counted from the first time."""
    s = t - t[0]
    return np.asarray(
        size * np.exp(-decay_1_s * s) * np.cos(2.0 * np.pi * s / period_s + phase_rad)
    )
