"""Means of a tow with propeller and rudder: loads, thrust, normal force, angle and rate."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from analysis.coefficients.corrections import ZeroReading, zero_reading
from analysis.coefficients.tows import Tow, tow_of
from analysis.recording import Recording
from hardware.description.channels import (
    FORCE_X,
    PROPELLER_THRUST,
    REVOLUTIONS,
    RUDDER_ANGLE,
    RUDDER_NORMAL_FORCE,
)
from hardware.description.errors import DataError
from pmm.campaign.recording_source import open_recording
from pmm.coefficients.reading import read_cycle
from pmm.coefficients.tasks import Failed, Task

GAUGES: Final = (PROPELLER_THRUST.name, RUDDER_NORMAL_FORCE.name)
_TARED: Final = (*GAUGES, RUDDER_ANGLE.name)


@dataclass(frozen=True)
class SteeredTow:
    """One tow.

    Attributes
    ----------
    tow
        Loads of the water on the model.
    rudder_rad, rate_hz
        As they were measured, else as the campaign states them.
    thrust_n, normal_n
        Less what the gauges read in the zero runs, with standard uncertainties of their own.
    zero_u
        By zero run and gauge, the standard uncertainty that the zero's reading adds.
    """

    tow: Tow
    rudder_rad: float
    rate_hz: float
    thrust_n: float
    thrust_u: float
    normal_n: float
    normal_u: float
    zero_u: Mapping[tuple[str, str], float]


def read_gauge_zeros(task: Task) -> ZeroReading | Failed:
    """Return what the gauges behind the model read in a zero run, as far as it has them."""
    try:
        recording = open_recording(task.source)
        own = tuple(name for name in _TARED if name in recording.channel_names)
        return zero_reading(recording, 0.0, own)
    except DataError as error:
        return Failed(task.name, str(task.source.path), str(error), error.exit_status)


def read_tow(task: Task, zeros: Mapping[str, ZeroReading]) -> SteeredTow | Failed:
    """Read a tow; ``task`` has its zero runs, ``zeros`` what the gauges behind the model read."""
    done = read_cycle(task)
    if isinstance(done, Failed) or done.cycle is None:
        return (
            done
            if isinstance(done, Failed)
            else Failed(task.name, done.file, f"{task.name}: it is no tow", 1)
        )
    try:
        return _steered(task, tow_of(task.kind, done.cycle), zeros)
    except DataError as error:
        return Failed(task.name, done.file, str(error), error.exit_status)


def _steered(task: Task, tow: Tow, zeros: Mapping[str, ZeroReading]) -> SteeredTow:
    recording = open_recording(task.source)
    there = recording.channel_names
    lacking = [name for name in (*GAUGES, FORCE_X.name) if name not in there]
    if lacking:
        raise DataError(
            f"{task.name}: no channel {' or '.join(lacking)}; thrust, the rudder's normal force "
            f"and the force along the model have to be recorded (channels: {', '.join(there)})"
        )
    point = task.set_point
    own = {name: zeros[name] for name in task.zero_names if name is not None and name in zeros}
    means = {name: _mean(recording, name, own, tared=task.tared) for name in GAUGES}
    angle = point.rudder_angle_rad
    if RUDDER_ANGLE.name in there:
        angle, *_ = _mean(recording, RUDDER_ANGLE.name, own, tared=task.tared)
    rate = point.revolutions_hz
    if REVOLUTIONS.name in there:
        rate = float(recording.values(REVOLUTIONS.name).mean())
        turned = recording.channels[recording.index(REVOLUTIONS.name)].unit == "rad/s"
        rate = rate / (2.0 * math.pi) if turned else rate
    if not rate > 0.0:
        raise DataError(
            f"{task.name}: its propeller has no revolutions; record the channel "
            f"{REVOLUTIONS.name}, or give revolutions_hz of the run in the campaign file"
        )
    (thrust, thrust_u, first), (normal, normal_u, second) = means.values()
    by_zero = {(zero, GAUGES[0]): u for zero, u in first.items()}
    by_zero |= {(zero, GAUGES[1]): u for zero, u in second.items()}
    return SteeredTow(tow, angle, rate, thrust, thrust_u, normal, normal_u, by_zero)


def _mean(
    recording: Recording, name: str, zeros: Mapping[str, ZeroReading], *, tared: bool
) -> tuple[float, float, dict[str, float]]:
    """Return a channel's mean less its zeros' mean, its own uncertainty, and that of each zero."""
    run = zero_reading(recording, 0.0, (name,)).offsets.real
    rest = {
        zero: one.offsets.select([name]).real
        for zero, one in zeros.items()
        if name in one.offsets.names
    }
    if not rest and not tared:
        what = "neutral" if name == RUDDER_ANGLE.name else "zero"
        raise DataError(
            f"{recording.name}: the channel {name} has no {what}; make a zero run with the rudder "
            "amidships and the propeller at rest, and name it as zero_before or zero_after; or say "
            "tared = true in the campaign file"
        )
    share = 1.0 / max(len(rest), 1)
    value = float(run.values[0]) - share * sum(float(one.values[0]) for one in rest.values())
    by_zero = {zero: share * float(one.standard_uncertainty[0]) for zero, one in rest.items()}
    return value, float(run.standard_uncertainty[0]), by_zero


def zeroed_names(tasks: list[Task]) -> set[str]:
    """Return the zero runs that tasks name."""
    return {name for one in tasks for name in one.zero_names if name is not None}
