"""One signal of a free oscillation, its usable part, and whether it is sampled fast enough."""

from dataclasses import dataclass, replace

import numpy as np

from analysis.inertia.envelope import end_amplitudes, envelope_of, noise_of, release
from analysis.inertia.spectrum import Spectrum, spectrum
from analysis.recording import Recording, sample_numbers
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

SWINGING_UNITS = ("rad", "m", "rad/s", "m/s2", "V")
DIED_OUT = 0.03  # of the first amplitude
ABOVE_NOISE = 3.0  # times the noise's standard deviation
LONGEST_GAP_PERIODS = 0.5
# What the reader says of missing samples: void for means over whole cycles, but the fits here leave
# them out, and usable_part flags them by their length in periods.
_LEFT_OUT = ("gap", "missing")
FEWEST_SAMPLES_A_PERIOD = 5.0
ALIASED_SHARE = 0.1
_BRIDGED = 5.0  # mean intervals that straight lines join where only the way is looked for
LINE_OVER_MEDIAN = 8.0  # the highest of ten thousand lines of white noise is 3.7


def rough_period(where: str, values: FloatArray, sample_rate_hz: float) -> float:
    """Return the period of the strongest oscillation.

    Raises
    ------
    DataError
        If no line stands out of the spectrum, or the record is sampled too slowly for the one
        that does (aliasing).
    """
    lines = spectrum(values, sample_rate_hz)
    top, usual = float(lines.amplitude[1:].max()), float(np.median(lines.amplitude))
    if not top > LINE_OVER_MEDIAN * usual:
        raise DataError(
            f"{where}: the strongest line is {top / max(usual, 1e-300):.2g} times the median one "
            f"(at least {LINE_OVER_MEDIAN:g}); nothing swings: choose another channel, or release "
            "from further out"
        )
    period = 1.0 / lines.peak_hz(1.5 * sample_rate_hz / values.size)
    check_sampling(where, lines, sample_rate_hz, period)
    return period


def check_sampling(where: str, lines: Spectrum, sample_rate_hz: float, period_s: float) -> None:
    """Refuse a record that is, or may be, sampled too slowly.

    Raises
    ------
    DataError
        Under five samples a period, or with a line at half the rate, a tenth of the strongest or
        more; noise that stands there is none.
    """
    samples = period_s * sample_rate_hz
    highest = float(lines.amplitude[lines.frequency_hz > 0.45 * sample_rate_hz].max())
    share = highest / float(lines.amplitude[1:].max())
    is_line = highest > LINE_OVER_MEDIAN * float(np.median(lines.amplitude))
    if samples < FEWEST_SAMPLES_A_PERIOD or (is_line and share > ALIASED_SHARE):
        raise DataError(
            f"{where}: {samples:.2g} samples a period of {period_s:.3g} s (at least "
            f"{FEWEST_SAMPLES_A_PERIOD:g}), and {100 * share:.0f} % of the strongest line stands "
            f"at half the sample rate (limit {100 * ALIASED_SHARE:g} %): aliasing; a faster motion "
            f"looks slow at {sample_rate_hz:g} Hz: sample faster"
        )


@dataclass(frozen=True)
class Series:
    """A signal, evenly sampled or with stamps of its own.

    Attributes
    ----------
    sample_rate_hz
        The mean rate where there are stamps.
    values
        Shape ``(samples,)`` in ``unit``; NaN where a sample is missing.
    flags
        What the reader and this package noticed.
    stamps_s
        Times of samples that are not evenly spaced, shape ``(samples,)``; ``None`` where they are.
    """

    name: str
    channel: str
    unit: str
    sample_rate_hz: float
    start_s: float
    values: FloatArray
    flags: tuple[Flag, ...] = ()
    stamps_s: FloatArray | None = None

    @property
    def time_s(self) -> FloatArray:
        """Times of the samples, shape ``(samples,)``."""
        if self.stamps_s is not None:
            return self.stamps_s
        return np.asarray(self.start_s + np.arange(self.values.size) / self.sample_rate_hz)

    def roughly_even(self) -> "Series":
        """Return the signal on the even grid of its mean rate, to find the way about in it.

        Straight lines join the samples, and longer gaps are NaN: nothing is measured there.
        """
        if self.stamps_s is None:
            return self
        good = np.isfinite(self.values)
        stamps_s, size = self.stamps_s[good], self.values.size
        grid_s = self.start_s + np.arange(size) / self.sample_rate_hz
        values = np.interp(grid_s, stamps_s, self.values[good])
        after = np.clip(np.searchsorted(stamps_s, grid_s), 1, stamps_s.size - 1)
        lost = np.diff(stamps_s)[after - 1] * self.sample_rate_hz > _BRIDGED
        return replace(self, values=np.where(lost, np.nan, values), stamps_s=None)

    @property
    def where(self) -> str:
        """Name of record and channel, for messages."""
        return f"{self.name}, {self.channel}"


@dataclass(frozen=True)
class UsablePart:
    """The stretch between release and dying out.

    Attributes
    ----------
    series
        That stretch.
    period_s
        Rough period of the strongest oscillation.
    first_amplitude, last_amplitude
        At its ends, in the record's unit.
    noise_rms
        Standard deviation of what changes from sample to sample.
    floor
        Amplitude at which the record is taken to have died out.
    reason
        In words, why it starts and ends there.
    """

    series: Series
    period_s: float
    first_amplitude: float
    last_amplitude: float
    noise_rms: float
    floor: float
    reason: str

    def cut(self, start_s: float, stop_s: float, because: str) -> "UsablePart":
        """Return the stretch from ``start_s`` to ``stop_s``, and in words why."""
        chosen = cut(self.series, start_s, stop_s)
        size = max(round(self.period_s * chosen.sample_rate_hz), 4)
        envelope = envelope_of(chosen.roughly_even().values, size)
        first, last = end_amplitudes(envelope, 0, envelope.size, size)
        return replace(
            self, series=chosen, first_amplitude=first, last_amplitude=last, reason=because
        )


def series_from_recording(recording: Recording, channel: str) -> Series:
    """Take one channel of a recording.

    Raises
    ------
    DataError
        If there is no such channel, it has no finite sample, or its unit is not one that a swinging
        body shows (angle, displacement, rate, acceleration, volts).
    """
    unit = recording.channels[recording.index(channel)].unit
    if unit not in (*SWINGING_UNITS, "", "1"):
        raise DataError(
            f"{recording.name}: channel {channel!r} is in {unit}; a free oscillation is read from "
            f"one of {', '.join(SWINGING_UNITS)}: choose another channel"
        )
    values = np.asarray(recording.values(channel), dtype=np.float64)
    if not np.isfinite(values).any():
        raise DataError(f"{recording.name}: channel {channel!r} has no finite sample")
    flags = tuple(
        flag
        for flag in recording.flags
        if flag.channel in (None, channel) and flag.code not in _LEFT_OUT
    )
    return Series(
        recording.name,
        channel,
        unit,
        recording.sample_rate_hz,
        recording.start_s,
        values,
        flags,
        recording.stamps_s,
    )


def cut(series: Series, start_s: float, stop_s: float) -> Series:
    """Return the samples from ``start_s`` to ``stop_s``, both included."""
    rate, stamps_s = series.sample_rate_hz, series.stamps_s
    ends = sample_numbers(np.array([start_s, stop_s]), series.start_s, rate, stamps_s)
    first = max(int(np.ceil(ends[0] - 1e-6)), 0)
    last = min(int(np.floor(ends[1] + 1e-6)), series.values.size - 1)
    values = series.values[first : last + 1]
    if stamps_s is None:
        return replace(series, start_s=series.start_s + first / rate, values=values)
    kept_s = stamps_s[first : last + 1]
    rate = (kept_s.size - 1) / float(np.ptp(kept_s)) if kept_s.size > 1 else rate
    return replace(
        series, start_s=float(kept_s[0]), values=values, sample_rate_hz=rate, stamps_s=kept_s
    )


def usable_part(series: Series) -> UsablePart:
    """Find the free oscillation: after the release, before it dies out.

    The amplitude over one period is followed through the record. The stretch starts at the first
    whole period after the amplitude is at its largest and ends where it falls below 3 % of that or
    three times the noise. Missing samples are left out of the fits; a gap of more than half a
    period gets a flag.

    Raises
    ------
    DataError
        If nothing swings above the noise, or it is sampled too slowly (aliasing).
    """
    rough = series.roughly_even().values
    period = rough_period(series.where, rough, series.sample_rate_hz)
    size = max(round(period * series.sample_rate_hz), 4)
    noise = noise_of(series.values, series.stamps_s)
    envelope = envelope_of(rough, size)
    top = float(np.nanmax(envelope))
    floor = max(DIED_OUT * top, ABOVE_NOISE * noise)
    if not top > floor:
        raise DataError(
            f"{series.where}: the largest amplitude is {top:.3g} {series.unit} over a noise of "
            f"{noise:.3g}; nothing swings: choose another channel, or release from further out"
        )
    first = release(rough, envelope, size, top, noise)
    after = np.flatnonzero(np.nan_to_num(envelope[first:], nan=np.inf) < floor)
    last = first + int(after[0]) if after.size else rough.size - 1
    start_s, stop_s = (series.start_s + k / series.sample_rate_hz for k in (first, last))
    chosen = cut(series, start_s, stop_s)
    how = "falls below the limit" if after.size else "is still there at the record's end"
    because = (
        f"from {start_s:.7g} s (after the largest swing, {top:.3g} {series.unit}) to "
        f"{stop_s:.7g} s (the amplitude {how}: {floor:.2g} {series.unit})"
    )
    flags = _gap_flags(chosen.roughly_even(), size)
    chosen = replace(chosen, flags=(*chosen.flags, *flags))
    ends = end_amplitudes(envelope, first, last, size)
    return UsablePart(chosen, period, *ends, noise, floor, because)


def _gap_flags(series: Series, size: int) -> tuple[Flag, ...]:
    missing = ~np.isfinite(series.values)
    count = int(missing.sum())
    if not count:
        return ()
    padded = np.concatenate(([False], missing, [False]))
    edges = np.flatnonzero(padded[1:] != padded[:-1]).reshape(-1, 2)
    longest = int((edges[:, 1] - edges[:, 0]).max()) / size
    severity = Severity.WARNING if longest > LONGEST_GAP_PERIODS else Severity.NOTE
    message = (
        f"{series.where}: {count} of {series.values.size} samples are missing, the longest gap is "
        f"{longest:.2g} periods (limit {LONGEST_GAP_PERIODS:g}); they are left out of the fits"
    )
    return (Flag("gaps", severity, message, series.channel),)
