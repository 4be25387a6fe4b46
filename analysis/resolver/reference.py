"""Phase of the shaft over time, from any of the rig's sensors that shows it.

A reference is the number of revolutions as a function of time, straight between knots. Its phase
``theta = 2 pi cycles`` is that of the aft strut's motion ``sin(theta)``: the harmonics' in-phase
part goes with ``sin(n theta)``, the quadrature part with ``cos(n theta)``.

Use the photocell where there is one; a shaft encoder where the speed ripples within a revolution;
a given frequency for synthetic records; and a reference signal (stroke, displacement) for
recordings of other systems (:mod:`analysis.resolver.signal_reference`).
"""

from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from hardware.description.arrays import BoolArray, FloatArray
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

_WRAP_IN_DEGREES = 50.0  # no shaft turns as far between two samples: radians wrap by 2 pi
_STRAYS = 4.0  # times the median distance from the line: no knot of a motion that is steady
_SWEEPS = 4
KNOTS_PER_REVOLUTION = 256  # of an encoder: enough to follow gear ripple, few enough to keep
_FEWEST_KNOTS = 4  # of an encoder per revolution, however loud
_FAR = 12.0  # times the median distance of an angle's steps from the usual one: 8 deviations
_FALL = 0.05  # turns, by which an angle lies behind what it was
_SURE = 5.0  # standard deviations
_NORMAL_90 = 1.645  # standard deviations, within which 9 in 10 of normal values lie


class NoReferenceError(DataError):
    """No channel of the recording shows the phase; a frequency or another channel may help."""


class ReferenceSource(StrEnum):
    """Which sensor or number the phase comes from.

    With a stated frequency the phase is 0 at the first sample. With the set-point's it is not known
    where in the motion the first sample lies: only amplitudes mean something.
    """

    PHOTOCELL = "photocell"
    ENCODER = "encoder"
    FREQUENCY = "frequency"
    SIGNAL = "signal"
    SET_POINT = "set-point"


@dataclass(frozen=True)
class PhaseReference:
    """Revolutions over time.

    Attributes
    ----------
    times_s, cycles
        Knots, both increasing, shape ``(knots,)``; the phase is straight between them. Whole
        numbers of ``cycles`` are where the reference motion passes zero upwards.
    channel
        The channel that told the phase, if one did.
    """

    source: ReferenceSource
    times_s: FloatArray
    cycles: FloatArray
    flags: tuple[Flag, ...] = ()
    channel: str | None = None

    def cycles_at(self, times_s: FloatArray) -> FloatArray:
        """Return the revolutions at some times; beyond the knots the end lines go on."""
        return _interpolate(times_s, self.times_s, self.cycles)

    def times_at(self, cycles: FloatArray) -> FloatArray:
        """Return the times at which some revolutions are reached."""
        return _interpolate(cycles, self.cycles, self.times_s)

    def delayed(self, delay_s: float) -> "PhaseReference":
        """Return the reference so much later, its phase carried on at its usual frequency."""
        if not delay_s:
            return self
        return replace(
            self,
            times_s=self.times_s + delay_s,
            cycles=self.cycles + self._usual_hz() * delay_s,
        )

    def _usual_hz(self) -> float:
        """Return the frequency of most knots: those where a motion starts or stops are left out.

        There the phase is that of an amplitude that changes, off by a degree or so.
        """
        times_s, cycles = self.times_s, self.cycles
        for _ in range(_SWEEPS):
            line = np.polynomial.Polynomial.fit(times_s, cycles, 1)
            deviations = np.abs(cycles - line(times_s))
            near_line = deviations <= _STRAYS * float(np.median(deviations))
            if near_line.sum() < max(2, len(self.cycles) // 2):
                break
            times_s, cycles = times_s[near_line], cycles[near_line]
        return float(line.deriv()(times_s[0]))

    @property
    def frequency_hz(self) -> float:
        """Mean frequency from the first knot to the last."""
        return float(np.ptp(self.cycles) / np.ptp(self.times_s))


def _interpolate(x: FloatArray, knots: FloatArray, values: FloatArray) -> FloatArray:
    inside = np.interp(x, knots, values)
    first = (values[1] - values[0]) / (knots[1] - knots[0])
    last = (values[-1] - values[-2]) / (knots[-1] - knots[-2])
    inside += np.minimum(x - knots[0], 0.0) * first
    inside += np.maximum(x - knots[-1], 0.0) * last
    return np.asarray(inside)


def from_frequency(
    frequency_hz: float, start_s: float, end_s: float, phase_rad: float = 0.0
) -> PhaseReference:
    """Build a reference of a known constant frequency, with ``phase_rad`` at ``start_s``.

    Raises
    ------
    DataError
        If the frequency is not positive or less than one period fits.
    """
    if not frequency_hz > 0.0:
        raise DataError(
            f"a frequency of {frequency_hz:g} Hz gives no reference; it must be above 0"
        )
    revolutions = frequency_hz * (end_s - start_s)
    if revolutions < 1.0:
        raise DataError(
            f"the record of {end_s - start_s:.3g} s holds {revolutions:.2f} periods of "
            f"{frequency_hz:g} Hz; at least one whole period is needed"
        )
    cycles = phase_rad / (2.0 * np.pi) + np.array([0.0, revolutions])
    return PhaseReference(ReferenceSource.FREQUENCY, np.array([start_s, end_s]), cycles)


def from_encoder(
    times_s: FloatArray, angle_rad: FloatArray, angle_offset_rad: float = 0.0
) -> PhaseReference:
    """Build a reference from a shaft encoder.

    Its knots are averages over a few samples, where one is too loud: if the highest readings
    counted, noise would carry the phase ahead.

    Parameters
    ----------
    times_s, angle_rad
        Shape ``(samples,)``. The angle may be wrapped at one turn and may run backwards: a shaft
        that turns the other way is counted positive and flagged.
    angle_offset_rad
        Shaft angle where the encoder reads zero.

    Raises
    ------
    DataError
        If an angle is missing, the shaft makes less than one turn, or degrees were not said.
    """
    if not np.all(np.isfinite(angle_rad)):
        raise NoReferenceError("the shaft angle has missing samples; give another reference")
    jump = float(np.abs(np.diff(angle_rad)).max(initial=0.0))
    if jump > _WRAP_IN_DEGREES:
        raise NoReferenceError(
            f"units look wrong: the shaft angle jumps by {jump:.4g} rad from one sample to the "
            "next, which is a turn in degrees; say its unit, as in 'Angle:deg'"
        )
    turns = angle_rad / (2.0 * np.pi)
    stray = _strays(turns)
    flags = _stray_flags(times_s[stray])
    times_s, turns = times_s[~stray], np.unwrap(turns[~stray], period=1.0)
    if turns[-1] < turns[0]:
        turns = -turns
        flags += (Flag("reverse_rotation", Severity.NOTE, "the shaft turns backwards"),)
    turns = turns + angle_offset_rad / (2.0 * np.pi)
    revolutions = turns[-1] - turns[0]
    if revolutions < 1.0:
        raise NoReferenceError(
            f"the shaft makes {revolutions:.2f} turns; at least one whole one is needed"
        )
    times_s, turns = _averages(times_s, turns, _block(turns))
    rising = np.maximum.accumulate(turns)
    flags += _fall_flags(times_s, rising - turns)
    moving = np.append(True, np.diff(rising) > 0.0)
    return PhaseReference(ReferenceSource.ENCODER, times_s[moving], rising[moving], flags)


def _strays(turns: FloatArray) -> BoolArray:
    """Say which samples lie by themselves, as one that is read while the encoder wraps.

    Those before and after it are two steps apart.
    """
    stray = np.zeros(len(turns), dtype=bool)
    if len(turns) < 3:
        return stray
    steps = _wrapped(np.diff(turns))
    usual = float(np.median(steps))
    away = np.abs(_wrapped(steps - usual))
    limit = _FAR * float(np.median(away)) + 2.0 * abs(usual)
    apart = np.abs(_wrapped(turns[2:] - turns[:-2] - 2.0 * usual))
    stray[1:-1] = (away[:-1] > limit) & (away[1:] > limit) & (apart < limit)
    return stray


def _wrapped(turns: FloatArray) -> FloatArray:
    return np.asarray(turns - np.rint(turns))


def _stray_flags(times_s: FloatArray) -> tuple[Flag, ...]:
    if not times_s.size:
        return ()
    where = ", ".join(f"{time_s:.3f} s" for time_s in times_s[:5])
    message = f"{times_s.size} samples of the shaft angle lie by themselves, left out: {where}"
    return (Flag("angle_stray", Severity.WARNING, message),)


def _fall_flags(times_s: FloatArray, fallen: FloatArray) -> tuple[Flag, ...]:
    """Say where the angle is behind what it was before, by more than noise or a shaft at rest."""
    back = np.flatnonzero(fallen > _FALL)
    if not back.size:
        return ()
    message = (
        f"the shaft angle falls back by {360.0 * fallen.max():.3g} degrees from "
        f"{times_s[back[0]]:.3f} s to {times_s[back[-1]]:.3f} s, as if it stood still; "
        "choose a gate without it"
    )
    return (Flag("angle_falls_back", Severity.VOID, message),)


def _block(turns: FloatArray) -> int:
    """Return how many samples make a knot: enough for its noise not to turn the shaft back."""
    per_sample = float(turns[-1] - turns[0]) / len(turns)
    second = np.abs(np.diff(turns, n=2))
    noise = float(np.quantile(second, 0.9)) / (_NORMAL_90 * np.sqrt(6.0))
    # The noise of two knots' difference is sqrt(2 / m) of a sample's, and they are m steps apart.
    quiet = int(np.ceil((_SURE * np.sqrt(2.0) * noise / per_sample) ** (2.0 / 3.0)))
    most = int(1.0 / per_sample / _FEWEST_KNOTS)
    return max(1, int(1.0 / per_sample / KNOTS_PER_REVOLUTION), min(quiet, most))


def _averages(times_s: FloatArray, turns: FloatArray, size: int) -> tuple[FloatArray, FloatArray]:
    """Return times and turns averaged over so many samples, carried on straight to both ends."""
    if size == 1:
        return times_s, turns
    count = len(turns) // size * size
    middle_s, means = (part[:count].reshape(-1, size).mean(axis=1) for part in (times_s, turns))
    knots_s = np.concatenate((times_s[:1], middle_s, times_s[-1:]))
    return knots_s, _interpolate(knots_s, middle_s, means)
