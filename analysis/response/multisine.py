"""Design of a motion of many lines: which harmonics of one base frequency, with which phases.

A motion that is periodic in the base period and has power at some of its harmonics alone measures
all of them at once, without leakage. What it costs is amplitude: the lines share one stroke, and
how well they do is the crest factor.
"""

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError

_POINTS_PER_LINE = 16  # of a period, per harmonic of the highest line: the peak to 0.5 %


def schroeder_phases(amplitudes: FloatArray) -> FloatArray:
    """Return phases in radians that keep the peak of ``sum a_k sin(n_k theta + phase_k)`` low.

    Each line is given the time in which a sweep would pass it, as long as its share of the power
    (Schroeder, IEEE Transactions on Information Theory 16, 1970, pages 85 to 89):
    ``phase_k = -2 pi sum over j < k of (k - j) p_j``.

    Parameters
    ----------
    amplitudes
        Of the lines, in the order of their harmonics, which should be evenly spaced; shape
        ``(lines,)``.
    """
    power = np.asarray(amplitudes, dtype=np.float64) ** 2
    until = np.concatenate(([0.0], np.cumsum(power / power.sum())[:-1]))
    return np.asarray(-2.0 * np.pi * np.cumsum(until) % (2.0 * np.pi))


def waveform(orders: FloatArray, amplitudes: FloatArray, phases_rad: FloatArray) -> FloatArray:
    """Return one period of ``sum a_k sin(n_k theta + phase_k)``, finely sampled."""
    count = _POINTS_PER_LINE * int(np.max(orders))
    theta = 2.0 * np.pi * np.arange(count) / count
    return np.asarray(
        amplitudes @ np.sin(np.outer(orders, theta) + np.asarray(phases_rad)[:, None])
    )


def crest_factor(orders: FloatArray, amplitudes: FloatArray, phases_rad: FloatArray) -> float:
    """Return peak over root mean square: 1.41 of a single sine, about 1.9 by Schroeder."""
    wave = waveform(orders, amplitudes, phases_rad)
    return float(np.abs(wave).max() / np.sqrt((np.asarray(amplitudes) ** 2).sum() / 2.0))


def odd_lines_with_gaps(lowest: int, highest: int, group: int, seed: int) -> tuple[int, ...]:
    """Return odd harmonics of which one of every group is left out at random.

    Of a motion that has odd harmonics alone the even ones of the response show distortions of even
    degree, the odd ones that are left out those of odd degree, and neither is mixed with what is
    linear (Pintelon, Schoukens, System Identification, 2nd ed., 2012, chapter 4).

    Parameters
    ----------
    group
        Odd harmonics in a row of which one is left out; 3 or 4 is usual.

    Raises
    ------
    ConfigurationError
        If the group is smaller than two, or no whole group lies between the ends.
    """
    odd = [n for n in range(lowest, highest + 1) if n % 2]
    if group < 2 or len(odd) < group:
        raise ConfigurationError(
            f"{len(odd)} odd harmonics from {lowest} to {highest} make no group of {group}; widen "
            "the band, or take groups of 2 or more"
        )
    generator = np.random.default_rng(seed)
    left_out = {
        odd[first + int(generator.integers(group))]
        for first in range(0, len(odd) - group + 1, group)
    }
    return tuple(n for n in odd if n not in left_out)
