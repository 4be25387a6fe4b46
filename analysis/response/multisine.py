"""Design of a motion of many lines: which harmonics of one base frequency, with which phases.

A motion that is periodic in the base period and has power at some of its harmonics alone measures
all of them at once, without leakage. What it costs is amplitude: the lines share one stroke, and
how well they do is the crest factor.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from hardware.description.lines import Line, peak_of

_POINTS_PER_LINE = 16  # of a period, per harmonic of the highest line
_LEAST_SHARE = 1e-3  # of the largest line: what is smaller is none


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


def multisine(
    orders: Sequence[int], weights: FloatArray, strut_phases_rad: Sequence[float] = (0.0,)
) -> tuple[Line, ...]:
    """Return lines with Schroeder's phases whose peak is the eccentricity.

    Parameters
    ----------
    weights
        Amplitude of each line over the others'.
    strut_phases_rad
        As in :func:`with_strut_phases`.
    """
    phases = schroeder_phases(np.asarray(weights, dtype=np.float64))
    lines = [
        Line(order, float(weight), float(phase))
        for order, weight, phase in zip(orders, weights, phases, strict=True)
    ]
    return with_strut_phases(lines, strut_phases_rad)


def with_strut_phases(lines: Sequence[Line], strut_phases_rad: Sequence[float]) -> tuple[Line, ...]:
    """Return lines whose peak, of either strut, is the eccentricity.

    Parameters
    ----------
    strut_phases_rad
        Of the lines in turn, from the first again after the last: 0 and pi make one run sway and
        yaw.
    """
    count = max(1, len(strut_phases_rad))
    turned = [
        replace(line, strut_phase_rad=strut_phases_rad[k % count]) for k, line in enumerate(lines)
    ]
    peak = peak_of(turned) if turned else 1.0
    return tuple(replace(line, share=line.share / peak) for line in turned)


def lines_of(samples: FloatArray, highest: int) -> tuple[Line, ...]:
    """Return the lines of one period of any motion: a chirp, or one that was recorded.

    The mean is left out, and what is smaller than a thousandth of the largest line.

    Parameters
    ----------
    samples
        Of the aft strut over the period, evenly spaced, in any unit; shape ``(samples,)``. The fore
        strut moves with it.
    highest
        Highest harmonic that is kept.

    Raises
    ------
    ConfigurationError
        If nothing moves, or the samples do not carry that harmonic.
    """
    if len(samples) <= 2 * highest:
        raise ConfigurationError(
            f"{len(samples)} samples of the period cannot carry harmonic {highest}; give more than "
            f"{2 * highest}"
        )
    spectrum = 2j * np.fft.rfft(samples)[: highest + 1] / len(samples)
    size = np.abs(spectrum)
    size[0] = 0.0
    places = np.flatnonzero((size > _LEAST_SHARE * size.max()) & (size > 0.0))
    if not places.size:
        raise ConfigurationError("the motion given does not move; give one period that does")
    lines = [Line(int(n), float(size[n]), float(np.angle(spectrum[n]))) for n in places]
    return with_strut_phases(lines, (0.0,))


def chirp(lowest: int, highest: int) -> tuple[Line, ...]:
    """Return the lines of a sweep from one harmonic to another that repeats with the base period.

    Its angle is ``2 pi (lowest t + turns t^2)`` for t from 0 to 1, with so many turns more that it
    ends on a whole one; harmonics a tenth beyond the highest are kept.
    """
    count = _POINTS_PER_LINE * highest
    t = np.arange(count) / count
    turns = round((highest - lowest) / 2.0)
    sweep = np.sin(2.0 * np.pi * (lowest * t + turns * t**2))
    return lines_of(sweep, highest + math.ceil(highest / 10.0))
