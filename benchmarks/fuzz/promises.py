"""What no input may do: end a reader, or be taken with numbers that are none and not said to be."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from analysis.recording import Recording
from hardware.description.errors import PmmError


class SilentNanError(Exception):
    """A number that is none was taken, and nothing says so."""


# What a reader may raise: it becomes a sentence and an exit status.
REFUSED = (PmmError,)


def check_recording(recording: Recording) -> None:
    """Read all samples; those that are none have to be flagged, of their channel or of all."""
    values = np.asarray(recording.samples[:, :])
    said = {flag.channel for flag in recording.flags}
    for name, row in zip(recording.channel_names, values, strict=True):
        if not np.isfinite(row).all() and not {name, None} & said:
            raise SilentNanError(f"channel {name!r} has {np.sum(~np.isfinite(row))} values of none")
    check_finite((recording.sample_rate_hz, recording.start_s, recording.set_point))
    if (
        recording.photocell_edges_s is not None
        and not np.isfinite(recording.photocell_edges_s).all()
    ):
        raise SilentNanError("times of the photocell's pulses that are none")


def check_finite(value: Any, where: str = "") -> None:
    """Refuse NaN and infinity anywhere in what a file was made, but where they are a default."""
    for place, one in _numbers(value, where):
        if not math.isfinite(one):
            raise SilentNanError(f"{place} = {one}")


def _numbers(value: Any, where: str) -> Iterator[tuple[str, float]]:
    if isinstance(value, float):
        yield where, value
    for place, one in _parts(value):
        yield from _numbers(one, f"{where}.{place}")


def _parts(value: Any) -> list[tuple[object, Any]]:
    if isinstance(value, Mapping):
        return list(value.items())
    if isinstance(value, list | tuple):
        return list(enumerate(value))
    if not is_dataclass(value) or isinstance(value, type):
        return []
    found = [(one, getattr(value, one.name, None)) for one in fields(value)]
    return [
        (field.name, one)
        for field, one in found
        if not (isinstance(one, float) and one == field.default)
    ]
