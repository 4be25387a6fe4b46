"""Columns of numbers from a file that is no text."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from hardware.description.arrays import FloatArray

LONGEST_ANSWER: Final = 1 << 22  # bytes: names, units and lengths of 4096 columns, 1 KiB each


@dataclass(frozen=True, eq=False)
class ForeignColumns:
    """Columns of numbers that were read from a file.

    Attributes
    ----------
    values
        By name; they need not be of one length.
    units
        By name, where the file states one.
    sample_rate_hz
        Where the file states it; a time column goes before it.
    no_rate
        Where what the file states contradicts itself, so that there is no rate: how.
    """

    values: Mapping[str, FloatArray]
    units: Mapping[str, str]
    sample_rate_hz: float | None = None
    no_rate: str = ""
