"""The phase from a measured signal: a stroke, a strut's displacement, a wave maker's position."""

from dataclasses import replace

import numpy as np

from analysis.recording import Recording
from analysis.resolver.estimate import fit_drift
from analysis.resolver.gaps import gap_in_words, without_gaps
from analysis.resolver.period_values import solve_periods
from analysis.resolver.reference import (
    NoReferenceError,
    PhaseReference,
    ReferenceSource,
    from_frequency,
)
from analysis.resolver.sums import period_sums
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

_COARSE_SAMPLES = 1 << 20  # enough for the first look at the frequency of a record of any length
_FASTEST = 0.9  # of the Nyquist frequency: beyond it a period has too few samples to follow
_MOVING = 0.5  # of the usual amplitude: below it the signal is starting, stopping or at rest
JUMP_CYCLES = 0.1  # from one period to the next: noise, not a motion
_BY_CHANCE = 0.1  # periods of noise alone that would keep time so well: more is no motion
_FEW_PERIODS = 5  # that keep time: fewer may be noise that happens to
_ROUNDING = 1e-12  # of the largest value: a spectrum as small is that of a constant or a ramp


def from_signal(recording: Recording, name: str, holds_s: float | None = None) -> PhaseReference:
    """Build a reference from the fundamental of one channel.

    The frequency is found in the spectrum, then the phase period by period, so that a change of
    speed is followed; whole cycles are where the fundamental passes zero upwards. The reference
    covers the longest stretch in which the signal moves and no sample of it is missing.

    Parameters
    ----------
    holds_s
        Where samples are missing: take the stretch that holds this time, not the longest.

    Raises
    ------
    NoReferenceError
        If no motion of steady frequency is found; the message says where samples are missing.
    """
    signal, flags = without_gaps(recording.select([name]), name, holds_s)
    try:
        phase = _in_whole(signal, name)
    except DataError as error:
        raise NoReferenceError(f"{error}{gap_in_words(flags)}") from None
    return replace(phase, flags=flags + phase.flags)


def _in_whole(signal: Recording, name: str) -> PhaseReference:
    """Build the reference of a signal without gaps."""
    duration_s = signal.end_s - signal.start_s
    frequency_hz = _coarse_frequency_hz(_roughly_even(signal, name), signal.sample_rate_hz)
    if frequency_hz * duration_s < 1.0:
        raise _no_reference(signal, name, _no_period(signal))
    middle_s, cycles = _follow(signal, frequency_hz)
    refined = _slope(middle_s, cycles) if len(cycles) > 2 else frequency_hz
    middle_s, cycles = _follow(signal, refined)
    if len(cycles) < 2 or _by_chance(cycles, refined * duration_s) > _BY_CHANCE:
        raise _no_reference(signal, name, _no_time_kept(frequency_hz, duration_s))
    # The phase is known at the middle of each period; knots at whole cycles make them straight.
    followed = PhaseReference(ReferenceSource.SIGNAL, middle_s, cycles)
    whole_cycles = np.arange(np.ceil(cycles[0] - 0.5), np.floor(cycles[-1] + 0.5) + 1.0)
    times_s, flags = followed.times_at(whole_cycles), _few_flags(name, len(cycles))
    return PhaseReference(ReferenceSource.SIGNAL, times_s, whole_cycles, flags, name)


def _few_flags(name: str, periods: int) -> tuple[Flag, ...]:
    if periods >= _FEW_PERIODS:
        return ()
    message = (
        f"only {periods} periods of the reference keep time (fewer than {_FEW_PERIODS}): noise may "
        "do so by chance; make sure that this channel carries the motion, or give the frequency"
    )
    return (Flag("few_reference_periods", Severity.WARNING, message, name),)


def _no_period(signal: Recording) -> str:
    duration_s = signal.end_s - signal.start_s
    if not np.ptp(signal.values(signal.channel_names[0])):
        return f"it is constant over {duration_s:.3g} s"
    return f"not one whole period in {duration_s:.3g} s; the record is too short, or does not move"


def _no_time_kept(frequency_hz: float, duration_s: float) -> str:
    words = f"nothing that keeps time near {frequency_hz:.3g} Hz"
    periods = frequency_hz * duration_s
    if periods > _FEW_PERIODS:
        return words
    return f"{words}, and {duration_s:.3g} s is too short for more than {periods:.1f} such periods"


def _no_reference(recording: Recording, name: str, available: str) -> NoReferenceError:
    told = ""
    if recording.set_point is not None:
        set_hz = recording.set_point.frequency_hz
        periods = set_hz * (recording.end_s - recording.start_s)
        told = f" (the record has {periods:.3g} periods of the set-point's {set_hz:.4g} Hz)"
    return NoReferenceError(
        f"{recording.name}: no reference found in channel {name!r}: {available}{told}; name "
        "another channel, or give the frequency"
    )


def _roughly_even(signal: Recording, name: str) -> FloatArray:
    """Return a channel on an even grid, for a first look at its spectrum."""
    values = signal.values(name)
    if signal.stamps_s is None:
        return values
    grid_s = np.linspace(signal.start_s, signal.end_s, len(values))
    return np.interp(grid_s, signal.stamps_s, values)


def _coarse_frequency_hz(values: FloatArray, sample_rate_hz: float) -> float:
    """Strongest line of the spectrum, between bins by a parabola."""
    step = -(-len(values) // _COARSE_SAMPLES)
    used = len(values) // step * step
    coarse = values[:used].reshape(-1, step).mean(axis=1)
    time = np.linspace(-1.0, 1.0, len(coarse))
    level = coarse - coarse.mean()
    level -= time * (time @ level) / (time @ time)
    power = np.abs(np.fft.rfft(level * np.hanning(len(coarse))))
    power[:2] = 0.0  # offset and drift
    power[int(_FASTEST * len(power)) :] = 0.0
    peak = int(np.argmax(power))
    if power[peak] <= _ROUNDING * len(coarse) * np.abs(coarse).max():
        return 0.0
    left, top, right = np.log(np.maximum(power[peak - 1 : peak + 2], 1e-300))
    between = 0.5 * (left - right) / (left - 2.0 * top + right)
    return float((peak + np.clip(between, -0.5, 0.5)) * sample_rate_hz / step / len(coarse))


def _follow(signal: Recording, frequency_hz: float) -> tuple[FloatArray, FloatArray]:
    """Times and cycles at mid-period over the longest stretch in which the signal moves."""
    samples = signal.sample_rate_hz / frequency_hz
    harmonics = max(1, min(3, int((samples - 1.0) // 2)))
    steady = from_frequency(frequency_hz, signal.start_s, signal.end_s)
    sums = period_sums(signal, steady, harmonics)
    moving = sums[_longest_motion(_first_harmonic(solve_periods(sums).coefficients[:, 0]))]
    values = solve_periods(moving)
    # A drift would add -d / pi per period to each in-phase part, and so turn the phase.
    drift = fit_drift(moving, moving).slope[0] * values.ramp
    turned = np.unwrap(np.angle(_first_harmonic(values.coefficients[:, 0] - drift)))
    middle_s = (moving.opened_s + moving.closed_s) / 2.0
    return middle_s, steady.cycles_at(middle_s) + turned / (2.0 * np.pi)


def _first_harmonic(coefficients: FloatArray) -> ComplexArray:
    return np.asarray(coefficients[:, 1] + 1j * coefficients[:, 2])


def _longest_motion(phasor: ComplexArray) -> slice:
    """The longest run of periods that move and keep time with each other."""
    amplitude = np.abs(phasor)
    moving = amplitude > _MOVING * np.quantile(amplitude, 0.9)
    turn = np.angle(phasor[1:] * phasor[:-1].conj()) / (2.0 * np.pi)
    joined = moving[1:] & moving[:-1] & (np.abs(turn) < JUMP_CYCLES)
    breaks = np.flatnonzero(np.concatenate(([True], ~joined, [True])))
    longest = int(np.argmax(np.diff(breaks)))
    return slice(int(breaks[longest]), int(breaks[longest + 1]))


def _by_chance(cycles: FloatArray, periods: float) -> float:
    """Stretches of this length and as good a time that ``periods`` of mere noise would hold.

    From one period of noise to the next the phase turns by anything; one turn is used up where the
    frequency was fitted.
    """
    turn = 2.0 * float(np.abs(np.diff(cycles) - 1.0).max())
    return float(periods * turn ** max(1, len(cycles) - 2))


def _slope(times_s: FloatArray, cycles: FloatArray) -> float:
    return float(np.polyfit(times_s - times_s.mean(), cycles, 1)[0])
