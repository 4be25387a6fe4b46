"""Harmonics of a run's channels over the averaged cycle, and back.

Phasors have their orders on the axis before the last, ``(..., orders + 1, k)``, with a real mean:
``y = H[0] + sum of Im(H[n] exp(i n theta))``. As real numbers they are interleaved, ``S0 C0 S1 C1``
of each channel in turn, order by order, as :mod:`analysis.coefficients.phasors` has them.
"""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from analysis.kinematics.geometry import Waves
from analysis.kinematics.motion import DrivenDisplacements
from hardware.description.arrays import FloatArray

INSTANTS = 64  # |v|v folds back 1e-5 of itself, what is smooth nothing at 30 degrees
_PER_ORDER = 2  # resolved to twice the highest line, so that a cube folds back beyond the lines


def instants_of(count: int) -> int:
    """Return at how many instants cycles are reckoned of so many orders, the mean included."""
    return max(INSTANTS, 1 << (_PER_ORDER * count - 1).bit_length())


def waves(parts: Waves, channels: int, times: int = 0) -> Waves:
    """Return the waves of interleaved parts, or their derivative by theta.

    The result has the shape ``(..., channels, instants)``.

    Parameters
    ----------
    parts
        Shape ``(..., 2 * channels * (orders + 1))``.
    times
        How often they are differentiated.
    """
    shaped = parts.reshape(*parts.shape[:-1], -1, channels, 2)
    by_channel = np.moveaxis(shaped, -2, -3).reshape(*parts.shape[:-1], channels, -1)
    return np.asarray(by_channel @ basis(shaped.shape[-3], times))


def driven(parts: Waves, omega: Waves | float) -> DrivenDisplacements:
    """Return what two channels of displacements drive; ``omega`` of shape ``(...)``."""
    speed = np.asarray(omega)[..., None, None]
    value, rate, acceleration = (waves(parts, 2, n) * speed**n for n in range(3))
    return DrivenDisplacements(value, rate, acceleration)


def harmonics(over: Waves, orders: int) -> Waves:
    """Return interleaved parts of waves: the inverse of :func:`waves` at the orders there are.

    Shape ``(..., k, instants)`` to ``(..., 2 * k * (orders + 1))``.
    """
    by_channel = (over @ mean(orders + 1, over.shape[-1])).reshape(*over.shape[:-1], orders + 1, 2)
    return np.asarray(np.moveaxis(by_channel, -2, -3).reshape(*over.shape[:-2], -1))


def per_part(
    count: int, channels: int, wanted: Sequence[tuple[int, int]], omega: float
) -> FloatArray:
    """Return the waves of some channels, differentiated in time, per interleaved part.

    The result has the shape ``(len(wanted), 2 * channels * count, instants)``.

    Parameters
    ----------
    count
        Number of orders, the mean included.
    wanted
        Channel, and how often it is differentiated.
    """
    points = instants_of(count)
    parts = np.zeros((len(wanted), count, channels, 2, points))
    for k, (channel, times) in enumerate(wanted):
        parts[k, :, channel] = omega**times * basis(count, times).reshape(count, 2, -1)
    return parts.reshape(len(wanted), -1, points)


@lru_cache(maxsize=32)
def basis(count: int, times: int, points: int | None = None) -> FloatArray:
    """Return sine and cosine of each order, differentiated; shape ``(2 * count, instants)``."""
    points = points or instants_of(count)
    order = np.arange(count)[:, None]
    angle = order * 2.0 * np.pi * np.arange(points) / points + times * np.pi / 2.0
    basis = (order**times)[:, None] * np.stack((np.sin(angle), np.cos(angle)), axis=1)
    basis[0] = [[float(times == 0)], [0.0]]  # the mean is real
    return np.asarray(basis, dtype=np.float64).reshape(2 * count, points)


@lru_cache(maxsize=32)
def mean(count: int, points: int) -> FloatArray:
    """Return what gives the parts back of waves, shape ``(instants, 2 * count)``."""
    scale = np.where(np.arange(2 * count) < 2, 1.0, 2.0) / points
    return np.asarray(basis(count, 0, points).T * scale, dtype=np.float64)
