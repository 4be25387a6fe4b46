"""Runs of a body on springs or afloat under a known force, as a pendulum's file names them."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np

from analysis.gap.pendulum.driven import DrivenTrial, KnownForce
from analysis.gap.pendulum.problem import PendulumProblem, Tolerance
from analysis.gap.pendulum.swings import KINDS, scatter
from analysis.inertia.series import rough_period
from analysis.readers import read_recording
from analysis.readers.damage import check_whole
from analysis.recording import Recording
from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel
from hardware.description.errors import ConfigurationError, DataError
from pmm.gap.pendulum_file import ForcedTable, OverFrequency, PendulumCase, Record
from sim.acquisition.channels import Digitiser
from sim.pendulum.bench import PendulumBench
from sim.pendulum.coordinates import HEAVE, ROLL
from sim.pendulum.driven import DrivenBody
from sim.pendulum.floating import Floating
from sim.pendulum.release import Release
from sim.pendulum.sensors import Sensor

Read = Callable[[str], Recording]
# Both stand in docs/gap-calibration.md, with what they do when halved or doubled.
_UNSTEADY: Final = 0.25  # of a force's amplitude between two windows, from which it is no one force
_ANOTHER: Final = 50.0  # factor of amplitude: no gap, but other units


@dataclass(frozen=True)
class _Gate:
    """Samples of one channel in the gate of a run."""

    name: str
    unit: str
    time_s: FloatArray
    values: FloatArray


def forced_problem(
    case: PendulumCase, folder: Path, tolerances: tuple[Tolerance, ...]
) -> PendulumProblem:
    """Read the runs of a file.

    Raises
    ------
    ConfigurationError
        If the file is wrong.
    DataError
        If a record is.
    """
    if case.floating is None:
        raise ConfigurationError(f"{case.name}: [[forced]] runs need the body, [floating]")
    read = cache(lambda name: check_whole(read_recording(folder / name)))
    trials = [
        trial
        for run in case.forced
        for trial in _run(case.floating, case.over_frequency, run, read)
    ]
    kinds = tuple(kind for kind in KINDS if kind != "mean")
    return PendulumProblem(tuple(trials), tolerances, kinds=kinds)


def _run(
    floating: Floating, over: OverFrequency | None, run: ForcedTable, read: Read
) -> Iterator[DrivenTrial]:
    """Yield what each sensor saw of a run."""
    pushed = _gate(run, run.force, read)
    rate_hz = (pushed.time_s.size - 1) / float(np.ptp(pushed.time_s))
    period_s = rough_period(pushed.name, pushed.values - np.nanmean(pushed.values), rate_hz)
    force = KnownForce.of(pushed.name, pushed.time_s, pushed.values, period_s)
    if force.changes > _UNSTEADY:
        raise DataError(
            f"{pushed.name}: its amplitude changes by more than {100 * _UNSTEADY:.0f} % within the "
            f"gate of run {run.name!r}; state from_s and to_s where it is steady"
        )
    body = floating
    if over is not None:
        body, transfer = over.at(floating, 1.0 / period_s)
        force = force.of_wave(transfer) if transfer is not None else force
    for sensor in run.measured:
        yield _driven_trial(run, body, force, _gate(run, sensor, read))


def _gate(run: ForcedTable, channel: Record, read: Read) -> _Gate:
    recording = read(channel.record)
    part = recording.between(
        recording.start_s if run.from_s is None else run.from_s,
        recording.end_s if run.to_s is None else run.to_s,
    )
    unit = recording.channels[recording.index(channel.channel)].unit
    return _Gate(channel.channel, unit, part.time_s(), part.values(channel.channel))


def _driven_trial(run: ForcedTable, body: Floating, force: KnownForce, gate: _Gate) -> DrivenTrial:
    """Return what a sensor saw: of a displacement, a rate or an acceleration by its unit."""
    length, _, per = gate.unit.partition("/")
    coordinate = ROLL if length == "rad" else HEAVE
    signals = {"": coordinate.displacement, "s": coordinate.rate, "s2": coordinate.acceleration}
    if length not in ("m", "rad", "") or per not in signals:
        raise DataError(
            f"run {run.name!r}: channel {gate.name!r} is in {gate.unit}; a motion is a "
            "displacement, a rate or an acceleration, in m or rad: choose another channel"
        )
    driven = DrivenBody(
        body.inertia, body.added_inertia, body.restoring, body.resistance, coordinate,
        force.harmonics,
    )  # fmt: skip
    sensor = Sensor(Channel(gate.name, gate.unit), ((signals[per], 1.0),))
    bench = PendulumBench(driven, Release((coordinate,), (0.0,)), (sensor,), (Digitiser(),))
    response = force.response(gate.time_s, gate.values)
    name = run.name if len(run.measured) == 1 else f"{run.name}, {gate.name}"
    rate_hz = (gate.time_s.size - 1) / float(np.ptp(gate.time_s))
    samples = round(rate_hz * force.windows.length_s / force.windows.swings)
    trial = DrivenTrial(
        name, bench, coordinate.name, force.windows, response, scatter(response), run=run.name,
        samples=samples, grows_rad_s=force.grows_rad_s,
    )  # fmt: skip
    if not np.isfinite(response[0]).any():
        raise DataError(
            f"{name}: {gate.name} has fewer than 18 samples in each window of "
            f"{force.windows.length_s:.3g} s; state from_s and to_s where it was recorded, or "
            "sample it faster"
        )
    apart = float(np.nanmedian((trial.observed - trial.simulate())[0]))
    if abs(apart) > math.log(_ANOTHER):
        raise DataError(
            f"{name}: the record is {math.exp(apart):.2g} times as large as the body of the file "
            "moves under this force: is its inertia, its restoring or the force in other units?"
        )
    return trial
