"""Damping of small swings: how fast an amplitude falls in proportion to itself.

An amplitude that falls as ``dA/dt = -c A - sum_p c_p A^(p + 1)`` obeys

    -ln A = a + c t + sum_p c_p int_0^t A^p dt'

which is fitted to a record's amplitudes, two swings at a time, for linear damping alone and with
drag (p = 1) or its cube (p = 2), with friction (p = -1), and with friction and one of these, after
Froude. As a record does not always tell which it is, c is the mean by Akaike's weights, and what
the laws differ by is part of its uncertainty. Releases have the law in common, and an a of each.
"""

import math
from collections.abc import Sequence
from typing import Final, TypeAlias

import numpy as np

from analysis.inertia.amplitude import amplitude_integral
from analysis.inertia.local_periods import FEWEST_PARTS, local_periods
from analysis.inertia.record import RecordAnalysis
from analysis.uncertainty.averaging import averaged
from analysis.uncertainty.estimate import Estimate
from hardware.description.arrays import FloatArray

Amplitudes: TypeAlias = tuple[FloatArray, FloatArray]

_LAWS: Final = ((), (1,), (2,), (-1,), (-1, 1), (-1, 2))
_SWINGS: Final = 2.0  # of a part
_SECOND_ORDER: Final = 0.02  # of what the decay changes with amplitude: averages are of first order
_EXACT: Final = 1e-10  # of an amplitude's logarithm: below are roundings


def small_damping_of(records: Sequence[RecordAnalysis]) -> Estimate:
    """Return the damping ratio of small swings, ``c / hypot(c, 2 pi/T)`` at their period T."""
    rate = small_rate([_parts(record) for record in records])
    whole = float(np.mean([record.fit.modes[0].decay_1_s for record in records]))
    rate = rate.widened(_SECOND_ORDER * abs(whole - rate.value))
    omega = 2.0 * math.pi / float(np.mean([record.period().value for record in records]))
    undamped = math.hypot(rate.value, omega)
    ratio = rate.following(rate.value / undamped, omega**2 / undamped**3)
    return Estimate(ratio.uncertain, "1")


def _parts(record: RecordAnalysis) -> Amplitudes:
    """Return the times and amplitudes of a record's parts, as short as can be told apart."""
    series = record.part.series
    swings = (series.time_s[-1] - series.time_s[0]) / record.fit.modes[0].period_s
    parts = max(FEWEST_PARTS, int(swings / _SWINGS))
    local = local_periods(series.time_s, series.values, record.fit, parts=parts)
    return local.time_s, local.amplitude


def small_rate(releases: Sequence[Amplitudes]) -> Estimate:
    """Return c, 1/s, with the uncertainty of the fits and of the choice between the laws.

    Parameters
    ----------
    releases
        Times and amplitudes of each, whose errors are independent and alike.
    """
    fits = [fit for powers in _LAWS if (fit := _fit(releases, powers)) is not None]
    rates, variances, scores, freedoms = (np.array(each) for each in zip(*fits, strict=True))
    mean, variance, weights = averaged(rates, variances, scores)
    return Estimate.of(mean, math.sqrt(variance), "1/s", float(weights @ freedoms))


def _fit(
    releases: Sequence[Amplitudes], powers: Sequence[int]
) -> tuple[float, float, float, float] | None:
    """Return c, its variance, Akaike's criterion and the degrees of freedom."""
    falls = [
        np.column_stack(
            [times_s - times_s[0], *(amplitude_integral(times_s, sizes, p) for p in powers)]
        )
        for times_s, sizes in releases
    ]
    amplitude = np.concatenate([sizes for _, sizes in releases])
    of_release = np.repeat(np.eye(len(releases)), [len(fall) for fall in falls], axis=0)
    weight = amplitude / amplitude.max()  # a logarithm is as uncertain as its amplitude is small
    matrix = np.hstack((np.vstack(falls), of_release)) * weight[:, np.newaxis]
    freedom = matrix.shape[0] - matrix.shape[1]
    if freedom < 1:
        return None
    scale = np.abs(matrix).max(axis=0)
    inverse = np.linalg.pinv(matrix / scale)
    log = -np.log(amplitude) * weight
    solved = inverse @ log
    left = max(float(((log - matrix / scale @ solved) ** 2).sum()), _EXACT**2)
    variance = float(inverse[0] @ inverse[0]) / scale[0] ** 2 * left / freedom
    score = log.size * math.log(left / log.size) + 2.0 * matrix.shape[1]
    return float(solved[0] / scale[0]), variance, score, float(freedom)
