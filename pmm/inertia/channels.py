"""Which channel of a recording swings, and what the body does where it reads something else."""

from dataclasses import replace
from typing import Any

from analysis.inertia.checks import strongest_axis
from analysis.inertia.inclinometer import reading_factor, reading_flags, true_angle
from analysis.inertia.series import Series, series_from_recording, usable_part
from analysis.recording import Recording
from hardware.description.errors import ConfigurationError
from hardware.description.flags import Flag
from hardware.description.units import STANDARD_GRAVITY_M_S2
from pmm.inertia.reading import Job


def chosen_series(
    job: Job[Any], recording: Recording, channel: str | None, where: str
) -> tuple[Series, tuple[Flag, ...]]:
    """Return a recording's only channel, or the one that is named, and what is to be said of it.

    Raises
    ------
    ConfigurationError
        If there are several and none is named.
    """
    names = recording.channel_names
    if channel is None and len(names) > 1:
        raise ConfigurationError(
            f"{job.path}: {where}.channel is missing: {recording.name} holds {', '.join(names)}"
        )
    chosen = series_from_recording(recording, channel or names[0])
    unit = {column.name: column.unit for column in recording.channels}
    neighbours = [name for name in names if name != chosen.channel and unit[name] == chosen.unit]
    beside = tuple(series_from_recording(recording, name) for name in neighbours)
    damaged = (flag for flag in recording.flags if flag.damaged)
    return chosen, (*strongest_axis(chosen, beside), *damaged)


def true_angles(
    job: Job[Any], series: Series, radius_m: float, where: str
) -> tuple[Series, tuple[Flag, ...]]:
    """Return the angles behind the readings of an inclinometer that is carried along.

    Parameters
    ----------
    radius_m
        Of the inclinometer below the pivot.

    Raises
    ------
    ConfigurationError
        If the channel is no angle, or the inclinometer sits where its readings hold none.
    """
    if series.unit != "rad":
        raise ConfigurationError(
            f"{job.path}: {where}.inclinometer_radius_m is for angles; {series.where} is in "
            f"{series.unit or 'no unit'}: leave it out"
        )
    gravity = job.table.gravity_m_s2 or STANDARD_GRAVITY_M_S2
    factor = reading_factor(usable_part(series).period_s, radius_m, gravity)
    values = true_angle(series.values, factor)
    return replace(series, values=values), reading_flags(factor)
