"""A run with propeller and rudder: loads, thrust, normal force, angle and rate."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Final

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.corrections import zero_reading
from analysis.coefficients.phasors import Phasors
from analysis.coefficients.tows import tow_of
from analysis.recording import Recording
from hardware.description.channels import (
    FORCE_X,
    PROPELLER_THRUST,
    PROPELLER_TORQUE,
    REVOLUTIONS,
    RUDDER_ANGLE,
    RUDDER_NORMAL_FORCE,
)
from hardware.description.errors import DataError
from pmm.campaign.recording_source import open_recording
from pmm.coefficients.reading import read_cycle
from pmm.coefficients.tasks import FailedRecording, Task
from pmm.steering.instants import Instant, instants

GAUGES: Final = (PROPELLER_THRUST.name, RUDDER_NORMAL_FORCE.name)
_TORQUE: Final = PROPELLER_TORQUE.name
_TARED: Final = (*GAUGES, RUDDER_ANGLE.name, _TORQUE)


@dataclass(frozen=True)
class SteeredRun:
    """A tow, or one of the two instants of an oscillation.

    Attributes
    ----------
    course
        What the hull did, by name: the same of runs that differ in propeller and rudder alone.
    motion
        u, v (m/s) and r (rad/s) of the midpoint.
    loads, loads_u
        X, Y and N of the water on the model (of an oscillation with its inertia), with standard
        uncertainties.
    rudder_rad, rate_hz
        As they were measured, else as the campaign states them.
    thrust_n, normal_n
        Less what the gauges read in the zero runs, with standard uncertainties of their own.
    zero_u
        By zero run and gauge, the standard uncertainty that the zero's reading adds to these two.
    torque_n_m, torque_u
        Of the propeller, with that of its zero; NaN where it was not recorded.
    """

    run: str
    course: str
    motion: tuple[float, float, float]
    loads: tuple[float, ...]
    loads_u: tuple[float, ...]
    rudder_rad: float
    rate_hz: float
    thrust_n: float
    thrust_u: float
    normal_n: float
    normal_u: float
    zero_u: Mapping[tuple[str, str], float]
    torque_n_m: float = math.nan
    torque_u: float = math.nan

    @property
    def drift_rad(self) -> float:
        """Of the midpoint, bow to starboard."""
        return math.atan2(-self.motion[1], self.motion[0])


def read_gauge_zeros(task: Task) -> Phasors | FailedRecording:
    """Return what the gauges behind the model read in a zero run, as far as it has them."""
    try:
        recording = open_recording(task.source)
        names = tuple(name for name in _TARED if name in recording.channel_names)
        return zero_reading(recording, names)
    except DataError as error:
        return FailedRecording(task.name, str(task.source.path), str(error), error.exit_status)


def read_steered(task: Task, zeros: Mapping[str, Phasors]) -> list[SteeredRun] | FailedRecording:
    """Read a run; ``task`` has its zero runs, ``zeros`` what the gauges behind the model read."""
    result = read_cycle(task)
    if isinstance(result, FailedRecording):
        return result
    assert result.cycle is not None  # noqa: S101 - only a zero run has none
    try:
        return list(_steered(task, result.cycle, zeros))
    except DataError as error:
        return FailedRecording(task.name, result.file, str(error), error.exit_status)


def _steered(task: Task, cycle: BodyCycle, zeros: Mapping[str, Phasors]) -> Iterator[SteeredRun]:
    recording = open_recording(task.source)
    channels = recording.channel_names
    lacking = [name for name in (*GAUGES, FORCE_X.name) if name not in channels]
    if lacking:
        raise DataError(
            f"{task.name}: no channel {' or '.join(lacking)}; thrust, the rudder's normal force "
            f"and the force along the model have to be recorded (channels: {', '.join(channels)})"
        )
    run_zeros = {
        name: zeros[name] for name in task.zero_names if name is not None and name in zeros
    }
    gauges = (*GAUGES, _TORQUE) if _TORQUE in channels else GAUGES
    rest = {name: _rest_reading(recording, name, run_zeros, tared=task.tared) for name in gauges}
    angle, rate = _angle(task, recording, run_zeros), _rate(task, recording)
    by_zero = {(zero, name): u for name in GAUGES for zero, u in rest[name][1].items()}
    for instant in _instants(task, recording, cycle, gauges):
        course = (
            f"{replace(task.set_point, rudder_angle_rad=0.0, revolutions_hz=0.0)} {instant.side}"
        )
        values = [
            value - offset for value, (offset, _) in zip(instant.gauges, rest.values(), strict=True)
        ]
        spread = list(instant.gauges_u)
        torque = (
            [values[2], math.hypot(spread[2], *rest[_TORQUE][1].values())] if values[2:] else []
        )
        name = f"{task.name} {instant.side}".strip()
        yield SteeredRun(
            name, course, instant.motion, instant.loads, instant.loads_u, angle, rate,
            values[0], spread[0], values[1], spread[1], by_zero, *torque,
        )  # fmt: skip


def _instants(
    task: Task, recording: Recording, cycle: BodyCycle, gauges: tuple[str, ...]
) -> list[Instant]:
    """Return what a run tells: a tow its means, an oscillation two instants."""
    if task.kind.oscillates:
        return instants(task, recording, cycle, gauges)
    tow = tow_of(task.kind, cycle)
    read = zero_reading(recording, gauges).real
    speed, drift = tow.speed_m_s, tow.drift_rad
    motion = (speed * math.cos(drift), -speed * math.sin(drift), 0.0)
    loads = (-tow.resistance_n, tow.force_n, tow.moment_n_m)
    loads_u = (tow.resistance_u, tow.force_u, tow.moment_u)
    values, spread = read.values[::2].tolist(), read.standard_uncertainty[::2].tolist()
    return [Instant("", motion, loads, loads_u, tuple(values), tuple(spread))]


def _angle(task: Task, recording: Recording, zeros: Mapping[str, Phasors]) -> float:
    if RUDDER_ANGLE.name not in recording.channel_names:
        return task.set_point.rudder_angle_rad
    offset, _ = _rest_reading(recording, RUDDER_ANGLE.name, zeros, tared=task.tared)
    return float(recording.values(RUDDER_ANGLE.name).mean()) - offset


def _rate(task: Task, recording: Recording) -> float:
    rate = task.set_point.revolutions_hz
    if REVOLUTIONS.name in recording.channel_names:
        rate = float(recording.values(REVOLUTIONS.name).mean())
        turned = recording.channels[recording.index(REVOLUTIONS.name)].unit == "rad/s"
        rate = rate / (2.0 * math.pi) if turned else rate
    if not rate > 0.0:
        raise DataError(
            f"{task.name}: its propeller has no revolutions ({rate:g} 1/s); where it turned, "
            f"record the channel {REVOLUTIONS.name} or give revolutions_hz above 0 in the campaign "
            "file; where it stood still, take the run out of the campaign: it tells nothing here"
        )
    return rate


def _rest_reading(
    recording: Recording, name: str, zeros: Mapping[str, Phasors], *, tared: bool
) -> tuple[float, dict[str, float]]:
    """Return what a channel reads at rest, and the uncertainty that each zero run adds to it."""
    rest = {
        zero: reading.select([name]).real
        for zero, reading in zeros.items()
        if name in reading.names
    }
    if not rest and not tared:
        level = "neutral" if name == RUDDER_ANGLE.name else "zero"
        raise DataError(
            f"{recording.name}: the channel {name} has no {level}; make a zero run with the rudder "
            "amidships and the propeller at rest, and name it as zero_before or zero_after; or say "
            "tared = true in the campaign file"
        )
    share = 1.0 / max(len(rest), 1)
    by_zero = {zero: share * float(offset.standard_uncertainty[0]) for zero, offset in rest.items()}
    return share * sum(float(offset.values[0]) for offset in rest.values()), by_zero


def zeroed_names(tasks: list[Task]) -> set[str]:
    """Return the zero runs that tasks name."""
    return {name for task in tasks for name in task.zero_names if name is not None}
