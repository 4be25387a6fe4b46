"""A model drawn between its struts: points and distances, differentiated over a turn.

Nothing of the product's kinematics is in it.
"""

import math

import numpy as np

from hardware.description.arrangement import Joint, Pivot
from hardware.description.oscillator import Oscillator


def drawn(
    oscillator: Oscillator, speed: float, struts: np.ndarray, frequency_hz: float
) -> tuple[np.ndarray, ...]:
    """Return heading, its rate, and the velocity of the reference point across the model.

    ``struts`` is one turn of both, shape ``(2, points)``.
    """
    length = 2.0 * oscillator.half_spacing_m
    aft = np.array([np.zeros(struts.shape[1]), struts[0]])
    fore = np.array([np.full(struts.shape[1], length), struts[1]])
    if oscillator.joint is Joint.SLIDES_ON_RIG:  # one strut is drawn in: the model's own length
        gap = np.sqrt(length**2 - (struts[1] - struts[0]) ** 2)
        if oscillator.pivot is Pivot.AFT:
            fore[0] = gap
        else:
            aft[0] = length - gap
    ahead = (fore - aft) / np.hypot(*(fore - aft))
    reach = oscillator.half_spacing_m
    point = aft + reach * ahead if oscillator.pivot is Pivot.AFT else fore - reach * ahead
    velocity = np.array([speed + rate(point[0], frequency_hz), rate(point[1], frequency_hz)])
    heading = np.arctan2(ahead[1], ahead[0])
    return heading, rate(heading, frequency_hz), ahead[0] * velocity[1] - ahead[1] * velocity[0]


def rate(values: np.ndarray, frequency_hz: float) -> np.ndarray:
    """Return the derivative by time of a turn."""
    order = np.arange(len(values) // 2 + 1) * 2j * math.pi * frequency_hz
    return np.fft.irfft(order * np.fft.rfft(values), len(values))
