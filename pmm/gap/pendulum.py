"""The records that a pendulum's file names, beside the simulation that is to explain them."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from analysis.gap.pendulum.causes import tolerance
from analysis.gap.pendulum.problem import PendulumProblem
from analysis.gap.pendulum.surrogate import surrogate
from analysis.gap.pendulum.swings import (
    Windows,
    cut_into_windows,
    scatter,
    swings_of_passages,
    swings_of_samples,
)
from analysis.gap.pendulum.trial import Trial
from analysis.inertia.gates import passages, read_gate_events
from analysis.inertia.series import UsablePart, series_from_recording, usable_part
from analysis.readers import read_recording
from analysis.readers.damage import check_whole
from hardware.description.errors import ConfigurationError, DataError
from pmm.gap.forced_runs import forced_problem
from pmm.gap.pendulum_file import GateTable, PendulumCase, Record
from sim.pendulum.bench import PendulumBench
from sim.pendulum.benches import bifilar_bench, compound_bench, decay_bench
from sim.pendulum.effects import make_effect
from sim.pendulum.effects.base import PendulumEffect, small_swing
from sim.pendulum.floating import Floating
from sim.pendulum.pivot import Pendulum
from sim.pendulum.suspension import Suspension

_LARGEST_RAD = 1.6  # no pendulum test begins with a quarter of a turn
_PERIODS_APART = 1.5  # factor: no gap that is told by swings, but another body
_GATE_AMPLITUDE_RAD = 0.1
_DISPLACEMENTS = ("rad", "m", "1", "")  # where a heading has no unit, that of the body
_LET_GO = 1.0  # swings, in which a hand, a lag and the memory of the water still show
_GATE_SWINGS = 4  # in a window
_OWN = ("line_excess", "spacing", "amplitude_period")  # each suspension has its own error
_OWN_DRIVEN = ("sensor_delay",)  # each record has its own clock


def problem_of(
    case: PendulumCase, path: Path, more: Mapping[str, type[Any]] | None = None
) -> PendulumProblem:
    """Read the records of a file that has been read.

    Parameters
    ----------
    more
        Effects of the user's own, by name; the file may have one on.

    Raises
    ------
    ConfigurationError
        If the file is wrong.
    DataError
        If a record is.
    """
    scaled = bool(case.suspensions)
    own_names = _OWN if scaled else _OWN_DRIVEN
    tolerances = tuple(
        tolerance(name, deviation, own=name in own_names)
        for name, deviation in case.tolerances.items()
    )
    if scaled:
        trials = tuple(_suspended(case, suspension, path.parent) for suspension in case.suspensions)
        problem = PendulumProblem(trials, tolerances, kinds=("period",))
    elif case.forced:
        problem = forced_problem(case, path.parent, tolerances)
    else:
        problem = _decay(case, path.parent, tolerances)
    on = [make_effect(effect.name, more, **effect.parameters) for effect in case.effects]
    channels = {sensor.channel.name for trial in problem.trials for sensor in trial.bench.sensors}
    for effect in on:
        if getattr(effect, "channel", "") not in ("", *channels):
            raise ConfigurationError(
                f"{path}: {effect.name} is on for a channel that no record has (channels: "
                f"{', '.join(sorted(channels))})"
            )
    return _checked(path, replace(problem, trials=_with(problem.trials, on)))


def _with(trials: Sequence[Trial], effects: Sequence[PendulumEffect]) -> tuple[Trial, ...]:
    """Return trials whose simulation has effects on."""
    return tuple(replace(trial, effects=tuple(effects)) for trial in trials)


def _checked(path: Path, problem: PendulumProblem) -> PendulumProblem:
    for number, trial in enumerate(problem.trials):
        if not (problem.trial == number).any():
            raise DataError(
                f"{path}: {trial.name}: {trial.windows.count} windows of swings are too few to "
                "tell their scatter; record longer, or let more swings count"
            )
    return problem


def _decay(case: PendulumCase, folder: Path, tolerances: tuple[Any, ...]) -> PendulumProblem:
    if case.measured is None:
        raise ConfigurationError(f"{case.name}: no [measured] record")
    part = _part(case.measured, folder)
    body = case.floating or case.pivot
    if body is not None:
        trial = _sampled(part, body, part.period_s)
        _check_period(trial, part.period_s)
        return PendulumProblem((trial,), tolerances)
    if case.simulated is None:
        raise ConfigurationError(f"{case.name}: no [simulated] record, [floating] or [pivot]")
    theirs = _part(case.simulated, folder)
    # only the ratio of restoring to inertia shows in a decay
    unit = Floating(1.0, 0.0, (2.0 * math.pi / theirs.period_s) ** 2)
    model = surrogate(_sampled(theirs, unit, theirs.period_s))
    trial = replace(
        _sampled(part, unit, theirs.period_s), bench=model.bench, variants=model.variants
    ).released()
    return PendulumProblem((trial,), tolerances, model_error=model.rms)


def _check_period(trial: Trial, period_s: float) -> None:
    inertia, restoring = small_swing(trial.bench, trial.acts_on)
    told_s = 2.0 * math.pi * math.sqrt(inertia / restoring)
    if abs(math.log(period_s / told_s)) > math.log(_PERIODS_APART):
        raise DataError(
            f"{trial.name}: the record swings in {period_s:.3g} s, the body of the file in "
            f"{told_s:.3g} s: is its inertia or restoring in other units?"
        )


def _part(record: Record, folder: Path) -> UsablePart:
    path = folder / record.record
    series = series_from_recording(check_whole(read_recording(path)), record.channel)
    if series.unit not in _DISPLACEMENTS:
        raise DataError(
            f"{path}: channel {record.channel!r} is in {series.unit}; a decay is compared as a "
            "displacement, in rad or m: choose a channel of that, or integrate this one"
        )
    part = usable_part(series)
    if part.series.unit in ("rad", "") and part.first_amplitude > _LARGEST_RAD:
        raise DataError(
            f"{path}: the first swing of {record.channel} is "
            f"{part.first_amplitude:.3g}, taken as rad: "
            f'in degrees? Then write the unit in its heading: "{record.channel} [deg]"'
        )
    return part


def _sampled(part: UsablePart, body: Floating | Pendulum, period_s: float) -> Trial:
    series = part.series
    stop_s, rate_hz = float(series.time_s[-1]), series.sample_rate_hz
    windows = cut_into_windows(series.start_s + _LET_GO * period_s, stop_s, period_s, rate_hz)
    swings = swings_of_samples(series.time_s, series.values, windows)
    bench = _bench(body, part.first_amplitude)
    name = body.coordinates[0].name
    return Trial(series.name, bench, name, windows, swings, scatter(swings)).released()


def _bench(body: Floating | Pendulum, release: float) -> PendulumBench:
    if isinstance(body, Floating):
        return decay_bench(body, release=release)
    return compound_bench(body, release_rad=release)


def _suspended(case: PendulumCase, suspension: GateTable, folder: Path) -> Trial:
    gate_passages = passages(read_gate_events(folder / suspension.gates))
    early = gate_passages.number <= gate_passages.number[0] + 2 * case.swings
    gate_passages = replace(
        gate_passages,
        number=gate_passages.number[early],
        time_s=gate_passages.time_s[early],
        speed=gate_passages.speed[early],
    )
    period = 2.0 * float(np.ptp(gate_passages.time_s)) / float(np.ptp(gate_passages.number))
    count = int(np.ptp(gate_passages.time_s) / (_GATE_SWINGS * period))
    windows = Windows(float(gate_passages.time_s[0]), 2.0 * math.pi / period, _GATE_SWINGS, count)
    swings = swings_of_passages(gate_passages, windows, _GATE_AMPLITUDE_RAD)
    bench = _yaw_bench(case, suspension)
    trial = Trial(
        suspension.name, bench, "yaw", windows, swings, scatter(swings), scaled=True
    ).released()
    # how it decays is not asked here: each record gets its own damping
    return replace(trial, bench=surrogate(trial, restoring=False).bench)


def _yaw_bench(case: PendulumCase, suspension: GateTable) -> PendulumBench:
    k = case.gyradius_m
    body = Suspension(
        mass_kg=1.0,  # drops out of the yaw's period, as depth and the other gyradii do
        line_length_m=suspension.line_m,
        half_spacing_m=suspension.half_spacing_m,
        depth_m=0.1 * k,
        yaw_gyradius_m=k,
        pitch_gyradius_m=k,
        roll_gyradius_m=0.1 * k,
        linear=True,
        gravity_m_s2=case.gravity_m_s2,
    )
    bench = bifilar_bench(body, yaw_rad=_GATE_AMPLITUDE_RAD)
    at = next(n for n, sensor in enumerate(bench.sensors) if sensor.channel.name == "yaw")
    sensors, digitisers = (bench.sensors[at],), (bench.digitisers[at],)
    return replace(bench, photogates=(), sensors=sensors, digitisers=digitisers)
