"""Forces of the water that are not linear in the velocity: cubic and quadratic.

Both laws are plain functions of the velocity through the water, (translation, rotation) in the
first axis, and return (force, moment) that the struts exert: positive coefficients dissipate. From
derivatives of the load on the hull (Y_vvv, N_v|v| ...) the sign changes. The describing functions
are closed forms, for v = V cos(phi), and serve as oracles.
"""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from hardware.description.motor import UNKNOWN_KEYS_REFUSED
from sim.solve.linear_system import Rows, as_rows

# Columns of the coefficients, v the translation's velocity and r the rotation's.
CUBIC_TERMS: Final = ("v^3", "v^2 r", "v r^2", "r^3")
QUADRATIC_TERMS: Final = ("v|v|", "v|r|", "r|v|", "r|r|")


@dataclass(frozen=True)
class CrossFlow:
    """Cubic and quadratic loads of both velocities through the water, coupled.

    Attributes
    ----------
    cubic, quadratic
        Rows force and moment; columns :data:`CUBIC_TERMS` and :data:`QUADRATIC_TERMS`. ``None`` for
        none.
    """

    cubic: Rows | None = None
    quadratic: Rows | None = None

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def scaled(self, factor: float) -> "CrossFlow":
        """Return loads that are larger by a factor."""
        return CrossFlow(_scaled_rows(self.cubic, factor), _scaled_rows(self.quadratic, factor))


def _scaled_rows(rows: Rows | None, factor: float) -> Rows | None:
    return None if rows is None else as_rows(np.array(rows) * factor)


def quadratic_describing_function(harmonic: int, drift_ratio: float = 0.0) -> float:
    """Return the amplitude of cos(n phi) in u|u|, u = e + cos(phi).

    Without drift 8/(3 pi), 8/(15 pi), -8/(105 pi) for n = 1, 3, 5; a small drift e gives the mean
    4 e/pi and the second harmonic 8 e/(3 pi).

    Parameters
    ----------
    harmonic
        n, from 0 (the mean).
    drift_ratio
        e, steady velocity over the amplitude of the oscillating one; beyond 1 the sign of u never
        changes.
    """
    e, n = drift_ratio, harmonic
    turn = math.acos(max(-1.0, min(1.0, -e)))
    # u is positive up to the turn and negative from there to pi.
    integral = 2.0 * _integral(e, n, turn) - _integral(e, n, math.pi)
    return integral * (1.0 if n == 0 else 2.0) / math.pi


def _integral(e: float, n: int, end: float) -> float:
    """Return the integral of (e + cos)^2 cos(n phi) from 0 to ``end``."""

    def of_cosine(k: int) -> float:
        return end if k == 0 else math.sin(k * end) / k

    return (
        (e * e + 0.5) * of_cosine(n)
        + e * (of_cosine(n - 1) + of_cosine(n + 1))
        + 0.25 * (of_cosine(n - 2) + of_cosine(n + 2))
    )


@dataclass(frozen=True)
class SurgeForces:
    """Force of the water along the model, ahead positive, by the motion through the water.

    With the velocities u along the model and v across it and the rate of turn r (w and q in the
    vertical plane):

        X = x_u u + x_uu u abs(u) + x_vv v^2 + x_vr v r + x_rr r^2

    Attributes
    ----------
    x_u, x_uu
        Resistance, negative: N s/m and N s2/m2.
    x_vv, x_vr, x_rr
        N s2/m2, N s2/m and N s2.
    """

    x_u: float = 0.0
    x_uu: float = 0.0
    x_vv: float = 0.0
    x_vr: float = 0.0
    x_rr: float = 0.0

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED
