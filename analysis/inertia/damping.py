"""Damping of small swings: how fast an amplitude falls in proportion to itself.

An amplitude that falls as ``dA/dt = -c A - c_p A^(p + 1)`` obeys

    -ln A = a + c t + c_p int_0^t A^p dt'

which is fitted to a record's amplitudes, two swings at a time, for linear damping alone and with
drag (p = 1), with its cube (p = 2) and with friction (p = -1), after Froude. As a record does not
always tell which it is, c is the mean by Akaike's weights, and what the laws differ by is part of
its uncertainty.
"""

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from analysis.inertia.amplitude import amplitude_integral
from analysis.inertia.local_periods import FEWEST_PARTS, local_periods
from analysis.inertia.record import RecordAnalysis
from analysis.inertia.repeats import combine_runs
from analysis.uncertainty.estimate import Estimate
from hardware.description.arrays import FloatArray

_POWERS: Final = (None, 1, 2, -1)
_SWINGS: Final = 2.0  # of a part
_SECOND_ORDER: Final = 0.01  # of what the decay changes with amplitude: averages are of first order
_EXACT: Final = 1e-10  # of an amplitude's logarithm: below are roundings


def small_damping_of(records: Sequence[RecordAnalysis]) -> Estimate:
    """Return the damping ratio of small swings: of several records, with the scatter of those."""
    ratios = [_ratio(record) for record in records]
    if len(ratios) == 1:
        return ratios[0]
    names = [record.part.series.name for record in records]
    return combine_runs(ratios, subject="damping ratio", names=names).estimate


def _ratio(record: RecordAnalysis) -> Estimate:
    """Return ``c / hypot(c, 2 pi/T)`` at the period T of small swings."""
    series = record.part.series
    swings = (series.time_s[-1] - series.time_s[0]) / record.fit.modes[0].period_s
    parts = max(FEWEST_PARTS, int(swings / _SWINGS))
    local = local_periods(series.time_s, series.values, record.fit, parts=parts)
    rate, omega = small_rate(local.time_s, local.amplitude), 2.0 * math.pi / record.period().value
    rate = rate.widened(_SECOND_ORDER * abs(record.fit.modes[0].decay_1_s - rate.value))
    undamped = math.hypot(rate.value, omega)
    ratio = rate.following(rate.value / undamped, omega**2 / undamped**3)
    return Estimate(ratio.uncertain, "1")


def small_rate(time_s: FloatArray, amplitude: FloatArray) -> Estimate:
    """Return c, 1/s, with the uncertainty of the fits and of the choice between the laws.

    Parameters
    ----------
    time_s, amplitude
        Whose errors are independent and alike, shape ``(n,)``; four or more.
    """
    fits = [fit for power in _POWERS if (fit := _fit(time_s, amplitude, power)) is not None]
    rates, variances, scores, freedoms = (np.array(each) for each in zip(*fits, strict=True))
    weights = np.exp(-0.5 * (scores - scores.min()))
    weights /= weights.sum()
    mean = float(weights @ rates)
    variance = float(weights @ (variances + (rates - mean) ** 2))
    return Estimate.of(mean, math.sqrt(variance), "1/s", float(weights @ freedoms))


def _fit(
    time_s: FloatArray, amplitude: FloatArray, power: int | None
) -> tuple[float, float, float, float] | None:
    """Return c, its variance, Akaike's criterion and the degrees of freedom."""
    columns = [np.ones(time_s.size), time_s - time_s[0]]
    if power is not None:
        columns.append(amplitude_integral(time_s, amplitude, power))
    weight = amplitude / amplitude.max()  # a logarithm is as uncertain as its amplitude is small
    matrix = np.column_stack(columns) * weight[:, np.newaxis]
    freedom = time_s.size - matrix.shape[1]
    if freedom < 1:
        return None
    scale = np.abs(matrix).max(axis=0)
    inverse = np.linalg.pinv(matrix / scale)
    log = -np.log(amplitude) * weight
    solved = inverse @ log
    left = max(float(((log - matrix / scale @ solved) ** 2).sum()), _EXACT**2)
    variance = float(inverse[1] @ inverse[1]) / scale[1] ** 2 * left / freedom
    score = log.size * math.log(left / log.size) + 2.0 * matrix.shape[1]
    return float(solved[1] / scale[1]), variance, score, float(freedom)
