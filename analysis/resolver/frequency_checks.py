"""Flags of a reference whose frequency is not the motion's: off a little, half of it, twice it."""

import numpy as np

from analysis.recording import Recording
from analysis.resolver.harmonics import Harmonics
from analysis.resolver.period_values import PeriodValues
from analysis.resolver.reference import PhaseReference, ReferenceSource
from hardware.description.arrays import ComplexArray
from hardware.description.flags import Flag, Severity

_FEWEST = 4  # periods: fewer tell no turning from noise
_NOTABLE_CYCLES = 0.05  # from the first period to the last
_STEADY = 0.95  # mean resultant length of the turns: 1 where all are the same
_STRAIGHT = 0.2  # largest distance from an even turning, of the whole turn
_STATED = {ReferenceSource.FREQUENCY: "given", ReferenceSource.SET_POINT: "set-point's"}
_MARKS = (2, 3)  # that a shaft may have by mistake, evenly round it
_FEWEST_MARKED = 8  # periods: one channel of noise in 1000 comes back so in as many
_EXPLAINED = 0.9  # of how far first harmonics lie from their mean


def frequency_flags(
    names: tuple[str, ...], values: PeriodValues, reference: PhaseReference
) -> tuple[Flag, ...]:
    """Return ``frequency_differs`` where the first harmonic turns steadily against a given one.

    Judged by the channel whose first harmonic stands out most from what else its periods do.

    Parameters
    ----------
    names
        The channels of ``values``.
    """
    if reference.source not in _STATED:
        return ()
    phasors = _first_harmonics(values)
    phasors = phasors[np.isfinite(phasors).all(axis=1)]
    if len(phasors) < _FEWEST:
        return ()
    # Where periods were left out one turn spans several; the median does not mind a few.
    row = _strongest_row(phasors)
    per_period = _turn(phasors[:, row])
    if per_period is None:
        return ()
    stated_hz, fits = reference.frequency_hz, reference.frequency_hz * (1.0 + per_period)
    message = (
        f"the phase turns by {360.0 * per_period:+.3g} degrees a period against the "
        f"{_STATED[reference.source]} {stated_hz:.6g} Hz: {fits:.6g} Hz fits. The harmonics "
        "found are too small; give this frequency, or take the phase from a channel"
    )
    return (Flag("frequency_differs", Severity.WARNING, message, names[row]),)


def pulse_flags(
    recording: Recording, reference: PhaseReference, values: PeriodValues, reading: Harmonics
) -> tuple[Flag, ...]:
    """Return ``half_frequency`` or ``double_frequency`` where pulses miss turns, or halve them.

    A motion of many lines may look so by itself.

    Parameters
    ----------
    values
        Of the periods of the steady stretch.
    """
    is_single = recording.set_point is None or not recording.set_point.lines
    if reference.source is not ReferenceSource.PHOTOCELL or not is_single:
        return ()
    return _double_frequency(values, reading) or _half_frequency(reading)


def _double_frequency(values: PeriodValues, reading: Harmonics) -> tuple[Flag, ...]:
    """Say where half of the channels or more come back every second or third period only.

    A motion of half the frequency has a first harmonic of either sign in turn, 0.42 to 0.85 of its
    amplitude, and no mean one.
    """
    phasors = _first_harmonics(values)
    number = np.flatnonzero(np.isfinite(phasors).all(axis=1))
    phasors = phasors[number]
    if len(phasors) < _FEWEST_MARKED:
        return ()
    mean = phasors.mean(axis=0)
    left = (np.abs(phasors - mean) ** 2).mean(axis=0)
    for marks in _MARKS:
        lines = np.exp(-2j * np.pi * np.outer(np.arange(1, marks), number) / marks) / len(number)
        power = (np.abs(lines @ phasors) ** 2).sum(axis=0)
        slower = (power > _EXPLAINED * left) & (power > np.abs(mean) ** 2)
        if 2 * slower.sum() < len(slower):
            continue
        frequency_hz = reading.frequency_hz
        message = (
            f"{slower.sum()} of {len(slower)} channels come back only once in {marks} periods: "
            f"there are {marks} pulses a turn, and the motion has {frequency_hz / marks:.5g} Hz, "
            f"not {frequency_hz:.5g} Hz. Mask the marks but one, or take the phase from a channel"
        )
        return (Flag("double_frequency", Severity.VOID, message),)
    return ()


def _half_frequency(reading: Harmonics) -> tuple[Flag, ...]:
    """Say where all channels, two at least, move twice in what the pulses call a period.

    A single channel, such as a surge force, may do so by itself.
    """
    if reading.order < 2:
        return ()
    first, second = reading.amplitude[:, 0], reading.amplitude[:, 1]
    limit = reading.half_width()[:, 3:5].max(axis=1)  # noise has either now and then
    if len(first) < 2 or not np.all(second > np.maximum(first, limit)):
        return ()
    frequency_hz = reading.frequency_hz
    message = (
        f"the second harmonic is above the first in all channels: the pulses come once in two "
        f"periods, and the motion has {2.0 * frequency_hz:.5g} Hz, not {frequency_hz:.5g} Hz. "
        "Is every second pulse lost? Else take the phase from a channel"
    )
    return (Flag("half_frequency", Severity.WARNING, message),)


def _first_harmonics(values: PeriodValues) -> ComplexArray:
    """Return each period's first harmonics, shape ``(periods, channels)``."""
    return np.asarray(values.coefficients[:, :, 1] + 1j * values.coefficients[:, :, 2])


def _strongest_row(phasors: ComplexArray) -> int:
    """Row of the channel whose amplitude is largest against its change from period to period."""
    size = np.abs(phasors)
    change = np.abs(np.diff(size, axis=0)).mean(axis=0)
    return int(np.argmax(size.mean(axis=0) / np.maximum(change, 1e-12 * size.max(axis=0) + 1e-300)))


def _turn(phasor: ComplexArray) -> float | None:
    """Cycles by which a phasor turns from one period to the next; ``None`` if not steadily."""
    steps = phasor[1:] * phasor[:-1].conj()
    steps = steps / np.maximum(np.abs(steps), 1e-300)
    if abs(steps.mean()) < _STEADY:
        return None
    turned = np.unwrap(np.angle(phasor)) / (2.0 * np.pi)
    period = np.arange(len(turned)) - (len(turned) - 1) / 2.0
    per_period = float(period @ turned / (period @ period))
    cycles = abs(per_period) * (len(turned) - 1)
    departure = np.abs(turned - turned.mean() - per_period * period).max()
    return per_period if cycles > _NOTABLE_CYCLES and departure < _STRAIGHT * cycles else None
