"""Resolution of a recording: its phase reference, its steady stretch, harmonics of its gates."""

import cmath
import math
from dataclasses import dataclass, replace

import numpy as np

from analysis.recording import Recording
from analysis.resolver.checks import (
    coarse_flags,
    gate_flags,
    held_flags,
    reference_flags,
    saturation_flags,
)
from analysis.resolver.estimate import resolve
from analysis.resolver.frequency_checks import frequency_flags, pulse_flags
from analysis.resolver.hann import resolve_hann
from analysis.resolver.harmonics import Harmonics
from analysis.resolver.local_polynomial import resolve_local
from analysis.resolver.period_values import PeriodValues, solve_periods
from analysis.resolver.reference import NoReferenceError, PhaseReference, ReferenceSource
from analysis.resolver.reference_choice import ReferenceChoice, choose_reference
from analysis.resolver.set_point import set_point_flags
from analysis.resolver.settings import (
    ResolverSettings,
    check_opening,
    check_settings,
    with_own_gate,
)
from analysis.resolver.signal_reference import JUMP_CYCLES
from analysis.resolver.steady_stretch import Limit, Stretch, find_steady, limits
from analysis.resolver.sums import PeriodSums, period_sums, whole_periods
from hardware.description.arrays import FloatArray
from hardware.description.channels import SHAFT_ANGLE
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.flags import Flag, Severity

_ENOUGH_STEADY = 3  # periods: a shorter stretch is no stretch


@dataclass(frozen=True)
class Analysis:
    """The result of resolving one recording.

    Attributes
    ----------
    sums
        Of all whole periods that were summed; ``stretch`` says which of them were used.
    readings
        One per gate, in time order.
    """

    recording: Recording
    reference: PhaseReference
    settings: ResolverSettings
    sums: PeriodSums
    stretch: Stretch
    readings: tuple[Harmonics, ...]
    flags: tuple[Flag, ...]

    @property
    def steady_sums(self) -> PeriodSums:
        """The sums of the periods that the steady stretch has."""
        return self.sums[self.stretch.start : self.stretch.stop]


def analyse(
    recording: Recording,
    choice: ReferenceChoice = ReferenceChoice(),
    settings: ResolverSettings = ResolverSettings(),
    *,
    intervals: bool = True,
) -> Analysis:
    """Resolve a recording.

    Parameters
    ----------
    intervals
        Whether the harmonics' uncertainties are wanted.

    Raises
    ------
    DataError
        If a channel or the reference is missing, or less than one whole period is left.
    ConfigurationError
        If the settings contradict each other, or ask for what cannot be: a gate beyond the record
        or longer than the steady stretch, harmonics beyond the sampling.
    """
    check_settings(settings)
    stated_settings, settings = settings, with_own_gate(recording, settings)
    check_opening(recording, settings)
    fixed = stated_settings is settings
    stated_reference = _reference(recording, choice, settings, fixed=fixed)
    reference = stated_reference.delayed(settings.delay_s)
    names = settings.channels or _default_channels(recording, reference)
    chosen = recording.select(names).complete()
    edges = _edges(chosen, reference, settings, fixed=fixed)
    sums = period_sums(chosen, reference, settings.harmonics, edges_cycles=edges)
    values = solve_periods(sums)
    stretch, flags = _stretch(chosen, values, settings)
    within = slice(stretch.start, stretch.stop)
    steady, steady_values = sums[within], values[within]
    gates = _gates(chosen, steady, settings)
    readings = tuple(
        _reading(chosen, reference, gate, steady, settings, intervals=intervals) for gate in gates
    )
    return Analysis(
        chosen,
        reference,
        settings,
        sums,
        stretch,
        readings,
        recording.flags
        + reference.flags
        + set_point_flags(recording, reference, gates[0], readings[0])
        + frequency_flags(chosen.channel_names, values, reference)
        + pulse_flags(recording, reference, steady_values, readings[0])
        + flags
        + reference_flags(recording, stated_reference, steady, settings)
        + saturation_flags(chosen, float(steady.opened_s[0]), float(steady.closed_s[-1]))
        + held_flags(chosen, float(steady.opened_s[0]), float(steady.closed_s[-1]))
        + coarse_flags(chosen, float(steady.opened_s[0]), float(steady.closed_s[:5][-1])),
    )


def _gates(
    recording: Recording, steady: PeriodSums, settings: ResolverSettings
) -> list[PeriodSums]:
    """Return the gates, one after the other; the whole stretch where none is asked for."""
    size = settings.gate_periods or steady.period_count
    if size > steady.period_count:
        window = "steady stretch" if settings.opens_s is None else "window given"
        raise ConfigurationError(
            f"{recording.name}: a gate of {size} periods does not fit the {window} of "
            f"{steady.period_count} ({steady.opened_s[0]:.3f} s to {steady.closed_s[-1]:.3f} s)"
        )
    return [steady[k : k + size] for k in range(0, steady.period_count - size + 1, size)]


def _default_channels(recording: Recording, reference: PhaseReference) -> tuple[str, ...]:
    """All channels that have harmonics of interest."""
    left_out = (reference.channel, SHAFT_ANGLE.name)
    names = tuple(name for name in recording.channel_names if name not in left_out)
    if not names:
        raise DataError(
            f"{recording.name}: no channel is left beside the reference; name the one to resolve"
        )
    return names


def _reference(
    recording: Recording, choice: ReferenceChoice, settings: ResolverSettings, *, fixed: bool
) -> PhaseReference:
    """Return what tells the phase; a signal does so by what it shows within a given gate.

    Before and after the gate the shaft may start, stop or run at another speed.
    """
    reference = choose_reference(recording, choice, settings.opens_s)
    if settings.opens_s is None or reference.source is not ReferenceSource.SIGNAL:
        return reference
    at_once = replace(settings, delay_s=0.0)
    edges_s = reference.times_at(_edges(recording, reference, at_once, fixed=fixed))
    within = recording.between(float(edges_s[0]), float(edges_s[-1]))
    try:
        chosen = choose_reference(within, choice)
    except NoReferenceError:  # too few periods to be sure of by themselves
        return reference
    ends = chosen.cycles_at(edges_s[[0, -1]]) + np.array([-JUMP_CYCLES, JUMP_CYCLES])
    cycles = np.unique(np.concatenate((ends, chosen.cycles)))  # straight on to the gate's ends
    times_s = chosen.times_at(cycles)
    return replace(chosen, times_s=times_s, cycles=cycles, flags=reference.flags)


def _edges(
    recording: Recording, reference: PhaseReference, settings: ResolverSettings, *, fixed: bool
) -> FloatArray:
    """Return where periods begin and end; those of run control's own gate as far as they fit.

    That gate was counted with the phase that run control had; with another one a period more or
    less lies in it.
    """
    if settings.opens_s is None:
        return whole_periods(recording, reference)
    opens_s = settings.opens_s + settings.delay_s
    first = float(reference.cycles_at(np.array([opens_s]))[0])
    edges = whole_periods(recording, reference, first)
    edges = edges[edges >= first - 1e-9]
    count = len(edges) - 1 if settings.periods is None else settings.periods
    count = count if fixed else min(count, len(edges) - 1)
    if not 1 <= count < len(edges):
        raise ConfigurationError(
            f"{recording.name}: {max(len(edges) - 1, 0)} whole periods follow "
            f"{settings.opens_s:g} s, but {max(count, 1)} are asked for"
        )
    return edges[: count + 1]


def _stretch(
    recording: Recording, values: PeriodValues, settings: ResolverSettings
) -> tuple[Stretch, tuple[Flag, ...]]:
    """The steady periods; all of them where they were given, or where none are steady."""
    everything = Stretch(0, len(values.ramp), 0.0, 0)
    if settings.opens_s is not None:
        return everything, ()
    stretch = find_steady(values, settings.steady_tolerance)
    if stretch.period_count >= min(_ENOUGH_STEADY, len(values.ramp)):
        return stretch, _limit_flags(recording, values, stretch, settings)
    everything = replace(everything, spread=stretch.spread, channel=stretch.channel)
    message = (
        f"no {_ENOUGH_STEADY} periods in a row keep within {100.0 * settings.steady_tolerance:g} % "
        f"of the usual amplitude about their middle in every channel; all {len(values.ramp)} "
        "periods were used. Choose fewer channels, "
        "a wider tolerance, or say when the gate opens"
    )
    name = recording.channel_names[stretch.channel]
    return everything, (Flag("not_steady", Severity.WARNING, message, name),)


def _limit_flags(
    recording: Recording, values: PeriodValues, stretch: Stretch, settings: ResolverSettings
) -> tuple[Flag, ...]:
    """Say where one channel alone ends the steady stretch, and how far it strays there."""
    limits_of: dict[int, list[Limit]] = {}
    for limit in limits(values, stretch, settings.steady_tolerance):
        limits_of.setdefault(limit.channel, []).append(limit)
    return tuple(
        Flag(
            "stretch_limited",
            Severity.WARNING if any(limit.lasts for limit in met) else Severity.NOTE,
            f"this channel ends the steady stretch of {stretch.period_count} of {len(values.ramp)} "
            f"periods: it {' and '.join(_fault(limit, stretch) for limit in met)} (limit "
            f"{100.0 * settings.steady_tolerance:g} % of its usual amplitude)",
            recording.channel_names[channel],
        )
        for channel, met in limits_of.items()
    )


def _fault(limit: Limit, stretch: Stretch) -> str:
    """Say how a channel strays, and what it is beyond: lost samples turn it, a gain scales it."""
    side = "before" if limit.period < stretch.start else "after"
    missing = not np.isfinite(limit.spread)
    fault = "has missing samples" if missing else f"strays by {100.0 * limit.spread:.3g} %"
    text = f"{fault} in the period {side} it"
    if not limit.lasts:
        return text
    turn_deg = math.degrees(cmath.phase(limit.beyond))
    lost = ", as after lost or doubled samples" if limit.turned else ""
    return (
        f"{text} and, {'earlier' if side == 'before' else 'later'} than that, keeps to "
        f"{abs(limit.beyond):.3g} times its amplitude, turned by {turn_deg:.3g} degrees against "
        f"the other channels{lost}; nothing tells which side is right"
    )


def _reading(
    recording: Recording,
    reference: PhaseReference,
    gate: PeriodSums,
    steady: PeriodSums,
    settings: ResolverSettings,
    *,
    intervals: bool,
) -> Harmonics:
    if settings.hann or settings.local_polynomials:
        result = resolve_by_bins(recording, reference, gate, settings)
    else:
        around = steady if steady.period_count > gate.period_count else None
        drifting = settings.take_out_drift
        result = resolve(
            recording, gate, around=around, take_out_drift=drifting, intervals=intervals
        )
    return replace(result, flags=gate_flags(gate, result))


def resolve_by_bins(
    recording: Recording, reference: PhaseReference, gate: PeriodSums, settings: ResolverSettings
) -> Harmonics:
    """Resolve a gate under a Hann taper or by local polynomials, as the settings say."""
    estimator = resolve_hann if settings.hann else resolve_local
    return estimator(
        recording,
        reference,
        gate.edges_cycles,
        settings.harmonics,
        take_out_drift=settings.take_out_drift,
    )
