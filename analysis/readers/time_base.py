"""From time stamps to an even grid, or to the word that there is none and the stamps count."""

from dataclasses import dataclass

import numpy as np

from hardware.description.arrays import FloatArray, IntArray
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

# Deviations from the even grid, in sample intervals.
SILENT_DEVIATION = 1e-6  # the last printed digit
NOTED_DEVIATION = 1e-2  # rounding; more is called jitter
LARGEST_DEVIATION = 0.2  # more is no even sampling
# Of a record of uneven stamps; a longer step is no drop-out but parts two runs.
LONGEST_STEP = 0.25
# A gap must be a whole number of intervals to this, or to the jitter's own size.
GAP_TOLERANCE = 0.05


@dataclass(frozen=True)
class TimeBase:
    """An even grid and where each row of the file lies on it.

    Attributes
    ----------
    places
        Sample number of each row, shape ``(rows,)``; ``None`` where row and sample are the same.
    sample_count
        Number of samples of the grid, the missing ones included.
    stamps_s
        The rows' own times, shape ``(rows,)``, where they lie on no even grid; the rate is then
        their mean one.
    """

    start_s: float
    sample_rate_hz: float
    sample_count: int
    places: IntArray | None = None
    flags: tuple[Flag, ...] = ()
    stamps_s: FloatArray | None = None


def fit_time_base(time_s: FloatArray, where: str) -> TimeBase:
    """Fit an even grid to time stamps by least squares; stamps off any such grid count themselves.

    They are off where gaps are not a whole number of intervals, or a stamp lies further than 0.2
    intervals from the grid.

    Parameters
    ----------
    time_s
        Time stamps in seconds, one per row.
    where
        The file's name, for messages.

    Raises
    ------
    DataError
        For fewer than two rows, missing stamps, time that repeats or runs backwards, more missing
        than present rows of an even grid, and a step of a quarter of an uneven record.
    """
    _check_increasing(time_s, where)
    steps = np.diff(time_s)
    places, interval = _places(steps)
    centre = places.mean()
    slope, middle = _line(places - centre, time_s)
    start = middle - slope * centre
    deviation = np.abs(time_s - (start + slope * places)) / slope
    if deviation[0] <= SILENT_DEVIATION:
        start = float(time_s[0])
    worst = _off_grid(steps / interval, deviation)
    if worst is not None:
        return _uneven(time_s, worst, float(steps[worst]) / interval, where)
    rate = _without_rounding_noise(1.0 / slope)
    flags = _deviation_flags(deviation, rate)
    count = int(places[-1]) + 1
    if count == time_s.size:
        return TimeBase(start, rate, count, None, flags)
    return TimeBase(start, rate, count, places, (*flags, _gap_flag(time_s, places, rate, where)))


def _check_increasing(time_s: FloatArray, where: str) -> None:
    if time_s.size < 2:
        raise DataError(
            f"{where}: {time_s.size} row(s) of data; a time base needs at least 2 "
            "(or give the sample rate)"
        )
    bad = np.flatnonzero(~np.isfinite(time_s))
    if bad.size:
        raise DataError(
            f"{where}: {bad.size} time stamp(s) are missing, the first in data row {bad[0] + 1}; "
            "remove these rows, or give the sample rate in place of the time column"
        )
    bad = np.flatnonzero(np.diff(time_s) <= 0.0)
    if bad.size:
        row = int(bad[0])
        before, after = time_s[row], time_s[row + 1]
        fault = "repeats" if after == before else "runs backwards"
        raise DataError(
            f"{where}: time {fault} at data row {row + 2}: {after:.9g} s after {before:.9g} s "
            f"({bad.size} such row(s)); remove or sort these rows, or, if only the stamps are "
            "wrong, give the sample rate in place of the time column"
        )


def _places(steps: FloatArray) -> tuple[IntArray, float]:
    """Return each row's sample number and the interval between samples.

    The median step may be rounded (1 ms stamps of 300 Hz); the mean of the single steps is not.
    """
    usual = np.quantile(steps, 0.5, method="lower")
    single = steps[steps < 1.5 * usual]
    interval = float(single.mean())
    # Steps up to 1.5 intervals count as one, so that jitter does not open gaps.
    intervals = np.maximum(np.rint(steps / interval), 1.0)
    return np.concatenate(([0], np.cumsum(intervals))).astype(np.int64), interval


def _line(x: FloatArray, y: FloatArray) -> tuple[float, float]:
    middle = float(y.mean())
    return float(x @ (y - middle) / (x @ x)), middle


def _without_rounding_noise(rate_hz: float) -> float:
    """Return 200.0 for 199.99999999999997: the fit's own rounding, not the clock's."""
    short = float(f"{rate_hz:.10g}")
    return short if abs(short - rate_hz) <= 1e-12 * rate_hz else rate_hz


def _off_grid(steps: FloatArray, deviation: FloatArray) -> int | None:
    """Return the worst step of stamps on no even grid; ``steps``, ``deviation`` in intervals."""
    odd = np.abs(steps - np.maximum(np.rint(steps), 1.0))
    gaps = steps >= 1.5
    jitter = float(odd[~gaps].max(initial=0.0))
    bad_gap = gaps & (odd > max(GAP_TOLERANCE, jitter))
    if deviation.max() <= LARGEST_DEVIATION and not bad_gap.any():
        return None
    return int(np.argmax(np.where(bad_gap, 1.0 + odd, odd)))


def _uneven(time_s: FloatArray, worst: int, intervals: float, where: str) -> TimeBase:
    """Return the stamps as they are; the worst step is ``intervals`` long."""
    steps, span_s = np.diff(time_s), float(time_s[-1] - time_s[0])
    longest = int(np.argmax(steps))
    if steps[longest] > LONGEST_STEP * span_s:
        raise DataError(
            f"{where}: {steps[longest]:.4g} s without a sample after t = {time_s[longest]:.6g} s, "
            f"of {span_s:.4g} s in all (limit {100.0 * LONGEST_STEP:g} %), and time is not evenly "
            "sampled; split the record into runs"
        )
    rate_hz = (time_s.size - 1) / span_s
    message = (
        f"time is not evenly sampled: {intervals:.3g} sample intervals between data rows "
        f"{worst + 1} and {worst + 2} (t = {time_s[worst]:.6g} s), at most {steps[longest]:.3g} s "
        f"after t = {time_s[longest]:.6g} s. Each stamp counts as it is, {rate_hz:.4g} Hz on "
        "average; nothing is interpolated, and spikes are not looked for. If the sampling was even "
        "and only the stamps are wrong, give the sample rate in place of the time column"
    )
    flag = Flag("time_uneven", Severity.WARNING, message)
    return TimeBase(float(time_s[0]), rate_hz, time_s.size, None, (flag,), time_s)


def _deviation_flags(deviation: FloatArray, rate_hz: float) -> tuple[Flag, ...]:
    worst = float(deviation.max())
    if worst <= SILENT_DEVIATION:
        return _single_precision_flag(rate_hz)
    rounded = worst <= NOTED_DEVIATION
    return (
        Flag(
            "time_rounded" if rounded else "time_jitter",
            Severity.NOTE if rounded else Severity.WARNING,
            f"time stamps lie up to {worst / rate_hz:.2g} s ({worst:.2g} sample intervals, "
            f"limit {LARGEST_DEVIATION:g}) from the even grid of {rate_hz:.9g} Hz fitted "
            "to them, which is used instead",
        ),
    )


def _single_precision_flag(rate_hz: float) -> tuple[Flag, ...]:
    """Say where an even rate is a round one but for single precision (0.0050000002 s stamps)."""
    round_hz = float(f"{rate_hz:.6g}")
    rounding = abs(rate_hz / round_hz - 1.0)
    if not 1e-11 < rounding <= np.finfo(np.float32).eps:
        return ()
    message = (
        f"time stamps are even at {rate_hz:.10g} Hz, which is {round_hz:g} Hz but for "
        f"{rounding:.1g} of it: rounding to single precision, it seems; they are used as they are"
    )
    return (Flag("time_single_precision", Severity.NOTE, message),)


def _gap_flag(time_s: FloatArray, places: IntArray, rate_hz: float, where: str) -> Flag:
    lost = np.diff(places) - 1
    missing, worst = int(lost.sum()), int(np.argmax(lost))
    longest = f"{lost[worst]} after t = {time_s[worst]:.6g} s"
    if missing > time_s.size:
        raise DataError(
            f"{where}: {missing} samples are missing and only {time_s.size} present (the most: "
            f"{longest}); split the record into runs"
        )
    return Flag(
        "gap",
        Severity.WARNING,
        f"{missing} sample(s) are missing in {np.count_nonzero(lost)} gap(s), the most {longest} "
        f"({lost[worst] / rate_hz:.3g} s); they count as missing values",
    )
