"""Regular waves: how long they are at a depth, and how often a towed model meets them."""

import math

from hardware.description.units import STANDARD_GRAVITY_M_S2

_TURN = 2.0 * math.pi


def wave_number(frequency_hz: float, depth_m: float | None) -> float:
    """Return k in rad/m of ``omega^2 = g k tanh(k h)``; in deep water, ``None``, ``omega^2 / g``.

    Newton's method from Eckart's first guess, which is within 5 % at any depth.
    """
    deep = (_TURN * frequency_hz) ** 2 / STANDARD_GRAVITY_M_S2
    if depth_m is None or deep == 0.0:
        return deep
    k = deep / math.sqrt(math.tanh(deep * depth_m))
    for _ in range(20):
        steep = math.tanh(k * depth_m)
        off = k * steep - deep
        k -= off / (steep + k * depth_m * (1.0 - steep**2))
        if abs(off) < 1e-14 * deep:
            break
    return k


def encounter_hz(
    frequency_hz: float, speed_m_s: float, heading_rad: float, depth_m: float | None = None
) -> float:
    """Return how often the model meets a crest: ``(omega - k U cos(heading)) / (2 pi)``.

    Parameters
    ----------
    heading_rad
        Of the waves' way against the carriage's: 0 from astern, pi from ahead. Below 0 the model
        overtakes them.
    """
    k = wave_number(frequency_hz, depth_m)
    return frequency_hz - k * speed_m_s * math.cos(heading_rad) / _TURN
