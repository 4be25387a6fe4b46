"""Sinkage and trim of a run, where the campaign file states their sensors."""

from dataclasses import replace
from typing import Final

from analysis.attitude import (
    HARMONICS,
    NAMES,
    Attitude,
    AttitudeChannel,
    RestPosition,
    attitude,
    common_rest,
    measured,
    with_attitude,
)
from analysis.coefficients.corrections import zero_reading
from analysis.recording import Recording
from analysis.resolver.analysis import analyse
from hardware.description.channels import POSITIONS
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity
from pmm.coefficients.tasks import Task

_AT_REST: Final = RestPosition((0.0, 0.0), (0.0, 0.0))


def rest_of(task: Task, recording: Recording) -> tuple[RestPosition | None, tuple[Flag, ...]]:
    """Return what the sensors of a zero run read, or why nothing is told."""
    flags = _unusable(task, recording)
    if flags or task.sensors is None:
        return None, flags
    means, uncertainties = _means(recording, POSITIONS)
    return RestPosition(means, uncertainties), ()


def attitude_of(task: Task, recording: Recording) -> tuple[Attitude | None, tuple[Flag, ...]]:
    """Return sinkage and trim of a run against its zero runs, or why they are not told.

    Raises
    ------
    DataError
        If the positions contradict the sensors' distance or their unit.
    """
    flags = _unusable(task, recording)
    if flags or task.sensors is None:
        return None, flags
    positions = [zero.position for zero in task.zeros if zero is not None]
    rests = [position for position in positions if position is not None]
    if not rests and not task.tared:
        reason = (
            "sinkage and trim are told from rest, and no zero run with both positions is named; "
            "name one as zero_before or zero_after, or say tared = true in the campaign file"
        )
        return None, (_flag(reason),)
    rest = common_rest(rests) if rests else _AT_REST
    derived = with_attitude(recording, task.sensors, rest)
    if task.kind.oscillates:
        settings = replace(task.settings, channels=NAMES, harmonics=HARMONICS)
        reading = analyse(derived, task.choice, settings).readings[0]
        sinkage, trim = (measured(reading, name) for name in NAMES)
    else:
        means, uncertainties = _means(derived, NAMES)
        sinkage, trim = (AttitudeChannel(*pair) for pair in zip(means, uncertainties, strict=True))
    return attitude(task.sensors, rest, sinkage, trim), ()


def _unusable(task: Task, recording: Recording) -> tuple[Flag, ...]:
    """Say why there is no attitude to be told; refuse positions in another unit."""
    names = [name for name in POSITIONS if name in recording.channel_names]
    if task.sensors is None:
        reason = "recorded, but the campaign file has no table [attitude]: nothing is told of it"
        return (_flag(f"{' and '.join(names)}: {reason}"),) if names else ()
    missing = [name for name in POSITIONS if name not in names]
    if missing:
        reason = "[attitude] is stated, so sinkage and trim are not told; name it in [columns]"
        return (_flag(f"no channel {' or '.join(missing)}: {reason}"),)
    units = {recording.channels[recording.index(name)].unit for name in POSITIONS}
    if other_units := units - {"", "m"}:
        raise DataError(
            f"{recording.name}: {' and '.join(POSITIONS)} are in "
            f"{' and '.join(sorted(other_units))}, not in m; name the right unit in "
            "[columns.channels]"
        )
    return ()


def _flag(reason: str) -> Flag:
    return Flag("attitude_unknown", Severity.WARNING, reason)


def _means(
    recording: Recording, names: tuple[str, str]
) -> tuple[tuple[float, float], tuple[float, float]]:
    offsets = zero_reading(recording, names)
    (first, second), (first_u, second_u) = offsets.values.real, offsets.standard_uncertainty.real
    return (float(first), float(second)), (float(first_u), float(second_u))
