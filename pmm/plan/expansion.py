"""From the entries of a plan to runs: every combination of an entry's lists."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import product
from typing import Any, Final, NamedTuple

import numpy as np

from analysis.response.multisine import chirp, lines_of, multisine, with_strut_phases
from analysis.response.pure_rotation import pure_rotation
from hardware.description.errors import ConfigurationError
from hardware.description.kinds import Motion, RunKind
from hardware.description.known_loads import LoadDirection, LoadStep
from hardware.description.lines import Line
from hardware.description.oscillator import Oscillator
from hardware.description.setpoint import Medium, SetPoint
from pmm.plan.plan_tables import Defaults, PlanEntry, first_of
from pmm.plan.run_plan import RunPlan

Lists = Sequence[Sequence[Any]]
Combine = Callable[[Lists], Iterator[tuple[Any, ...]]]
# Of a plan: six weeks of six-minute runs. Each takes some kilobytes, and a line on every page.
MOST_RUNS = 10_000
_PHASED = (Motion.PITCH, Motion.YAW, Motion.YAW_DRIFT)


class _List(NamedTuple):
    """A list of an entry: a run's value where it is empty, and its letter in names of runs."""

    key: str
    absent: float = 0.0
    letter: str = ""


_LISTS: Final = (  # the last one is gone through fastest
    _List("speeds_m_s", letter="u"),
    _List("revolutions_hz", letter="n"),
    _List("heels_rad", letter="h"),
    _List("drifts_rad", letter="b"),
    _List("rudder_angles_rad", letter="d"),
    _List("radii_m", math.inf, "c"),
    _List("releases_rad", letter="k"),
    _List("strut_phases_rad", math.nan, "p"),
    _List("amplitudes_m"),
    _List("frequencies_hz"),
)


def strut_phase_of(
    motion: Motion, frequency_hz: float, speed_m_s: float, half_spacing_m: float
) -> float:
    """Return the strut phase in radians that makes a motion by its name.

    0 for heave and sway. For pitch and yaw ``tan(phi / 2) = omega l / U``, with which the angle of
    attack stays zero (``docs/conventions.md``): pi at zero speed.
    """
    if motion not in _PHASED:
        return 0.0
    return 2.0 * math.atan2(2.0 * math.pi * frequency_hz * half_spacing_m, speed_m_s)


def all_of(lists: Lists) -> Iterator[tuple[Any, ...]]:
    """Yield all combinations of lists, the last fastest."""
    return product(*lists)


def snake(lists: Lists) -> Iterator[tuple[Any, ...]]:
    """Yield all combinations of lists, the last fastest, each list there and back again.

    From each combination to the next a single list moves on, by one step (a reflected Gray code).
    """
    if not lists:
        yield ()
        return
    back = False
    for head in lists[0]:
        rest = list(snake(lists[1:]))
        for tail in reversed(rest) if back else rest:
            yield (head, *tail)
        back = not back


def expand(
    entry: PlanEntry,
    defaults: Defaults,
    oscillator: Oscillator,
    channels: Sequence[str],
    combine: Combine,
) -> list[RunPlan]:
    """Return the runs of an entry.

    Parameters
    ----------
    channels
        The rig's force channels, for loads on all of them.
    combine
        :func:`all_of` or :func:`snake`: how the lists are gone through.
    """
    if entry.kind in (RunKind.CHECK_WEIGHT, RunKind.PUSH):
        return _loads(entry, defaults, channels)
    repeats = range(1, 1 + first_of(entry.repeats, defaults.repeats))
    if entry.kind is RunKind.RESTORING and not entry.frequencies_hz:
        entry = replace(entry, frequencies_hz=(oscillator.frequency_hz.low,))
    lists = [getattr(entry, listed.key) or (listed.absent,) for listed in _LISTS]
    return [
        _run(entry, defaults, oscillator, combination) for combination in combine([repeats, *lists])
    ]


def single_entries(entry: PlanEntry, defaults: Defaults) -> Iterator[PlanEntry]:
    """Yield for each run of an oscillation's entry, in the order of :func:`expand`, its own."""
    keys = [listed.key for listed in _LISTS if getattr(entry, listed.key)]
    for _ in range(first_of(entry.repeats, defaults.repeats)):
        for values in all_of([getattr(entry, key) for key in keys]):
            single: dict[str, Any] = {
                key: (value,) for key, value in zip(keys, values, strict=True)
            }
            yield replace(entry, repeats=1, **single)


def run_count(entry: PlanEntry, defaults: Defaults, channels: Sequence[str]) -> int:
    """Return how many runs :func:`expand` would make of an entry."""
    repeats = first_of(entry.repeats, defaults.repeats)
    if entry.kind in (RunKind.CHECK_WEIGHT, RunKind.PUSH):
        return repeats * len(entry.channels or channels) * len(entry.loads_n)
    return repeats * math.prod(max(1, len(getattr(entry, listed.key))) for listed in _LISTS)


def _run(
    entry: PlanEntry, defaults: Defaults, oscillator: Oscillator, combination: tuple[Any, ...]
) -> RunPlan:
    repeat, speed, rate, heel, drift, rudder, radius, release, phase, amplitude, frequency = (
        combination
    )
    motion = entry.motion or Motion.NONE
    if motion is not Motion.PHASE:
        phase = strut_phase_of(motion, frequency, speed, oscillator.half_spacing_m)
    in_air = entry.kind.in_air
    set_point = SetPoint(
        frequency,
        amplitude,
        phase,
        # In air the speed tells the strut phase of the run in water that it belongs to.
        0.0 if in_air else speed,
        Medium.AIR if in_air else entry.medium or Medium.WATER,
        drift,
        rudder,
        rate,
        heel,
        turn_rate_rad_s=speed / radius,
        release_rad=release,
        wave_frequency_hz=entry.wave_frequency_hz,
        wave_amplitude_m=entry.wave_amplitude_m,
        wave_heading_rad=entry.wave_heading_rad,
    )
    lines = _lines(entry, oscillator, set_point, speed)
    if lines:
        steady = entry.steady_ahead and motion in _PHASED
        set_point = replace(set_point, strut_phase_rad=0.0, lines=lines, steady_ahead=steady)
    return RunPlan(
        name=_name(entry, combination),
        kind=entry.kind,
        motion=motion,
        set_point=set_point,
        repeat=repeat,
        known_mass=entry.known_mass,
        prompts=(entry.prompt,) if entry.prompt else (),
        entry=entry.name or _prefix(entry),
        pause_before_s=first_of(entry.pause_s, defaults.pause_s),
        **_lengths(entry, defaults, oscillates=frequency > 0.0),
    )


def _lines(
    entry: PlanEntry, oscillator: Oscillator, point: SetPoint, speed_m_s: float
) -> tuple[Line, ...]:
    """Return the lines of a run: of the same strut velocity each, with the motion's strut phase.

    An exact run has those that make its rotation pure; heave and sway are pure as they are.
    """
    motion, half = entry.motion or Motion.NONE, oscillator.half_spacing_m
    if entry.exact and motion in _PHASED:
        try:
            return pure_rotation(
                oscillator,
                point.frequency_hz,
                speed_m_s,
                point.eccentricity_m,
                steady_ahead=entry.steady_ahead,
            )
        except ConfigurationError as error:
            raise ConfigurationError(f"{entry.name or _prefix(entry)}: exact: {error}") from error
    shape = _shape(entry)
    phases = [
        point.strut_phase_rad
        if motion is Motion.PHASE
        else strut_phase_of(motion, line.order * point.frequency_hz, speed_m_s, half)
        for line in shape
    ]
    return with_strut_phases(shape, phases)


def _shape(entry: PlanEntry) -> tuple[Line, ...]:
    """Return the lines of one strut, whatever the other does."""
    if entry.sweep:
        return chirp(*entry.sweep)
    if entry.recorded:
        highest = min(entry.highest, (len(entry.recorded) - 1) // 2)
        return lines_of(np.array(entry.recorded), highest)
    return multisine(entry.lines, 1.0 / np.array(entry.lines)) if entry.lines else ()


def _lengths(entry: PlanEntry, defaults: Defaults, *, oscillates: bool) -> dict[str, Any]:
    """Return how long a run takes: its periods, or its duration."""
    if not oscillates:
        return {"duration_s": first_of(entry.duration_s, defaults.duration_s)}
    periods = first_of(entry.periods, defaults.periods)
    target = first_of(entry.target_relative, defaults.target_relative)
    most = first_of(entry.max_periods, defaults.max_periods)
    return {
        "periods": periods,
        "settling_periods": first_of(entry.settling_periods, defaults.settling_periods),
        "target_relative": target,
        "max_periods": periods if target is None or most is None else most,
    }


def _prefix(entry: PlanEntry) -> str:
    if entry.kind is RunKind.OSCILLATION and entry.motion is not None:
        return str(entry.motion)
    return f"{entry.kind}-{entry.motion}" if entry.motion else str(entry.kind)


def _name(entry: PlanEntry, combination: tuple[Any, ...]) -> str:
    """Return ``heave-f0.5-a20-u1.2-r2``: mm and degrees; what the entry does not vary is left out.

    Frequency and amplitude always stand there.
    """
    repeat, *values = combination
    amplitude, frequency = values[-2:]
    parts = [entry.name or _prefix(entry)]
    if frequency and entry.kind is not RunKind.CONTROL:
        parts += [f"f{frequency:g}", f"a{1e3 * amplitude:.6g}"]
    parts += [
        f"{its.letter}{math.degrees(value) if its.key.endswith('_rad') else value:g}"
        for its, value in zip(_LISTS, values, strict=True)
        if its.letter and len(getattr(entry, its.key)) > 1
    ]
    if entry.wave_frequency_hz:
        parts.append(f"w{entry.wave_frequency_hz:g}")
    if repeat > 1:
        parts.append(f"r{repeat}")
    return "-".join(parts)


def _loads(entry: PlanEntry, defaults: Defaults, channels: Sequence[str]) -> list[RunPlan]:
    """Return load steps up and down again, or one push, for each channel and repeat."""
    steps = [(load, LoadDirection.UP) for load in entry.loads_n]
    if entry.kind is RunKind.CHECK_WEIGHT:
        steps += [(load, LoadDirection.DOWN) for load in entry.loads_n[-2::-1]]
    runs = []
    for repeat in range(1, 1 + first_of(entry.repeats, defaults.repeats)):
        for channel in entry.channels or channels:
            for number, (load, direction) in enumerate(steps, 1):
                step = LoadStep(channel, load, direction)
                runs.append(_loaded(entry, defaults, step, repeat, number))
    return runs


def _loaded(
    entry: PlanEntry, defaults: Defaults, step: LoadStep, repeat: int, number: int
) -> RunPlan:
    parts = [entry.name or _prefix(entry), step.channel]
    if entry.kind is RunKind.CHECK_WEIGHT:
        parts.append(f"{number:02d}-{step.force_n:g}n")
    if repeat > 1:
        parts.append(f"r{repeat}")
    return RunPlan(
        name="-".join(parts),
        kind=entry.kind,
        motion=Motion.NONE,
        set_point=SetPoint(0.0, 0.0, medium=entry.medium or Medium.WATER),
        duration_s=first_of(entry.duration_s, defaults.duration_s),
        pause_before_s=first_of(entry.pause_s, defaults.pause_s),
        repeat=repeat,
        load=step,
        prompts=(entry.prompt,) if entry.prompt else (),
        entry=entry.name or _prefix(entry),
    )
