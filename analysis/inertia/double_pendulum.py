"""Pitch (or roll) and surge on lines: gyradius and depth from three periods (eqs 16 to 19).

    l_1 k^2 w^4 - g (l_2^2 + k^2 + l_1 l_2) w^2 + g^2 l_2 = 0
    l_2 = l_1 (R_1^2 - 1)(1 - R_2^2)      k = l_1 R_1 R_2 sqrt((R_1^2 - 1)(1 - R_2^2))

with R_i = T_i/T_s. With the suspension fore and aft the same gives roll.
"""

import math
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from analysis.inertia.elementary_functions import Value, sqrt
from analysis.uncertainty.estimate import Estimate, require_positive
from analysis.uncertainty.monte_carlo import Assessment, assess
from hardware.description.errors import DataError


def mode_periods(
    gyradius_m: Value, depth_m: Value, line_m: Value, gravity_m_s2: Value
) -> tuple[Value, Value]:
    """Periods ``(T_1, T_2)`` of the slow and the fast mode (eq 16).

    Parameters
    ----------
    depth_m
        ``l_2``, of the centre of gravity below the body's suspension points.
    """
    k2 = gyradius_m * gyradius_m
    half = 0.5 * gravity_m_s2 * (depth_m * depth_m + k2 + line_m * depth_m)
    root = sqrt(half * half - line_m * k2 * gravity_m_s2 * gravity_m_s2 * depth_m)
    lead = line_m * k2
    # the slow mode's square by Vieta: no difference of near numbers
    fast = (half + root) / lead
    slow = gravity_m_s2 * gravity_m_s2 * depth_m / lead / fast
    return 2.0 * math.pi / sqrt(slow), 2.0 * math.pi / sqrt(fast)


def depth_from_periods(
    slow_period_s: Value, fast_period_s: Value, sway_period_s: Value, gravity_m_s2: Value
) -> Value:
    """Depth ``l_2`` of the CG below the suspension points, m, from three periods (eq 18)."""
    line = gravity_m_s2 * sway_period_s * sway_period_s / (4.0 * math.pi**2)
    slow, fast = slow_period_s / sway_period_s, fast_period_s / sway_period_s
    return line * (slow * slow - 1.0) * (1.0 - fast * fast)


def gyradius_from_periods(
    slow_period_s: Value, fast_period_s: Value, sway_period_s: Value, gravity_m_s2: Value
) -> Value:
    """Gyradius in pitch, m, from three periods (eq 18)."""
    line = gravity_m_s2 * sway_period_s * sway_period_s / (4.0 * math.pi**2)
    slow, fast = slow_period_s / sway_period_s, fast_period_s / sway_period_s
    return line * slow * fast * sqrt((slow * slow - 1.0) * (1.0 - fast * fast))


@dataclass(frozen=True)
class PendulumResult:
    """Gyradius about the transverse (or longitudinal) axis, and depth of the CG, both in m."""

    gyradius: Assessment
    depth: Assessment


def pitch_from_periods(
    slow: Estimate,
    fast: Estimate,
    sway: Estimate,
    gravity: Estimate,
    *,
    seed: int = 0,
) -> PendulumResult:
    """Return gyradius and depth with budgets; roll where the suspension is fore and aft.

    Raises
    ------
    ConfigurationError
        For a period that is not above zero.
    DataError
        If the periods are not in the order slow, sway, fast: one of them is of another motion.
    """
    inputs = {
        "slow_period_s": slow,
        "fast_period_s": fast,
        "sway_period_s": sway,
        "gravity_m_s2": gravity,
    }
    require_positive("double pendulum", **inputs)
    if not slow.value > sway.value > fast.value:
        raise DataError(
            f"double pendulum: T_1 = {slow.value:.4g} s, T_s = {sway.value:.4g} s, T_2 = "
            f"{fast.value:.4g} s; T_1 > T_s > T_2 it must be: one of them is of the wrong axis "
            "(yaw for sway?)"
        )
    return PendulumResult(
        assess("k", gyradius_from_periods, inputs, unit="m", seed=seed),
        assess("l_2", depth_from_periods, inputs, unit="m", seed=seed + 1),
    )


class LineLengthReading(StrEnum):
    """How "best line length" is read: for a known depth ``l_2``, or one that is fitted too."""

    FIXED = "fixed"  # l_1 and l_2 known: the paper's figures 16 and 17
    JOINT = "joint"  # k and l_2 both from the two periods


def gyradius_error_per_period(
    gyradius_m: float,
    depth_m: float,
    line_m: float,
    gravity_m_s2: float,
    reading: LineLengthReading = LineLengthReading.FIXED,
) -> float:
    """Error of the gyradius per error of both periods, m/s (eq 19, figure 16)."""

    def periods(k: float, depth: float) -> np.ndarray:
        return np.array(mode_periods(k, depth, line_m, gravity_m_s2))

    step = 1e-5
    by_k = (
        periods(gyradius_m * (1 + step), depth_m) - periods(gyradius_m * (1 - step), depth_m)
    ) / (2.0 * step * gyradius_m)
    if reading is LineLengthReading.FIXED:
        return float(np.hypot(*(1.0 / by_k)))
    by_depth = (
        periods(gyradius_m, depth_m * (1 + step)) - periods(gyradius_m, depth_m * (1 - step))
    ) / (2.0 * step * depth_m)
    inverse = np.linalg.inv(np.column_stack([by_k, by_depth]))
    return float(np.hypot(*inverse[0]))


def best_line_length(
    gyradius_m: float,
    depth_m: float,
    gravity_m_s2: float,
    reading: LineLengthReading = LineLengthReading.FIXED,
) -> float:
    """Return the line length that makes that error least (figure 17), in metres.

    Raises
    ------
    ConfigurationError
        For a value that is not above zero.
    """
    from scipy.optimize import minimize_scalar

    require_positive("best line length", gyradius_m=gyradius_m, depth_m=depth_m)

    def error(log_ratio: float) -> float:
        line = depth_m * math.exp(log_ratio)
        return math.log(gyradius_error_per_period(gyradius_m, depth_m, line, gravity_m_s2, reading))

    trial = np.linspace(-4.0, 4.0, 81)
    coarse = trial[int(np.argmin([error(float(x)) for x in trial]))]
    minimum = minimize_scalar(error, bounds=(coarse - 0.2, coarse + 0.2), method="bounded")
    return float(depth_m * math.exp(float(minimum.x)))
