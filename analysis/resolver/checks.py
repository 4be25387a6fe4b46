"""Flags of a gate: gaps, drift, transients, changing speed, saturation."""

import numpy as np

from analysis.recording import Recording
from analysis.resolver.harmonics import DriftSource, Harmonics, IntervalSource
from analysis.resolver.period_values import PeriodValues, solve_periods, usable
from analysis.resolver.reference import PhaseReference, ReferenceSource
from analysis.resolver.settings import ResolverSettings
from analysis.resolver.sums import PeriodSums, period_sums
from hardware.description.arrays import FloatArray
from hardware.description.channels import CARRIAGE_SPEED
from hardware.description.flags import Flag, Severity

_SPEED_CHANGE = 0.005  # from the shortest to the longest period, relative
_FEW_PERIODS = 3  # below it an interval is a formality
_SURE = 4.0  # standard errors that make a trend sure
_ROUNDING = 1e-9  # of the mean: what a constant channel may seem to drift
_NOTABLE = 0.01  # of the first harmonic: a change that matters
_AT_ONCE = 200_000  # samples
_ROUNDED = 1.0 - 1e-9  # of the full scale
_FEWEST_STEPS = 20  # of a channel that is held: fewer may be even by chance
_HELD = 1.5  # samples that a value stands for
_EVENLY = 0.9  # of the steps
_LOOKED_AT = 1000  # samples of some periods, in which a channel of coarse steps has few values
_MOST_VALUES = 50  # of them
_DITHERED = 0.5  # steps of noise: with as much the error of rounding is gone
_COARSE = 0.375  # largest error of a harmonic of a sine in steps, times the root of its amplitude


def gate_flags(gate: PeriodSums, result: Harmonics) -> tuple[Flag, ...]:
    """Return the flags of one gate: gaps, few periods, speed, drift, transient."""
    sound = usable(gate)
    flags = [*_gap(gate, sound), *_few_periods(result), *_speed(gate), *_drift(result)]
    if sound.period_count >= 2 * _FEW_PERIODS:
        flags += _transient(solve_periods(sound), result)
    return tuple(flags)


def _gap(gate: PeriodSums, sound: PeriodSums) -> list[Flag]:
    lost = gate.period_count - sound.period_count
    if not lost:
        return []
    message = f"{lost} of {gate.period_count} periods have missing samples and were left out"
    return [Flag("void_periods", Severity.VOID, message)]


def _few_periods(result: Harmonics) -> list[Flag]:
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
    """A first harmonic that is still on its way: a sure and notable trend over the periods.

    Notable beside the channel's largest harmonic: where others are excited it may be next to none.
    """
    first = values.coefficients[:, :, 1:3]
    time = np.arange(len(first)) - (len(first) - 1) / 2.0
    slope = np.einsum("p,pci->ci", time, first) / (time @ time)
    residuals = first - first.mean(axis=0) - time[:, None, None] * slope
    error = np.sqrt((residuals**2).sum(axis=0) / (len(first) - 2) / (time @ time))
    change = np.abs(slope) * (len(first) - 1)
    amplitude = result.amplitude[:, 0]
    largest = result.amplitude.max(axis=1)
    sure = (np.abs(slope) > _SURE * error) & (change > _NOTABLE * largest[:, None])
    flags = []
    limit = (result.half_width() / result.widening)[:, 1:3].max(axis=1)  # a trend has memory itself
    moves = amplitude > limit  # else noise trends by itself
    for row in np.flatnonzero(sure.any(axis=1) & moves):
        share = 100.0 * change[row].max() / amplitude[row]
        message = (
            f"the first harmonic still changes by {share:.1f} % of its amplitude from the gate's "
            "first period to its last; open it later, or gate fewer periods"
        )
        flags.append(Flag("transient", Severity.WARNING, message, result.channel_names[row]))
    return flags


def saturation_flags(recording: Recording, opened_s: float, closed_s: float) -> tuple[Flag, ...]:
    """Return a flag for each channel that reached its full scale between two times.

    A channel that its reader has flagged already is not flagged again.
    """
    flagged = {flag.channel for flag in recording.flags if flag.code == "saturated"}
    rows = [
        row
        for row, channel in enumerate(recording.channels)
        if channel.full_scale is not None and channel.name not in flagged
    ]
    if not rows:
        return ()
    used = recording.between(opened_s, closed_s)
    limits = np.array([recording.channels[row].full_scale for row in rows], dtype=np.float64)
    counts = np.zeros(len(rows), dtype=np.int64)
    for start in range(0, used.sample_count, _AT_ONCE):
        values = used.samples[rows, start : start + _AT_ONCE]
        counts += (np.abs(values) >= limits[:, None] * _ROUNDED).sum(axis=1)
    return tuple(
        Flag(
            "saturated",
            Severity.VOID,
            f"{count} samples of the periods used stand at the full scale of {limit:g} "
            f"{recording.channels[row].unit}; the harmonics are those of the clipped signal",
            recording.channels[row].name,
        )
        for row, limit, count in zip(rows, limits, counts.tolist(), strict=True)
        if count
    )


def held_flags(recording: Recording, opened_s: float, closed_s: float) -> tuple[Flag, ...]:
    """Return a flag for each channel that keeps each value for an even number of samples.

    A sensor that is slower than the recording stands still in between: its signal is late by half
    of that. A carriage's speed is polled, and its age is known
    (:mod:`analysis.response.following`).
    """
    used = recording.between(opened_s, closed_s)
    flags = []
    for name in used.channel_names:
        if name == CARRIAGE_SPEED.name:
            continue
        usual = _held_samples(used.values(name))
        if usual < _HELD:
            continue
        late_ms = 500.0 * (usual - 1.0) / recording.sample_rate_hz
        message = (
            f"each value stands for {usual:.3g} samples: its sensor is read at "
            f"{recording.sample_rate_hz / usual:.3g} Hz, not at {recording.sample_rate_hz:.4g} Hz, "
            f"and the signal is late by {late_ms:.3g} ms; record it at its own rate, or take that "
            "off its phases"
        )
        flags.append(Flag("held", Severity.WARNING, message, name))
    return tuple(flags)


def coarse_flags(recording: Recording, opened_s: float, closed_s: float) -> tuple[Flag, ...]:
    """Return a flag for each channel that moves over few steps of its numbers, without noise.

    Rounded alike in all periods, its harmonics are off by what does not scatter between them: by up
    to 0.375 steps over the root of the amplitude in steps (Bessel functions of both).

    Parameters
    ----------
    opened_s, closed_s
        A few whole periods: what lies between them is looked at.
    """
    used = recording.between(opened_s, closed_s)
    every = -(-used.sample_count // _LOOKED_AT)
    flags = []
    for channel in used.channels:
        values = used.values(channel.name)[::every]
        step, amplitude = _steps(values[np.isfinite(values)])
        error = _COARSE / np.sqrt(amplitude - 0.5)  # rounded up by as much, it may be
        if error <= _NOTABLE * amplitude:
            continue
        message = (
            f"the numbers have steps of {step:.3g} {channel.unit}, over {amplitude:.2g} of which "
            f"the channel moves to either side with less noise than half a step: harmonics may be "
            f"off by {error * step:.2g} {channel.unit}, beyond their intervals; record it with "
            "more digits, or over a smaller range"
        )
        flags.append(Flag("coarse_steps", Severity.WARNING, message, channel.name))
    return tuple(flags)


def _steps(values: FloatArray) -> tuple[float, float]:
    """Return the step that all values are multiples of and the amplitude in steps, or no end."""
    levels = np.unique(values)
    if not 3 <= len(levels) <= _MOST_VALUES:
        return 0.0, np.inf
    apart = np.diff(levels)
    step = float(apart.min())
    whole = np.abs(apart / step - np.rint(apart / step)).max() < 0.01
    noise = float(np.sqrt((np.diff(values, n=2) ** 2).mean() / 6.0))
    if not whole or noise > _DITHERED * step:
        return 0.0, np.inf
    return step, float(levels[-1] - levels[0]) / step / 2.0


def _held_samples(values: FloatArray) -> float:
    """Return how many samples each value stands for; 1 where they last unevenly, or by their steps.

    A slack wire or a stop rests long now and then, which is no usual time. Values of a coarse
    converter wait for the next step: most change by a single one, a slow sensor's by any.
    """
    steps = np.diff(values)
    changes = np.flatnonzero(steps)
    lasting = np.diff(changes)
    if lasting.size < _FEWEST_STEPS or lasting.mean() < _HELD:
        return 1.0
    heights = np.abs(steps[changes])
    usual = float(lasting[lasting <= 2.0 * np.median(lasting)].mean())
    evenly = np.mean(np.abs(lasting - usual) < 1.0) >= _EVENLY
    single = np.mean(heights < 1.5 * heights.min()) > 0.5
    return usual if evenly and not single else 1.0


def reference_flags(
    recording: Recording, reference: PhaseReference, steady: PeriodSums, settings: ResolverSettings
) -> tuple[Flag, ...]:
    """Say where a signal that tells the phase does not keep its amplitude in the periods used.

    Of channels that waves reach later it is what the signal did so much earlier.
    """
    name = reference.channel
    if reference.source is not ReferenceSource.SIGNAL or name is None:
        return ()
    signal = recording.select([name]).complete()
    edges = steady.edges_cycles - reference.frequency_hz * settings.delay_s
    sums = period_sums(signal, reference, 1, edges_cycles=edges)
    values = solve_periods(sums).coefficients[:, 0]
    size = np.hypot(values[:, 1], values[:, 2])
    usual = float(np.nanmedian(size)) if np.isfinite(size).any() else np.inf
    deviation = np.abs(size - usual)
    outside = np.flatnonzero(deviation > settings.steady_tolerance * usual)
    if not outside.size:
        return ()
    worst = int(np.nanargmax(deviation))
    unit = recording.channels[recording.index(name)].unit
    message = (
        f"the amplitude of the reference leaves {usual:.4g} {unit} by more than "
        f"{100.0 * settings.steady_tolerance:g} % in {outside.size} of {len(size)} periods, the "
        f"first from {sums.opened_s[outside[0]]:.3f} s on; it is {size[worst]:.4g} {unit} at "
        f"{sums.opened_s[worst]:.3f} s: the motion starts, stops or changes there. Choose the gate "
        "before or after"
    )
    return (Flag("reference_unsteady", Severity.WARNING, message, name),)
