"""An analysis as rows of numbers: one set of them for tables, pages and programs."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from hardware.description.dataset import GATE_OPENED
from hardware.description.flags import Flag
from pmm.document.labels import units_loads_first
from pmm.harmonics.classic_rows import ClassicRow, classic_rows
from pmm.harmonics.response_rows import ResponseRows, response_rows

if TYPE_CHECKING:
    from analysis.resolver.analysis import Analysis
    from analysis.resolver.harmonics import Harmonics

# Of a channel's largest value: what is as small is left by the arithmetic.
_ROUNDING = 1e-12
# An amplitude this many times its half-width is no play of the noise.
_SIGNIFICANT = 2.0


@dataclass(frozen=True)
class Value:
    """A number and the half-width of its interval; NaN where there is no interval."""

    value: float
    half_width: float


def floored(value: float, half_width: float, size: float) -> tuple[float, float]:
    """Return a value and its half-width without the play of rounding.

    Parameters
    ----------
    size
        Largest value of the channel: no half-width is narrower than 1e-12 of it, and a value that
        is smaller is 0.
    """
    floor = _ROUNDING * size
    return 0.0 if abs(value) < floor else value, max(half_width, floor)


@dataclass(frozen=True)
class HarmonicRow:
    """One harmonic of one channel: ``amplitude * sin(order * theta + phase)``."""

    order: int
    in_phase: Value
    quadrature: Value
    amplitude: Value
    phase_deg: Value

    @property
    def is_significant(self) -> bool:
        """Whether the amplitude is at least twice its half-width, and so surely not noise."""
        return self.amplitude.value >= _SIGNIFICANT * self.amplitude.half_width


@dataclass(frozen=True)
class ChannelRows:
    """Mean, drift taken out, and harmonics of one channel."""

    name: str
    unit: str
    mean: Value
    drift_per_s: float
    harmonics: tuple[HarmonicRow, ...]

    @property
    def size(self) -> float:
        """Largest value of the channel that the rows tell of."""
        return max(abs(self.mean.value), *(row.amplitude.value for row in self.harmonics))


@dataclass(frozen=True)
class GateRows:
    """One gate: where it lies, what its intervals rest on, and its channels.

    It is gate ``number`` of ``count`` in the window of its channels.
    """

    number: int
    count: int
    opened_s: float
    closed_s: float
    periods: int
    frequency_hz: float
    estimator: str
    interval_source: str
    drift_source: str
    channels: tuple[ChannelRows, ...]
    flags: tuple[Flag, ...]


@dataclass(frozen=True)
class LetThrough:
    """Part of a vibration's amplitude that gets into harmonics 1 to N of the first gate."""

    frequency_hz: float
    parts: tuple[float, ...]


@dataclass(frozen=True)
class RunRows:
    """One recording.

    Attributes
    ----------
    samples, sample_rate_hz, duration_s
        Of each channel; the duration is from the first sample to the last.
    reference, reference_channel, reference_frequency_hz
        What told the phase; the channel is ``None`` for a photocell or a given frequency.
    window
        ``"found steady"``, ``"given"``, ``"run's gate"`` (run control had it) or ``"not steady"``
        (all periods were used).
    window_opened_s, window_closed_s, window_periods
        The periods that the gates were taken from; where channels have windows of their own, the
        first of them, and flags and gates tell the others.
    steady_tolerance
        Within which first harmonics keep in a steady stretch, relative to the usual amplitude.
    let_through, classic, response
        What was asked for besides, of the first gate.
    """

    file: str
    run: str
    samples: int
    sample_rate_hz: float
    duration_s: float
    reference: str
    reference_channel: str | None
    reference_frequency_hz: float
    window: str
    window_opened_s: float
    window_closed_s: float
    window_periods: int
    steady_tolerance: float
    gates: tuple[GateRows, ...]
    flags: tuple[Flag, ...]
    let_through: tuple[LetThrough, ...] = ()
    classic: tuple[ClassicRow, ...] = ()
    response: ResponseRows | None = None


def run_rows(
    analyses: "Sequence[Analysis]",
    *,
    file: str,
    level: float,
    vibrations_hz: Sequence[float] = (),
    classic: bool = False,
    response_to: str | None = None,
    lines: Sequence[int] = (),
) -> RunRows:
    """Turn the analyses of a recording into rows.

    Parameters
    ----------
    analyses
        One for each window that its channels have.
    file
        Where the recording came from.
    level
        Probability of the two-sided intervals.
    vibrations_hz
        Frequencies for which to tell what the first gate lets through.
    classic
        Whether to read the modes of 1963 too.
    response_to, lines
        Channel on which the others' response is wanted, and the harmonics that it was given; found
        where they are not stated.
    """
    analysis = analyses[0]
    steady, recording = analysis.steady_sums, analysis.recording
    return RunRows(
        file=file,
        run=recording.name,
        samples=recording.sample_count,
        sample_rate_hz=recording.sample_rate_hz,
        duration_s=recording.end_s - recording.start_s,
        reference=str(analysis.reference.source),
        reference_channel=analysis.reference.channel,
        reference_frequency_hz=analysis.reference.frequency_hz,
        window=window_kind(analysis),
        window_opened_s=float(steady.opened_s[0]),
        window_closed_s=float(steady.closed_s[-1]),
        window_periods=steady.period_count,
        steady_tolerance=analysis.settings.steady_tolerance,
        gates=tuple(
            gate_rows(reading, level, number, len(window.readings))
            for window in analyses
            for number, reading in enumerate(window.readings, 1)
        ),
        flags=tuple(dict.fromkeys(flag for window in analyses for flag in window.flags)),
        let_through=_let_through(analysis, vibrations_hz),
        classic=tuple(row for window in analyses for row in classic_rows(window))
        if classic
        else (),
        response=response_rows(analysis.readings[0], response_to, lines, level)
        if response_to is not None
        else None,
    )


def _let_through(analysis: "Analysis", frequencies_hz: Sequence[float]) -> tuple[LetThrough, ...]:
    from analysis.resolver.leakage import let_through

    if not frequencies_hz:
        return ()
    parts = let_through(analysis, np.array(frequencies_hz))
    return tuple(
        LetThrough(frequency_hz, tuple(row.tolist()))
        for frequency_hz, row in zip(frequencies_hz, parts, strict=True)
    )


def window_kind(analysis: "Analysis") -> str:
    """Return how the window was come by; see :class:`RunRows`."""
    if analysis.settings.opens_s is not None:
        opening = analysis.recording.provenance.get(GATE_OPENED)
        return "run's gate" if opening == repr(analysis.settings.opens_s) else "given"
    steady = all(flag.code != "not_steady" for flag in analysis.flags)
    return "found steady" if steady else "not steady"


def gate_rows(reading: "Harmonics", level: float, number: int = 1, count: int = 1) -> GateRows:
    """Turn one gate's harmonics into rows with intervals of some probability, loads first."""
    half_width = reading.half_width(level)
    factor = reading.coverage_factor(level)[1::2]
    along, across = reading.polar_uncertainty()
    polar = (factor * along, np.minimum(factor * across, math.pi))

    def harmonic(row: int, n: int) -> HarmonicRow:
        s, c = 1 + 2 * n, 2 + 2 * n
        coefficient = reading.coefficients[row]
        return HarmonicRow(
            order=n + 1,
            in_phase=Value(float(coefficient[s]), float(half_width[row, s])),
            quadrature=Value(float(coefficient[c]), float(half_width[row, c])),
            amplitude=Value(float(reading.amplitude[row, n]), float(polar[0][row, n])),
            phase_deg=Value(
                math.degrees(reading.phase_rad[row, n]), math.degrees(polar[1][row, n])
            ),
        )

    return GateRows(
        number=number,
        count=count,
        opened_s=reading.opened_s,
        closed_s=reading.closed_s,
        periods=reading.periods,
        frequency_hz=reading.frequency_hz,
        estimator=reading.estimator,
        interval_source=str(reading.interval_source),
        drift_source=str(reading.drift_source),
        channels=tuple(
            ChannelRows(
                name=name,
                unit=reading.units[row],
                mean=Value(float(reading.mean[row]), float(half_width[row, 0])),
                drift_per_s=float(reading.drift_per_s[row]),
                harmonics=tuple(harmonic(row, n) for n in range(reading.order)),
            )
            for row in units_loads_first(reading.units)
            for name in (reading.channel_names[row],)
        ),
        flags=reading.flags,
    )
