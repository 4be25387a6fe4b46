"""Yaw on a bifilar suspension: lines of length l, a distance 2d apart (eqs 5 to 8 and 13).

T_y = 2 pi (k/d) sqrt(l/g)        T_s = 2 pi sqrt(l/g)        k = d T_y/T_s
"""

import math

from analysis.inertia.beats import BeatCount, ratio_from_beats
from analysis.inertia.elementary_functions import Value, sqrt
from analysis.uncertainty.estimate import Estimate, require_positive
from analysis.uncertainty.monte_carlo import Assessment, assess
from hardware.description.flags import Flag, Severity

NEAR_RESONANCE = 0.05


def sway_period(line_m: Value, gravity_m_s2: Value) -> Value:
    """Period of sway (eq 7): the lines' own."""
    return 2.0 * math.pi * sqrt(line_m / gravity_m_s2)


def yaw_period(
    gyradius_m: Value, half_spacing_m: Value, line_m: Value, gravity_m_s2: Value
) -> Value:
    """Period of yaw at small angles, s (eq 5)."""
    return gyradius_m / half_spacing_m * sway_period(line_m, gravity_m_s2)


def yaw_gyradius(
    period_s: Value, half_spacing_m: Value, line_m: Value, gravity_m_s2: Value
) -> Value:
    """Gyradius in yaw, m, from the period at small angles and the lines (eq 6)."""
    return period_s * half_spacing_m / (2.0 * math.pi) * sqrt(gravity_m_s2 / line_m)


def ratio_gyradius(yaw_period_s: Value, sway_period_s: Value, half_spacing_m: Value) -> Value:
    """Gyradius from the ratio of the periods (eq 8): length and gravity drop out."""
    return half_spacing_m * yaw_period_s / sway_period_s


def yaw_from_period(
    period: Estimate,
    half_spacing: Estimate,
    line: Estimate,
    gravity: Estimate,
    *,
    seed: int = 0,
) -> Assessment:
    """Return the yaw gyradius from period and line length.

    Raises
    ------
    ConfigurationError
        For a value that is not above zero.
    """
    inputs = {
        "period_s": period,
        "half_spacing_m": half_spacing,
        "line_m": line,
        "gravity_m_s2": gravity,
    }
    require_positive("bifilar yaw", **inputs)
    return assess("k_yaw", yaw_gyradius, inputs, unit="m", seed=seed)


def yaw_from_ratio(
    yaw: Estimate,
    sway: Estimate,
    half_spacing: Estimate,
    *,
    seed: int = 0,
) -> Assessment:
    """Return the yaw gyradius from the ratio of the periods.

    Raises
    ------
    ConfigurationError
        For a value that is not above zero.
    """
    inputs = {"yaw_period_s": yaw, "sway_period_s": sway, "half_spacing_m": half_spacing}
    require_positive("bifilar yaw", **inputs)
    return assess("k_yaw", ratio_gyradius, inputs, unit="m", seed=seed)


def yaw_from_beats(
    count: BeatCount, half_spacing: Estimate, *, yaw_slower: bool = True
) -> Assessment:
    """Return the yaw gyradius from counted beats (eq 13).

    Raises
    ------
    ConfigurationError
        For a spacing that is not above zero.
    DataError
        If no whole beat was counted.
    """
    require_positive("bifilar yaw", half_spacing_m=half_spacing.value)

    def gyradius(oscillations: Value, half_spacing_m: Value) -> Value:
        return half_spacing_m * ratio_from_beats(oscillations, yaw_slower=yaw_slower)

    inputs = {"oscillations": count.per_beat(), "half_spacing_m": half_spacing}
    return assess("k_yaw", gyradius, inputs, unit="m")


def resonance_flags(yaw_period_s: float, first_pitch_period_s: float) -> tuple[Flag, ...]:
    """Warn where yaw turns into pitch beats: ``T_y`` within 5 % of ``T_1`` (Kane and Tseng)."""
    detuning = yaw_period_s / first_pitch_period_s - 1.0
    if abs(detuning) > NEAR_RESONANCE:
        return ()
    message = (
        f"the yaw period {yaw_period_s:.4g} s is {100 * detuning:+.2g} % from the first pitch "
        f"mode's {first_pitch_period_s:.4g} s (limit {100 * NEAR_RESONANCE:g} %): yaw and sway "
        "together turn into pitch and shift the period; change the lines' length or spacing, or "
        "excite yaw alone"
    )
    return (Flag("yaw_pitch_resonance", Severity.WARNING, message),)
