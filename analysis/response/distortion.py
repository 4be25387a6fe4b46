"""Non-linear distortions of a response, told from noise at harmonics that were not excited.

What a linear system does stands at the lines alone. At the other harmonics there are noise, what
the motion itself is not pure in (taken off with the response between the lines), and distortions:
of even degree at even harmonics, of odd degree at odd ones, where the motion has odd lines alone.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from analysis.resolver.harmonics import Harmonics
from analysis.response.frequency_response import FrequencyResponse, deviates_of, phasors_of
from hardware.description.arrays import FloatArray

SURE = 0.05
"""Chance at which noise alone is taken for a distortion. Halved, small ones are missed more often;
doubled, every tenth run without any shows one."""


class Degree(StrEnum):
    """Of a distortion: which powers of the motion make it."""

    ODD = "odd"
    EVEN = "even"


@dataclass(frozen=True, eq=False)
class Distortion:
    """What stands at the harmonics of one parity that were not excited.

    Attributes
    ----------
    orders
        The detection lines, shape ``(lines,)``.
    amplitudes
        Found at each, noise included, in the output's unit.
    noise
        Amplitude that noise alone has there, root mean square.
    level
        Root mean square amplitude of a line without what the noise adds; 0 where noise explains it.
    uncertainty
        One standard deviation of the level, where it is well above the noise.
    relative
        The level over the root mean square amplitude of the response at the excited lines.
    chance
        With which noise alone would be as large.
    """

    degree: Degree
    orders: tuple[int, ...]
    amplitudes: FloatArray
    noise: FloatArray
    level: float
    uncertainty: float
    relative: float
    chance: float

    @property
    def is_significant(self) -> bool:
        """Whether it is more than noise."""
        return self.chance < SURE


def distortions(reading: Harmonics, response: FrequencyResponse) -> Iterator[Distortion]:
    """Yield the distortions of a response's output, odd ones first.

    Even and odd ones are apart only where all lines are odd.
    """
    all_orders = np.arange(1, reading.order + 1)
    free = np.setdiff1d(all_orders, response.orders)
    at = free - 1
    interpolated = response.at(free.astype(np.float64))
    u, y = phasors_of(reading, response.input)[at], phasors_of(reading, response.output)[at]
    deviates = deviates_of(reading, response.output)[at]
    deviates = deviates - interpolated[:, None] * deviates_of(reading, response.input)[at]
    excess, noise = y - interpolated * u, (np.abs(deviates) ** 2).sum(axis=1)
    lines = phasors_of(reading, response.output)[np.array(response.orders) - 1]
    linear = float(np.sqrt((np.abs(lines) ** 2).mean()))
    freedom = reading.degrees_of_freedom[1 + 2 * at]
    for degree, parity in ((Degree.ODD, 1), (Degree.EVEN, 0)):
        of_parity = free % 2 == parity
        if of_parity.any():
            power = np.abs(excess[of_parity]) ** 2
            level = float(np.sqrt(max(power.mean() - noise[of_parity].mean(), 0.0)))
            yield Distortion(
                degree,
                tuple(free[of_parity].tolist()),
                np.sqrt(power),
                np.sqrt(noise[of_parity]),
                level,
                float(np.sqrt(noise[of_parity].mean() / (2.0 * of_parity.sum()))),
                level / linear,
                _chance(power, noise[of_parity], float(freedom[of_parity].sum())),
            )


def _chance(power: FloatArray, noise: FloatArray, freedom: float) -> float:
    """Return with which chance noise is so large: a ratio of mean squares, Fisher's F."""
    from scipy.special import fdtrc

    if not noise.mean() > 0.0:
        return float(not power.mean() > 0.0)
    return float(fdtrc(2.0 * len(power), freedom, power.mean() / noise.mean()))
