"""The schema's attributes: from a recording, and back with everything checked."""

import json
import math
import re
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

import numpy as np

from analysis.recording import Recording, Samples
from hardware.description import dataset as schema
from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel
from hardware.description.errors import DataError
from hardware.description.flags import Flag
from hardware.description.setpoint import SetPoint
from hardware.description.units import is_unit, unit

# How far a stored time may lie from the even grid, in sample intervals.
TIME_TOLERANCE = 1e-3

# NetCDF's rule for names.
_NAME = re.compile(r"[A-Za-z0-9_\u0080-\U0010ffff]([^/\x00-\x1f\x7f]*[^/\x00-\x20\x7f])?")
_RESERVED = (schema.TIME, schema.EDGE, schema.EDGE_TIME, schema.CHECKSUMS)


def check_storable(recording: Recording) -> None:
    """Refuse a recording that the schema cannot hold.

    Raises
    ------
    DataError
        For no channels or no samples, channel names that NetCDF or the schema does not allow or
        that appear twice, and units that are not SI.
    """
    recording.check_even("a recording in NetCDF")
    names = recording.channel_names
    if not names or not recording.sample_count:
        raise DataError(f"{recording.name}: no channels or no samples; there is nothing to keep")
    for channel in recording.channels:
        name = channel.name
        if name in _RESERVED or not _NAME.fullmatch(name) or names.count(name) > 1:
            raise DataError(
                f"{recording.name}: the channel name {name!r} cannot be kept: it is empty, begins "
                f"or ends oddly, holds '/', appears twice, or is one of {', '.join(_RESERVED)}; "
                "rename it"
            )
        _check_si(channel, recording.name)


def _check_si(channel: Channel, where: str) -> None:
    if is_unit(channel.unit) and unit(channel.unit).si != channel.unit:
        raise DataError(
            f"{where}: channel {channel.name!r} is in {channel.unit!r}; a recording is kept in SI "
            f"units, {unit(channel.unit).si!r} here: convert it"
        )


def channel_attributes(channel: Channel) -> dict[str, str | float]:
    """Return a channel's attributes."""
    attributes: dict[str, str | float] = {schema.UNITS: channel.unit}
    if channel.full_scale is not None:
        attributes[schema.FULL_SCALE] = float(channel.full_scale)
    return attributes


def run_attributes(recording: Recording) -> dict[str, str | float]:
    """Return the attributes of a whole run."""
    attributes: dict[str, str | float] = {
        schema.ATTR_SCHEMA: schema.SCHEMA,
        schema.ATTR_NAME: recording.name,
        schema.ATTR_SAMPLE_RATE: float(recording.sample_rate_hz),
        schema.ATTR_PROVENANCE: json.dumps(dict(recording.provenance)),
        schema.ATTR_FLAGS: json.dumps([asdict(flag) for flag in recording.flags]),
    }
    if recording.set_point is not None:
        attributes[schema.ATTR_SET_POINT] = json.dumps(asdict(recording.set_point))
    return attributes


def channel_names(dimensions: Mapping[str, tuple[str, ...]], where: str) -> tuple[str, ...]:
    """Return the variables that are channels, given every variable's dimensions.

    Raises
    ------
    DataError
        If time is missing, a variable is over anything but time, or none is a channel.
    """
    if dimensions.get(schema.TIME) != (schema.TIME,):
        raise DataError(f"{where}: the coordinate {schema.TIME!r} over {schema.TIME!r} is missing")
    expected = {schema.EDGE_TIME: (schema.EDGE,)}
    for name, axes in dimensions.items():
        if axes != expected.get(name, (schema.TIME,)):
            raise DataError(f"{where}: the variable {name!r} is over {axes}, not over time")
    names = tuple(name for name in dimensions if name not in (schema.TIME, schema.EDGE_TIME))
    if not names:
        raise DataError(f"{where}: there is no channel over {schema.TIME!r}")
    return names


def parse_channel(name: str, attributes: Mapping[Any, Any], where: str) -> Channel:
    """Build a channel from its variable's attributes.

    Raises
    ------
    DataError
        If its unit is not SI or its values are packed.
    """
    packed = [key for key in ("scale_factor", "add_offset") if key in attributes]
    if packed:
        raise DataError(f"{where}: {name!r} is packed ({packed[0]}); save plain values")
    full_scale = attributes.get(schema.FULL_SCALE)
    channel = Channel(
        name,
        str(attributes.get(schema.UNITS, "")),
        None if full_scale is None else float(full_scale),
    )
    _check_si(channel, where)
    return channel


def parse_run(
    attributes: Mapping[Any, Any],
    channels: tuple[Channel, ...],
    samples: Samples,
    start_s: float,
    edges_s: FloatArray | None,
    where: str,
) -> Recording:
    """Build a recording from a run's attributes and its parts.

    Raises
    ------
    DataError
        If an attribute is missing, damaged, or of another schema, or there are no samples.
    """
    schema_name = attributes.get(schema.ATTR_SCHEMA)
    if schema_name != schema.SCHEMA:
        raise DataError(
            f"{where}: the attribute {schema.ATTR_SCHEMA!r} is {schema_name!r}, "
            f"not {schema.SCHEMA!r}: not a recording of this project"
        )
    if not samples.shape[1]:
        raise DataError(f"{where}: the recording has no samples")
    try:
        rate = float(attributes.get(schema.ATTR_SAMPLE_RATE, math.nan))
        recording = Recording(
            name=str(attributes.get(schema.ATTR_NAME, where)),
            channels=channels,
            samples=samples,
            sample_rate_hz=rate,
            start_s=start_s,
            photocell_edges_s=edges_s,
            set_point=_set_point(attributes.get(schema.ATTR_SET_POINT)),
            provenance=dict(json.loads(attributes.get(schema.ATTR_PROVENANCE, "{}")).items()),
            flags=_flags(attributes.get(schema.ATTR_FLAGS, "[]")),
        )
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        raise DataError(f"{where}: a damaged attribute: {error}") from None
    if not (math.isfinite(rate) and rate > 0.0):
        raise DataError(f"{where}: {schema.ATTR_SAMPLE_RATE!r} is {rate:g}, not a positive rate")
    return recording


def _set_point(text: str | None) -> SetPoint | None:
    if text is None:
        return None
    return SetPoint.read(json.loads(text))


def _flags(text: str) -> tuple[Flag, ...]:
    return tuple(map(Flag.read, json.loads(text)))


def check_time(time_s: FloatArray, recording: Recording, first: int, where: str) -> None:
    """Refuse stored times (of the samples from number ``first`` on) that are off the even grid.

    Raises
    ------
    DataError
        If one is missing or further than 0.001 intervals from its place.
    """
    expected = recording.time_s(first, first + time_s.size)
    interval_s = 1.0 / recording.sample_rate_hz
    # Seconds since 1970 at 10 kHz are rounded to more than the tolerance.
    allowed = TIME_TOLERANCE * interval_s + 2.0 * np.spacing(np.abs(expected))
    bad = np.flatnonzero(~(np.abs(time_s - expected) <= allowed))
    if bad.size:
        row = int(bad[0])
        raise DataError(
            f"{where}: the time of sample {first + row} is {time_s[row]:.9g} s, where "
            f"{recording.sample_rate_hz:g} Hz gives {expected[row]:.9g} s; a recording is kept "
            "evenly spaced"
        )
