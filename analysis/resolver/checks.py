"""What is worth knowing about a gate before its numbers are believed."""

import numpy as np

from analysis.resolver.estimate import PeriodValues, solve_periods, usable
from analysis.resolver.harmonics import DriftSource, Harmonics, IntervalSource
from analysis.resolver.sums import PeriodSums
from hardware.description.flags import Flag, Severity

_SPEED_CHANGE = 0.005  # from the shortest to the longest period, relative
_FEW_PERIODS = 3  # below it an interval is a formality
_SURE = 4.0  # standard errors that make a trend sure
_ROUNDING = 1e-9  # of the mean: what a constant channel may seem to drift
_NOTABLE = 0.01  # of the first harmonic: a change that matters


def gate_flags(gate: PeriodSums, result: Harmonics) -> tuple[Flag, ...]:
    """Return the flags of one gate: gaps, few periods, speed, drift, transient."""
    sound = usable(gate)
    flags = [*_gap(gate, sound), *_few(result), *_speed(gate), *_drift(result)]
    if sound.period_count >= 2 * _FEW_PERIODS:
        flags += _transient(solve_periods(sound), result)
    return tuple(flags)


def _gap(gate: PeriodSums, sound: PeriodSums) -> list[Flag]:
    lost = gate.period_count - sound.period_count
    if not lost:
        return []
    message = f"{lost} of {gate.period_count} periods have missing samples and were left out"
    return [Flag("void_periods", Severity.VOID, message)]


def _few(result: Harmonics) -> list[Flag]:
    if result.interval_source is IntervalSource.NONE:
        message = "a single period has no scatter, so no interval is given; gate more periods"
        return [Flag("no_interval", Severity.WARNING, message)]
    if result.degrees_of_freedom.max() + 1.0 < _FEW_PERIODS:
        message = (
            f"the interval rests on {result.degrees_of_freedom.max() + 1.0:.0f} periods; "
            f"{_FEW_PERIODS} or more make it narrower and firmer"
        )
        return [Flag("few_periods", Severity.WARNING, message)]
    return []


def _speed(gate: PeriodSums) -> list[Flag]:
    period_s = gate.closed_s - gate.opened_s
    change = float(np.ptp(period_s) / period_s.mean())
    if change <= _SPEED_CHANGE:
        return []
    message = (
        f"the period changes by {100.0 * change:.2f} % within the gate "
        f"(limit {100.0 * _SPEED_CHANGE:.1f} %)"
    )
    return [Flag("speed_change", Severity.WARNING, message)]


def _drift(result: Harmonics) -> list[Flag]:
    """A drift that would have mattered, had it not been taken out.

    One that is lost in the in-phase part's own interval, or in rounding, would not.
    """
    if result.drift_source is DriftSource.NONE:
        return []
    per_period = np.abs(result.drift_per_s) / result.frequency_hz
    leak = per_period / np.pi  # into the first in-phase part
    matters = np.maximum(_NOTABLE * result.amplitude[:, 0], _ROUNDING * np.abs(result.mean))
    matters = np.fmax(matters, result.half_width()[:, 1])
    flags = []
    for row, name in enumerate(result.channel_names):
        if leak[row] > matters[row]:
            message = (
                f"a drift of {result.drift_per_s[row]:.3g} {result.units[row]}/s was taken out; "
                f"left in, it would shift the in-phase part by {leak[row]:.3g} {result.units[row]}"
            )
            flags.append(Flag("drift", Severity.NOTE, message, name))
    return flags


def _transient(values: PeriodValues, result: Harmonics) -> list[Flag]:
    """A first harmonic that is still on its way: a sure and notable trend over the periods."""
    first = values.coefficients[:, :, 1:3]
    time = np.arange(len(first)) - (len(first) - 1) / 2.0
    slope = np.einsum("p,pci->ci", time, first) / (time @ time)
    left = first - first.mean(axis=0) - time[:, None, None] * slope
    error = np.sqrt((left**2).sum(axis=0) / (len(first) - 2) / (time @ time))
    change = np.abs(slope) * (len(first) - 1)
    amplitude = result.amplitude[:, 0]
    sure = (np.abs(slope) > _SURE * error) & (change > _NOTABLE * amplitude[:, None])
    flags = []
    alone = (result.half_width() / result.widening)[:, 1:3].max(axis=1)  # a trend has memory itself
    moves = amplitude > alone  # else noise trends by itself
    for row in np.flatnonzero(sure.any(axis=1) & moves):
        share = 100.0 * change[row].max() / amplitude[row]
        message = (
            f"the first harmonic still changes by {share:.1f} % of its amplitude from the gate's "
            "first period to its last; open it later, or gate fewer periods"
        )
        flags.append(Flag("transient", Severity.WARNING, message, result.channel_names[row]))
    return flags
