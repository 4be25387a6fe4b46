"""``FILE.toml`` of a pendulum's gap: records, what the simulation believes, tolerances.

``docs/gap-pendulums.md`` has the keys.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from analysis.gap.pendulum.causes import tolerance
from analysis.gap.pendulum.further import Reach
from analysis.gap.pendulum.surrogate import surrogate
from analysis.gap.pendulum.swings import (
    Windows,
    cut_into_windows,
    scatter,
    swings_of_passages,
    swings_of_samples,
)
from analysis.gap.pendulum.trial import Problem, Trial
from analysis.inertia.gates import passages, read_gate_events
from analysis.inertia.series import UsablePart, series_from_recording, usable_part
from analysis.readers import read_recording
from hardware.description.errors import ConfigurationError, DataError
from pmm.configuration import Fault, as_error, read_toml, validate
from sim.pendulum.bench import PendulumBench
from sim.pendulum.benches import bifilar_bench, compound_bench, decay_bench
from sim.pendulum.floating import Floating
from sim.pendulum.pivot import Pendulum
from sim.pendulum.suspension import Suspension

_KEEP: dict[str, Any] = {"extra": "forbid", "allow_inf_nan": False}
_GATE_AMPLITUDE_RAD = 0.1
_GATE_SWINGS = 4  # in a window
_OWN = ("line_excess", "spacing", "amplitude_period")  # each suspension has its own error


@dataclass(frozen=True)
class Record:
    """A sampled record and its channel."""

    record: str
    channel: str

    __pydantic_config__: ClassVar = _KEEP


@dataclass(frozen=True)
class GateTable:
    """One suspension: edges of light gates, half spacing and line length as measured."""

    name: str
    gates: str
    half_spacing_m: float
    line_m: float

    __pydantic_config__: ClassVar = _KEEP


@dataclass(frozen=True)
class ReachTable(Reach):
    """What a further suspension may be."""

    __pydantic_config__: ClassVar = _KEEP


@dataclass(frozen=True)
class PendulumCase:
    """The file.

    Attributes
    ----------
    measured, simulated
        A decay pair; without ``simulated`` the simulation is of ``floating``, a body afloat, or of
        ``pivot``, parts on a knife edge: a swing, or a compound pendulum.
    suspensions
        One body on several pairs of lines; ``gyradius_m`` is what it is thought to have.
    swings
        How many swings of a light gates' record count.
    tolerances
        Standard deviations of what is stated, by effect.
    reach
        Within which a further suspension is proposed.
    """

    name: str
    measured: Record | None = None
    simulated: Record | None = None
    floating: Floating | None = None
    pivot: Pendulum | None = None
    suspensions: tuple[GateTable, ...] = ()
    gyradius_m: float = 1.0
    gravity_m_s2: float = 9.80665
    swings: int = 60
    tolerances: Mapping[str, float] = field(default_factory=dict)
    reach: ReachTable | None = None

    __pydantic_config__: ClassVar = _KEEP


def read_case(path: Path) -> PendulumCase:
    """Read the file.

    Raises
    ------
    ConfigurationError
        With every error of it.
    """
    table = read_toml(path)
    faults: list[Fault] = []
    case = validate(PendulumCase, table, faults)
    if case is not None:
        given = (case.measured is not None, bool(case.suspensions))
        if sum(given) != 1:
            faults.append(Fault(("measured",), "or [[suspensions]]: give exactly one of them"))
        told = (case.simulated, case.floating, case.pivot)
        if case.measured and sum(one is not None for one in told) != 1:
            said = "or [floating], or [pivot]: give exactly one of them"
            faults.append(Fault(("simulated",), said))
    if case is None or faults:
        raise as_error(path, faults, table)
    return case


def load_problem(path: Path) -> Problem:
    """Read a file and its records.

    Raises
    ------
    ConfigurationError
        If the file is wrong.
    DataError
        If a record is.
    """
    return problem_of(read_case(path), path)


def problem_of(case: PendulumCase, path: Path) -> Problem:
    """Read the records of a file that has been read.

    Raises
    ------
    ConfigurationError, DataError
        As :func:`load_problem`.
    """
    scaled = bool(case.suspensions)
    known = tuple(
        tolerance(name, deviation, own=scaled and name in _OWN)
        for name, deviation in case.tolerances.items()
    )
    if scaled:
        trials = tuple(_suspended(case, one, path.parent) for one in case.suspensions)
        return _checked(path, Problem(trials, known, kinds=("period",)))
    return _checked(path, _decay(case, path.parent, known))


def _checked(path: Path, problem: Problem) -> Problem:
    for number, trial in enumerate(problem.trials):
        if not (problem.trial == number).any():
            raise DataError(
                f"{path}: {trial.name}: {trial.windows.count} windows of swings are too few to "
                "tell their scatter; record longer, or let more swings count"
            )
    return problem


def _decay(case: PendulumCase, folder: Path, known: tuple[Any, ...]) -> Problem:
    if case.measured is None:
        raise ConfigurationError(f"{case.name}: no [measured] record")
    part = _part(case.measured, folder)
    body = case.floating or case.pivot
    if body is not None:
        return Problem((_sampled(part, body, part.period_s),), known)
    if case.simulated is None:
        raise ConfigurationError(f"{case.name}: no [simulated] record, [floating] or [pivot]")
    theirs = _part(case.simulated, folder)
    # only the ratio of restoring to inertia shows in a decay
    unit = Floating(1.0, 0.0, (2.0 * math.pi / theirs.period_s) ** 2)
    model = surrogate(_sampled(theirs, unit, theirs.period_s))
    trial = replace(
        _sampled(part, unit, theirs.period_s), bench=model.bench, variants=model.variants
    ).released()
    return Problem((trial,), known, model_error=model.rms)


def _part(one: Record, folder: Path) -> UsablePart:
    return usable_part(series_from_recording(read_recording(folder / one.record), one.channel))


def _sampled(part: UsablePart, body: Floating | Pendulum, period_s: float) -> Trial:
    series = part.series
    windows = cut_into_windows(series.start_s, float(series.time_s[-1]), period_s)
    found = swings_of_samples(series.time_s, series.values, windows)
    bench = _bench(body, part.first_amplitude)
    name = body.coordinates[0].name
    return Trial(series.name, bench, name, windows, found, scatter(found)).released()


def _bench(body: Floating | Pendulum, release: float) -> PendulumBench:
    if isinstance(body, Floating):
        return decay_bench(body, release=release)
    return compound_bench(body, release_rad=release)


def _suspended(case: PendulumCase, one: GateTable, folder: Path) -> Trial:
    seen = passages(read_gate_events(folder / one.gates))
    early = seen.number <= seen.number[0] + 2 * case.swings
    seen = replace(
        seen, number=seen.number[early], time_s=seen.time_s[early], speed=seen.speed[early]
    )
    period = 2.0 * float(np.ptp(seen.time_s)) / float(np.ptp(seen.number))
    count = int(np.ptp(seen.time_s) / (_GATE_SWINGS * period))
    windows = Windows(float(seen.time_s[0]), 2.0 * math.pi / period, _GATE_SWINGS, count)
    found = swings_of_passages(seen, windows, _GATE_AMPLITUDE_RAD)
    bench = _yaw_bench(case, one)
    trial = Trial(one.name, bench, "yaw", windows, found, scatter(found), scaled=True).released()
    # how it decays is not asked here: each record gets its own damping
    return replace(trial, bench=surrogate(trial, restoring=False).bench)


def _yaw_bench(case: PendulumCase, one: GateTable) -> PendulumBench:
    k = case.gyradius_m
    body = Suspension(
        mass_kg=1.0,  # drops out of the yaw's period, as depth and the other gyradii do
        line_length_m=one.line_m,
        half_spacing_m=one.half_spacing_m,
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
