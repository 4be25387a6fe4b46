"""A change of regime in a decay: somebody stops the body, a line touches, something comes loose.

The amplitude of a free oscillation that is left alone goes its own way by itself alone,

    dA/dt = -(c_0 + c_1 A + c_2 A^2)        (Coulomb friction, linear and quadratic damping)

so that ``A(t) - A(0) = -c_0 t - c_1 int A dt - c_2 int A^2 dt``, which is linear in the c. It is
fitted to the amplitudes over successive half periods with and without a step at some moment; where
the step leaves far less over, the record is of two regimes.
"""

from dataclasses import dataclass

import numpy as np

from analysis.inertia.series import Series, UsablePart, cut
from hardware.description.arrays import FloatArray
from hardware.description.flags import Flag, Severity

FEWEST_SWINGS = 3.0  # on either side of a change
SURE = 40.0  # squares that a step takes away, over what is left for each amplitude
LEAST_STEP = 0.1  # of the amplitude before
ENOUGH_SWINGS = 12.0  # for the periods at no amplitude
_STEPS_A_PERIOD = 4
_WHOLE = 0.9  # of the samples around a moment


@dataclass(frozen=True)
class RegimeChange:
    """A step of the amplitude within a period.

    Attributes
    ----------
    time_s
        When.
    before, after
        The amplitude there by what goes before and by what follows, in the record's unit.
    """

    time_s: float
    before: float
    after: float


def amplitudes(series: Series, period: float) -> tuple[FloatArray, FloatArray]:
    """Return the amplitude over one period around successive moments, a quarter period apart.

    By least squares of sine, cosine and mean; moments with over a tenth of the samples missing are
    left out. The results are the times and the amplitudes.
    """
    time, values = series.time_s, series.values
    half = 0.5 * period
    moments = np.arange(time[0] + half, time[-1] - half, period / _STEPS_A_PERIOD)
    sizes = np.full(moments.size, np.nan)
    for k, moment in enumerate(moments):
        low, high = np.searchsorted(time, [moment - half, moment + half])
        window, angle = values[low:high], 2.0 * np.pi * (time[low:high] - moment) / period
        good = np.isfinite(window)
        if good.sum() > max(_WHOLE * window.size, 4):
            matrix = np.column_stack([np.cos(angle), np.sin(angle), np.ones(angle.size)])[good]
            cosine, sine, _ = np.linalg.lstsq(matrix, window[good], rcond=None)[0]
            sizes[k] = np.hypot(cosine, sine)
    finite = np.isfinite(sizes)
    return moments[finite], sizes[finite]


def change_of_regime(series: Series, part: UsablePart) -> RegimeChange | None:
    """Find the moment at which the amplitude steps as no decay of its own does.

    ``None`` where there is none, or the record is too short to tell.

    Parameters
    ----------
    series, part
        The whole record, and what of it is usable: a step may be what ends that.
    """
    time, amplitude = amplitudes(_longer(series, part), part.period_s)
    edge = round(FEWEST_SWINGS * _STEPS_A_PERIOD)
    spare = time.size / _STEPS_A_PERIOD - 8.0
    if spare < 1.0 or time.size < 2 * edge + 4 * _STEPS_A_PERIOD:
        return None
    residuals = {at: _step(time, amplitude, at) for at in range(edge, time.size - edge)
            if at % _STEPS_A_PERIOD == 0 and _is_continuous(time, at)}  # fmt: skip
    if not residuals:
        return None
    rough = min(residuals, key=lambda at: residuals[at][0])
    candidates = range(rough - _STEPS_A_PERIOD, rough + _STEPS_A_PERIOD + 1)
    within = (at for at in candidates if edge <= at < time.size - edge)
    (least, before, after), best = min((_step(time, amplitude, at), at) for at in within)
    smooth_residual = _residual_squares(_own_way(time, amplitude), amplitude)
    step = abs(after - before)
    if smooth_residual - least < SURE * least / spare or step < max(
        LEAST_STEP * before, part.floor
    ):
        return None
    return RegimeChange(float(time[best]), before, after)


def of_one_regime(series: Series, part: UsablePart) -> tuple[UsablePart, tuple[Flag, ...]]:
    """Return what is usable up to a change of regime, and the flag ``regime_change``.

    What follows the change is used where only that has swings enough.
    """
    change = change_of_regime(series, part)
    if change is None:
        return part, ()
    period, (start, stop) = part.period_s, part.series.time_s[[0, -1]].tolist()
    low, high = change.time_s - 0.5 * period, change.time_s + 0.5 * period
    ends = (start, low) if low - start >= min(ENOUGH_SWINGS * period, stop - high) else (high, stop)
    words = ("up to it", "before") if ends[0] == start else ("from there on", "after")
    message = (
        f"{series.where}: at {change.time_s:.4g} s the amplitude steps from {change.before:.3g} to "
        f"{change.after:.3g} {series.unit} as no decay by itself does (stopped by hand, touched, "
        f"pushed?); the record is used {words[0]}"
    )
    because = f"{part.reason}, of which {words[1]} the change of regime at {change.time_s:.4g} s"
    flag = Flag("regime_change", Severity.WARNING, message, series.channel)
    return part.cut(ends[0], ends[1], because), (flag,)


def _longer(series: Series, part: UsablePart) -> Series:
    """Return the usable part with the few swings that follow it."""
    start, stop = part.series.time_s[[0, -1]].tolist()
    return cut(series, start, stop + (FEWEST_SWINGS + 1.0) * part.period_s)


def _is_continuous(time: FloatArray, at: int) -> bool:
    """Return whether there is no gap in the swings around a moment."""
    steps = np.diff(time[at - 2 * _STEPS_A_PERIOD : at + 2 * _STEPS_A_PERIOD])
    return bool(steps.max() < 2.0 * steps.min())


def _own_way(time: FloatArray, amplitude: FloatArray) -> FloatArray:
    """Return the columns that a decay left alone is made of, shape ``(amplitudes, 4 + gaps)``.

    What it lost in a gap is not known: it is one more unknown.
    """
    columns = [np.ones(time.size), time - time[0]]
    for power in (1, 2):
        rate = amplitude**power
        steps = 0.5 * (rate[1:] + rate[:-1]) * np.diff(time)
        columns.append(np.concatenate([[0.0], np.cumsum(steps)]))
    gaps = np.flatnonzero(np.diff(time) > 2.0 * _STEPS_A_PERIOD * np.diff(time).min())
    columns += [np.arange(time.size) > gap for gap in gaps]
    matrix = np.column_stack(columns)
    return np.asarray(matrix / np.abs(matrix).max(axis=0))


def _residual_squares(matrix: FloatArray, amplitude: FloatArray) -> float:
    solved = np.linalg.lstsq(matrix, amplitude, rcond=None)[0]
    return float(((amplitude - matrix @ solved) ** 2).sum())


def _step(time: FloatArray, amplitude: FloatArray, at: int) -> tuple[float, float, float]:
    """Return what two regimes leave over, and the amplitude at the step by either.

    What lies within half a period of the step is of both, and belongs to neither.
    """
    reach = _STEPS_A_PERIOD // 2
    total, ends = 0.0, []
    for chosen, inner in ((slice(0, at - reach + 1), -1), (slice(at + reach, None), 0)):
        t, a = time[chosen], amplitude[chosen]
        line = np.column_stack([np.ones(t.size), t - time[at]])
        matrix = _own_way(t, a)
        solved = np.linalg.lstsq(matrix, a, rcond=None)[0]
        total += float(((a - matrix @ solved) ** 2).sum())
        ending = slice(-_STEPS_A_PERIOD, None) if inner else slice(0, _STEPS_A_PERIOD)
        ends.append(float(np.linalg.lstsq(line[ending], a[ending], rcond=None)[0][0]))
    return total, ends[0], ends[1]
