"""How periods lengthen with the angle by geometry alone, which is known without any record.

    T(A) = T_0 (1 + c_2 A^2 + c_4 A^4)

A plain pendulum has ``c_2 = 1/16`` and ``c_4 = 11/3072``. A body on two vertical lines of length L,
a distance 2b apart, that yaws by the angle phi rises by ``h = L - sqrt(L^2 - 4 b^2 sin^2(phi/2))``.
To the fourth power, with ``r = b^2/L^2`` and the gyradius k, rise and kinetic energy are

    h = r L (phi^2/2 - (1 - 3 r) phi^4/24)        m k^2 (1 + (r b^2/k^2) phi^2) phi'^2/2

whose period has ``c_2 = (1 - 3 r)/16 + r b^2/(4 k^2)``; ``b/k = 2 pi sqrt(L/g)/T_0``.
"""

import math
from collections.abc import Callable
from typing import Final

from hardware.description.arrays import FloatArray

Powers = tuple[tuple[int, float], ...]
"""Powers of the angle in radians, each with its coefficient."""
Lengthening = Callable[[float], Powers]
"""Takes the period, s, and returns by what it lengthens."""

_PENDULUM: Final = ((2, 1.0 / 16.0), (4, 11.0 / 3072.0))


def pendulum_lengthening(period_s: float) -> Powers:  # noqa: ARG001
    """Return those of a plain pendulum, which are the same for all."""
    return _PENDULUM


def bifilar_lengthening(half_spacing_m: float, line_m: float, gravity_m_s2: float) -> Lengthening:
    """Return what makes those of yaw on two vertical lines."""
    r = (half_spacing_m / line_m) ** 2
    lines = 4.0 * math.pi**2 * line_m / gravity_m_s2

    def powers(period_s: float) -> Powers:
        return ((2, (1.0 - 3.0 * r) / 16.0 + 0.25 * r * lines / period_s**2),)

    return powers


def longer(powers: Powers, amplitude: FloatArray) -> FloatArray:
    """Return the period at some amplitudes over that at none."""
    terms = [c * amplitude**power for power, c in powers]
    return 1.0 + sum(terms, 0.0 * amplitude)
