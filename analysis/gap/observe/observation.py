"""A recording in, everything that the diagnosis compares out.

Harmonics come from the resolver. What does not repeat with the shaft shows in the rest: trends of
mean and harmonics from the first cycles to the last, scatter of the photocell's intervals and of
the harmonics from cycle to cycle, and power between the harmonics. That takes samples on a grid:
where each has a time of its own, cycles are not alike and lines leak, and it is not looked for.
"""

from collections.abc import Iterator, Set
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from analysis.gap.observe.bands import TAKEN_OUT, band, between_harmonics
from analysis.gap.observe.components import TRENDS, Component, Observation, Part
from analysis.gap.observe.phase import choose_phase
from analysis.gap.observe.plateau import Plateau, plateau, steps_of
from analysis.gap.observe.pulses import scatter_of_pulses
from analysis.gap.observe.shaft_angle import turns_per_period, unwrapped
from analysis.gap.observe.spectrum import Lines, quiet_lines, repeating
from analysis.recording import Recording
from analysis.resolver.analysis import Analysis, analyse
from analysis.resolver.period_values import solve_periods, usable
from analysis.resolver.reference import ReferenceSource
from analysis.resolver.reference_choice import ReferenceChoice
from analysis.resolver.settings import ResolverSettings
from hardware.description.arrays import FloatArray
from hardware.description.channels import CARRIAGE_SPEED, DISPLACEMENTS, FORCES, SHAFT_ANGLE
from hardware.description.errors import DataError

Found = Iterator[tuple[Component, float, float]]
Moving = tuple[str, ...]

ORDERS: Final = 6
SPEED: Final = CARRIAGE_SPEED.name
COMPARED: Final = (SHAFT_ANGLE.name, *DISPLACEMENTS, *FORCES, SPEED)

# Whose change and scatter from cycle to cycle are looked at.
CYCLED: Final = (1, 2)
# Bands between the harmonics, in multiples of the fundamental, by number: among the orders that are
# compared and below them, and above.
BANDS: Final = {1: (0.0, ORDERS + 0.8), 2: (ORDERS + 1.2, np.inf)}
# Of the carriage's speed, which has no harmonics: waves of the whole tank, rails, wheels.
SURGES_HZ: Final = (0.0, 3.0)
_FEW_PERIODS = 3
_TRENDS: Final = frozenset(TRENDS)
_SCATTERS: Final = frozenset({Part.PERIOD_SCATTER, Part.CYCLE_SCATTER})
_BETWEEN: Final = frozenset({Part.BETWEEN, Part.LINE, Part.MAINS})


@dataclass(frozen=True, eq=False)
class Observed:
    """One recording's observation and what it was made of."""

    observation: Observation
    analysis: Analysis

    @property
    def lead_s(self) -> float:
        """Time from the beginning of the record to the whole periods that were analysed."""
        began_s = float(self.analysis.recording.time_s()[0])
        return float(self.analysis.steady_sums.opened_s[0]) - began_s

    @property
    def reference_channel(self) -> str | None:
        """The channel whose fundamental is phase 0; ``None`` where pulses or the like tell it."""
        channel = self.analysis.reference.channel
        return channel if channel in COMPARED else None


def observe(
    recording: Recording,
    reference: ReferenceChoice = ReferenceChoice(),
    window: ResolverSettings = ResolverSettings(),
    *,
    wanted: Set[Part] | None = None,
) -> Observed:
    """Return what a recording shows.

    Parameters
    ----------
    reference
        What tells the phase (:func:`analysis.gap.observe.phase.choose_phase`).
    window
        Where the gate opens and for how long, how steady it has to be; channels, orders and the
        gates' length are the diagnosis' own.
    wanted
        What will be compared, beside means and harmonics, by its values alone; the rest need not be
        looked for. ``None`` for all, with its uncertainty, and for the noise of each channel and
        what a recording of a rig may have wrong.

    Raises
    ------
    DataError
        If the recording has no force, or too few whole periods without missing samples.
    """
    names = tuple(name for name in COMPARED if name in recording.channel_names)
    if not set(names) & set(FORCES):
        raise DataError(
            f"{recording.name}: no channel {' or '.join(FORCES)}; the diagnosis compares forces"
        )
    continuous = unwrapped(recording)
    phased, choice = choose_phase(continuous, reference)
    channels = tuple(name for name in names if name != choice.channel or name in FORCES)
    settings = replace(window, channels=channels, harmonics=_orders(recording), gate_periods=None)
    analysis = analyse(phased, choice, settings, intervals=wanted is None)
    _check_periods(analysis)
    moving = _moving(analysis)
    entries = [*_harmonics(analysis, moving), *_frequency(analysis, recording)]
    timed = phased is continuous and analysis.reference.source is ReferenceSource.PHOTOCELL
    entries += _pulses(recording) if timed else ()
    even = recording.stamps_s is None
    if even and analysis.stretch.period_count >= _FEW_PERIODS:
        makers = (
            (_TRENDS, _trends(analysis, moving)),
            (_SCATTERS, _scatter(analysis, moving, timed=timed)),
            (_BETWEEN, _band_powers(analysis, moving)),
            (_BETWEEN, _surges(analysis, moving)),
        )
        for parts_made, made in makers:
            entries += made if wanted is None or wanted & parts_made else ()
    # Cycles with missing samples have no trend and no scatter, and records with some no spectrum.
    parts, values, uncertainty = zip(
        *(entry for entry in entries if np.isfinite(entry[1])), strict=True
    )
    observation = Observation(parts, np.array(values), np.array(uncertainty))
    if wanted is None:
        steady, frequency_hz = _steady(analysis, recording), analysis.readings[0].frequency_hz
        observation = replace(
            observation,
            steps=steps_of(steady),
            quiet=_quiet_lines(analysis, moving) if even else {},
            plateaus=_plateaus(steady),
            turns_per_period=turns_per_period(steady, frequency_hz),
        )
    return Observed(observation, analysis)


def _moving(analysis: Analysis) -> tuple[str, ...]:
    """Return the channels that move; of the others the mean is all that there is."""
    part = _steady(analysis)
    ranges = {name: part.values(name) for name in analysis.readings[0].channel_names}
    return tuple(name for name, values in ranges.items() if np.nanmax(values) > np.nanmin(values))


def _check_periods(analysis: Analysis) -> None:
    count, complete = analysis.stretch.period_count, usable(analysis.steady_sums).period_count
    if complete < min(count, _FEW_PERIODS):
        raise DataError(
            f"{analysis.recording.name}: {complete} of {count} whole periods have no missing "
            f"samples; {_FEW_PERIODS} are needed"
        )


def _orders(recording: Recording) -> int:
    """Return as many orders as the sampling resolves, at most ORDERS."""
    if recording.set_point is None:
        return ORDERS
    return max(
        1, min(ORDERS, int(0.4 * recording.sample_rate_hz / recording.set_point.frequency_hz))
    )


def _harmonics(analysis: Analysis, moving: Moving) -> Found:
    reading = analysis.readings[0]
    deviation = reading.standard_uncertainty
    for row, name in enumerate(reading.channel_names):
        values, deviations = reading.coefficients[row], deviation[row]
        if name != SHAFT_ANGLE.name:  # its mean is a matter of counting turns
            yield Component(name, Part.MEAN), values[0], deviations[0]
        # The carriage does not go with the shaft; what varies shows among the lines.
        if name == SPEED or name not in moving:
            continue
        for order in range(1, reading.order + 1):
            for part, at in ((Part.IN_PHASE, 2 * order - 1), (Part.QUADRATURE, 2 * order)):
                yield Component(name, part, order), values[at], deviations[at]


def _frequency(analysis: Analysis, recording: Recording) -> Found:
    if recording.set_point is None:
        return
    reading = analysis.readings[0]
    ratio = float(np.log(reading.frequency_hz / recording.set_point.frequency_hz))
    # Pulses and samples are timed far better than this; it is the drive that does not keep time.
    yield Component("", Part.FREQUENCY), ratio, 2e-5


def _pulses(recording: Recording) -> Found:
    edges = recording.photocell_edges_s
    if edges is not None and len(edges) > _FEW_PERIODS:
        intervals = np.diff(edges)
        turns = float(np.sum(np.round(intervals / np.median(intervals))))
        yield Component("", Part.PULSES), 1.0 - len(intervals) / max(turns, 1.0), 0.02


def _trends(analysis: Analysis, moving: Moving) -> Found:
    """Yield how means and harmonics change from the first cycles to the last."""
    solved = solve_periods(analysis.steady_sums).coefficients
    for row, name in enumerate(analysis.steady_sums.channel_names):
        if name in FORCES and name in moving:
            yield Component(name, Part.TREND), *_slope(solved[:, row, 0])
            for order in _cycled(analysis):
                at = 2 * order - 1
                yield Component(name, Part.TREND_IN_PHASE, order), *_slope(solved[:, row, at])
                yield Component(name, Part.TREND_QUADRATURE, order), *_slope(solved[:, row, at + 1])


def _cycled(analysis: Analysis) -> list[int]:
    return [order for order in CYCLED if order <= analysis.readings[0].order]


def _slope(values: FloatArray) -> tuple[float, float]:
    """Return the change from one value to the next, and its standard deviation."""
    count = len(values)
    turn = np.arange(count) - (count - 1) / 2.0
    weight = turn / (turn @ turn)
    slope = float(weight @ values)
    remainder = values - values.mean() - slope * turn
    spread = np.sqrt(remainder @ remainder / max(count - 2, 1))
    return slope, float(spread * np.sqrt(weight @ weight))


def _scatter(analysis: Analysis, moving: Moving, *, timed: bool) -> Found:
    sums = analysis.steady_sums
    freedom = max(sums.period_count - 2, 1)
    sure = float(np.sqrt(0.5 / freedom))
    if timed:
        pulses_s = np.append(sums.opened_s, sums.closed_s[-1])
        yield Component("", Part.PERIOD_SCATTER), *scatter_of_pulses(pulses_s)
    solved = solve_periods(sums).coefficients
    for row, name in enumerate(sums.channel_names):
        if name in FORCES and name in moving:
            for order in _cycled(analysis):
                parts = solved[:, row, 2 * order - 1 : 2 * order + 1]
                power = float(np.var(parts, axis=0, ddof=1).sum())
                part = Component(name, Part.CYCLE_SCATTER, order)
                yield part, 0.5 * float(np.log(power + 1e-12)), sure / np.sqrt(2.0)


def _steady(analysis: Analysis, recording: Recording | None = None) -> Recording:
    """Return the whole periods of a record that were analysed."""
    sums, record = analysis.steady_sums, recording or analysis.recording
    return record.between(float(sums.opened_s[0]), float(sums.closed_s[-1]))


def _band_powers(analysis: Analysis, moving: Moving) -> Found:
    part, frequency = _steady(analysis), analysis.readings[0].frequency_hz
    repeats = repeating(2.0 * np.pi * analysis.reference.cycles_at(part.time_s()), TAKEN_OUT)
    for name in moving:
        if name in FORCES:
            values = part.values(name)
            values = values - repeats @ (repeats.T @ values)
            yield from between_harmonics(name, values, part.sample_rate_hz, frequency, BANDS)


def _plateaus(part: Recording) -> dict[str, Plateau]:
    """Return what is cut off struts and forces, also of the channel that tells the phase."""
    names = [name for name in (*DISPLACEMENTS, *FORCES) if name in part.channel_names]
    return {name: plateau(part.values(name)) for name in names}


def _quiet_lines(analysis: Analysis, moving: Moving) -> dict[str, Lines]:
    """Return what lies between the harmonics of each channel."""
    part, reading = _steady(analysis), analysis.readings[0]
    names = [name for name in moving if np.isfinite(part.values(name)).all()]
    if not names:
        return {}
    values = np.stack([part.values(name) for name in names])
    lines = quiet_lines(part.time_s(), values, reading.frequency_hz, reading.order)
    return dict(zip(names, lines, strict=True))


def _surges(analysis: Analysis, moving: Moving) -> Found:
    if SPEED not in moving:
        return
    part = _steady(analysis)
    values, taper = part.values(SPEED), np.hanning(part.sample_count)
    power = np.abs(np.fft.rfft((values - values.mean()) * taper)) ** 2 / np.sum(taper**2)
    lines_hz = np.arange(len(power)) * part.sample_rate_hz / part.sample_count
    low, high = SURGES_HZ
    inside = (lines_hz > low) & (lines_hz < high)
    yield from band(SPEED, 0, power[inside] / len(lines_hz))
