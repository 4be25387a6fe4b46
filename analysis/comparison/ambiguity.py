"""Whether the lag could be another: a motion of one frequency fits as well a period later."""

from dataclasses import replace
from typing import Final

import numpy as np

from analysis.comparison.fit import ComparisonFit, fit
from analysis.comparison.linear import ComparisonProblem, Model, NothingInCommonError

_SURE: Final = 5.0  # standard deviations by which another lag must fit worse to be rejected
_ALIKE: Final = 0.8  # correlation of a motion with itself, below which it does not repeat
_HALF_PERIODS: Final = (-2, 2, -1, 1)  # at which other lags are tried; half a period turns the sign


def least_lag(
    problem: ComparisonProblem, best: ComparisonFit, most_lag_s: float
) -> tuple[Model, float | None]:
    """Return the model that fits best, and the period by which its lag may be off, if any.

    Lags a period earlier and later are tried on the same samples, and from the one that fits best
    again: a fit that is a period off takes the start and the stop of the motion for noise, so that
    by it alone none is better for sure. The best of all is what the others are judged by. Where one
    fits as well, the lag nearest to zero with a positive gain is taken.
    """
    period_s = _period(problem, best, most_lag_s)
    if period_s is None:
        return best.model, None
    place, tried = 0, {0}
    while True:
        best = _fit_inside(problem, best.model, period_s)
        neighbours = [_fit_moved(problem, best, half * period_s / 2.0) for half in _HALF_PERIODS]
        growth = [_growth(best, neighbour) for neighbour in neighbours]
        k = int(np.argmin(growth))
        nearest, place = neighbours[k], place + _HALF_PERIODS[k]
        too_far = abs(place) * period_s / 2.0 > 2.0 * most_lag_s  # from one end to the other
        if nearest is None or growth[k] >= 0.0 or place in tried or too_far:
            return _judged(best, neighbours, growth, period_s)
        best = nearest
        tried.add(place)


def _judged(
    best: ComparisonFit,
    neighbours: list[ComparisonFit | None],
    growth: list[float],
    period_s: float,
) -> tuple[Model, float | None]:
    """Return the model, and the period of the lags that fit no worse than by chance."""
    limit = _limit(best)
    model = best.model
    if min(growth[:2]) > limit:
        return model, None
    if model.gains[0] < 0.0 and min(growth[2:]) <= limit:
        half = neighbours[2 + int(np.argmin(growth[2:]))]
        model = model if half is None else half.model
    lags = [
        neighbour.model.alignment.lag_s for neighbour in neighbours[:2] if neighbour is not None
    ]
    period_s = (max(lags) - min(lags)) / 2.0 if len(lags) == 2 else period_s  # as it fits best
    turns = round(model.alignment.lag_s / period_s)
    where = replace(model.alignment, lag_s=model.alignment.lag_s - turns * period_s)
    return replace(model, alignment=where), period_s


def _limit(best: ComparisonFit) -> float:
    """Return by how much sums of squares of two lags may differ by chance.

    The first channel's noise is another one at another lag, so that the two are as good as
    independent: each has the variance ``4 n`` in ``n`` bins.
    """
    bins = float(best.stands_out.sum())
    chance = _SURE**2 + _SURE * float(np.sqrt(8.0 * bins))
    return chance * max(1.0, best.squares / (2.0 * bins))


def _period(problem: ComparisonProblem, best: ComparisonFit, most_lag_s: float) -> float | None:
    """Return where the motion is most like itself, ``None`` where it never is."""
    from scipy.fft import irfft

    power = np.zeros(best.count // 2 + 1)
    inside = np.abs(best.shape) ** 2 * best.stands_out
    power[best.first_bin : best.first_bin + len(inside)] = inside
    fine = 8
    likeness = irfft(power, best.count * fine)
    likeness = likeness[: int(likeness.size * 0.4)]
    below = np.flatnonzero(likeness < 0.0)
    if not len(below):
        return None
    reach = max(most_lag_s, 1.5 / problem.motion_hz) * problem.second.rate_hz * fine
    tail = likeness[below[0] : int(reach)]
    if len(tail) < 3 or tail.max() < _ALIKE * likeness[0]:
        return None
    top = int(np.flatnonzero(tail >= 0.95 * tail.max())[0])
    while top + 1 < len(tail) and tail[top + 1] > tail[top]:
        top += 1
    return float(below[0] + top) / fine / problem.second.rate_hz


def _fit_inside(problem: ComparisonProblem, model: Model, margin_s: float) -> ComparisonFit:
    """Fit again where the first channel is there a period before and after."""
    where = model.alignment
    covered = np.flatnonzero(problem.first.covers(where.times_s(problem.second.time_s)))
    margin = min(int(margin_s * problem.second.rate_hz) + 2, len(covered) // 4)
    start, stop = (int(covered[0]), int(covered[-1]) + 1) if len(covered) else (0, 0)
    where = replace(where, stretch=slice(start + margin, stop - margin))
    return fit(problem, replace(model, alignment=where))


def _fit_moved(
    problem: ComparisonProblem, best: ComparisonFit, later_s: float
) -> ComparisonFit | None:
    where = best.model.alignment
    model = replace(best.model, alignment=replace(where, lag_s=where.lag_s + later_s))
    try:
        moved_fit = fit(problem, model)
    except NothingInCommonError:
        return None
    return moved_fit if moved_fit.count == best.count else None


def _growth(best: ComparisonFit, rival: ComparisonFit | None) -> float:
    if rival is None:
        return np.inf
    return rival.squares_under(best.noise, best.stands_out) - best.squares
