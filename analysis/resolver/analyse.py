"""A recording in, readings out: the reference, the steady stretch, its gates resolved."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from analysis.recording import Recording
from analysis.resolver.checks import gate_flags
from analysis.resolver.estimate import PeriodValues, resolve, solve_periods
from analysis.resolver.hann import resolve_hann
from analysis.resolver.harmonics import Harmonics
from analysis.resolver.photocell import from_photocell
from analysis.resolver.reference import PhaseReference, from_encoder, from_frequency
from analysis.resolver.signal_reference import from_signal
from analysis.resolver.steady import Stretch, find_steady
from analysis.resolver.sums import PeriodSums, period_sums, whole_periods
from hardware.description.channels import DISPLACEMENT_AFT, SHAFT_ANGLE
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.flags import Flag, Severity

FloatArray = NDArray[np.float64]

_ENOUGH_STEADY = 3  # periods: a shorter stretch is no stretch


@dataclass(frozen=True)
class ReferenceChoice:
    """What tells the phase; at most one of the first two, else the recording's own best.

    The order is photocell, encoder (channel ``shaft_angle``), displacement of the aft strut, the
    set-point's frequency.

    Attributes
    ----------
    channel
        A channel whose fundamental is the reference; ``shaft_angle`` is read as an encoder.
    frequency_hz
        A known frequency, with phase 0 at the first sample.
    latency_s, angle_offset_rad
        Calibration of the photocell, or the offset of the encoder.
    """

    channel: str | None = None
    frequency_hz: float | None = None
    latency_s: float = 0.0
    angle_offset_rad: float = 0.0


@dataclass(frozen=True)
class Settings:
    """How to analyse a recording.

    Attributes
    ----------
    channels
        Which channels, in order; all of them if empty.
    gate_periods
        Periods of each gate; ``None`` takes the whole stretch as one gate.
    opens_s
        Open the first gate at this very time instead of finding where the run is steady.
    periods
        Number of periods from ``opens_s`` on; all that follow if ``None``.
    steady_tolerance
        See :func:`analysis.resolver.steady.find_steady`.
    hann
        Taper each gate (:mod:`analysis.resolver.hann`): for long gates with interference.
    """

    channels: tuple[str, ...] = ()
    harmonics: int = 3
    gate_periods: int | None = None
    opens_s: float | None = None
    periods: int | None = None
    steady_tolerance: float = 0.05
    take_out_drift: bool = True
    hann: bool = False


@dataclass(frozen=True)
class Analysis:
    """Everything found about one recording.

    Attributes
    ----------
    sums
        Of all whole periods that were summed; ``stretch`` says which of them were used.
    readings
        One per gate, in time order.
    """

    recording: Recording
    reference: PhaseReference
    settings: Settings
    sums: PeriodSums
    stretch: Stretch
    readings: tuple[Harmonics, ...]
    flags: tuple[Flag, ...]

    @property
    def steady_sums(self) -> PeriodSums:
        """The periods of the stretch."""
        return self.sums[self.stretch.start : self.stretch.stop]


def choose_reference(recording: Recording, choice: ReferenceChoice) -> PhaseReference:
    """Build the reference that was asked for, or the best one that the recording has.

    Raises
    ------
    DataError
        If it cannot be had; the message says what was looked for.
    ConfigurationError
        If two are asked for.
    """
    if choice.channel is not None and choice.frequency_hz is not None:
        raise ConfigurationError("give a reference channel or a frequency, not both")
    if choice.channel is not None:
        return _from_channel(recording, choice.channel, choice.angle_offset_rad)
    if choice.frequency_hz is not None:
        return _from_frequency(recording, choice.frequency_hz)
    if recording.photocell_edges_s is not None and len(recording.photocell_edges_s):
        return from_photocell(
            recording.photocell_edges_s,
            latency_s=choice.latency_s,
            angle_offset_rad=choice.angle_offset_rad,
        )
    for name in (SHAFT_ANGLE.name, DISPLACEMENT_AFT.name):
        if name in recording.channel_names:
            return _from_channel(recording, name, choice.angle_offset_rad)
    if recording.set_point is not None:
        return _from_frequency(recording, recording.set_point.frequency_hz)
    raise DataError(
        f"{recording.name}: no reference found: no photocell edges, no channel "
        f"{SHAFT_ANGLE.name!r} or {DISPLACEMENT_AFT.name!r}, no set-point; give the frequency or "
        f"name a reference channel (channels: {', '.join(recording.channel_names)})"
    )


def _from_channel(recording: Recording, name: str, angle_offset_rad: float) -> PhaseReference:
    if name == SHAFT_ANGLE.name:
        return from_encoder(recording.time_s(), recording.values(name), angle_offset_rad)
    return from_signal(recording, name)


def _from_frequency(recording: Recording, frequency_hz: float) -> PhaseReference:
    return from_frequency(frequency_hz, recording.start_s, recording.end_s)


def analyse(
    recording: Recording,
    choice: ReferenceChoice = ReferenceChoice(),
    settings: Settings = Settings(),
) -> Analysis:
    """Resolve a recording.

    Raises
    ------
    DataError
        If a channel or the reference is missing, or less than one whole period is left.
    ConfigurationError
        If the settings contradict each other.
    """
    _check(settings)
    reference = choose_reference(recording, choice)
    chosen = recording.select(settings.channels) if settings.channels else recording
    edges = _edges(chosen, reference, settings)
    sums = period_sums(chosen, reference, settings.harmonics, edges_cycles=edges)
    values = solve_periods(sums)
    stretch, flags = _stretch(chosen, values, settings)
    steady = sums[stretch.start : stretch.stop]
    size = settings.gate_periods or steady.period_count
    if size > steady.period_count:
        raise DataError(
            f"{recording.name}: a gate of {size} periods does not fit the steady stretch of "
            f"{steady.period_count} ({steady.opened_s[0]:.3f} s to {steady.closed_s[-1]:.3f} s)"
        )
    gates = [steady[k : k + size] for k in range(0, steady.period_count - size + 1, size)]
    readings = tuple(_reading(chosen, reference, gate, steady, settings) for gate in gates)
    return Analysis(
        chosen,
        reference,
        settings,
        sums,
        stretch,
        readings,
        recording.flags + reference.flags + flags,
    )


def _check(settings: Settings) -> None:
    for name in ("harmonics", "gate_periods", "periods"):
        value = getattr(settings, name)
        if value is not None and value < 1:
            raise ConfigurationError(f"{name} = {value} makes no sense; it must be 1 or more")
    if settings.periods is not None and settings.opens_s is None:
        raise ConfigurationError("a number of periods needs the time at which the gate opens")


def _edges(recording: Recording, reference: PhaseReference, settings: Settings) -> FloatArray:
    if settings.opens_s is None:
        return whole_periods(recording, reference)
    if not recording.start_s <= settings.opens_s <= recording.end_s:
        raise DataError(
            f"{recording.name}: the gate cannot open at {settings.opens_s:g} s; the record runs "
            f"from {recording.start_s:.3f} s to {recording.end_s:.3f} s"
        )
    first = float(reference.cycles_at(np.array([settings.opens_s]))[0])
    edges = whole_periods(recording, reference, first)
    edges = edges[edges >= first - 1e-9]
    count = len(edges) - 1 if settings.periods is None else settings.periods
    if not 1 <= count < len(edges):
        raise DataError(
            f"{recording.name}: {max(len(edges) - 1, 0)} whole periods follow "
            f"{settings.opens_s:g} s, but {max(count, 1)} are asked for"
        )
    return edges[: count + 1]


def _stretch(
    recording: Recording, values: PeriodValues, settings: Settings
) -> tuple[Stretch, tuple[Flag, ...]]:
    """The steady periods; all of them where they were given, or where none are steady."""
    everything = Stretch(0, len(values.ramp), 0.0, 0)
    if settings.opens_s is not None:
        return everything, ()
    found = find_steady(values, settings.steady_tolerance)
    if found.period_count >= min(_ENOUGH_STEADY, len(values.ramp)):
        return found, ()
    everything = replace(everything, spread=found.spread, channel=found.channel)
    message = (
        f"no {_ENOUGH_STEADY} periods keep within {100.0 * settings.steady_tolerance:g} % of each "
        f"other in every channel; all {len(values.ramp)} periods were used. Choose fewer channels, "
        "a wider tolerance, or say when the gate opens"
    )
    name = recording.channel_names[found.channel]
    return everything, (Flag("not_steady", Severity.WARNING, message, name),)


def _reading(
    recording: Recording,
    reference: PhaseReference,
    gate: PeriodSums,
    steady: PeriodSums,
    settings: Settings,
) -> Harmonics:
    drifting = settings.take_out_drift
    if settings.hann:
        edges = np.append(gate.opened_cycle, gate.opened_cycle[-1] + 1.0)
        result = resolve_hann(
            recording, reference, edges, settings.harmonics, take_out_drift=drifting
        )
    else:
        around = steady if steady.period_count > gate.period_count else None
        result = resolve(recording, gate, around=around, take_out_drift=drifting)
    return replace(result, flags=gate_flags(gate, result))
