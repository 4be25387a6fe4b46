"""Names and units as people read them, safe to draw."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from analysis.recording import Recording
from hardware.description.channels import Channel, Quantity

_LONGEST = 32  # characters of a name that a panel has room for
_LOADS = (Quantity.FORCE, Quantity.MOMENT)


@dataclass(frozen=True)
class Display:
    """Multiply SI values by ``factor`` to have them in the unit ``label``."""

    label: str
    factor: float = 1.0


_READ_AS = {
    "m": Display("mm", 1e3),
    "rad": Display("deg", 180.0 / math.pi),
    "rad/s": Display("deg/s", 180.0 / math.pi),
    "1": Display("–"),
    "": Display("unit not stated"),
}


def display(unit: str) -> Display:
    """Return how values in an SI unit are shown: lengths in mm, angles in degrees."""
    return _READ_AS.get(unit, Display(plain(unit)))


def plain(text: str) -> str:
    """Return text on one line without characters that no file format can hold."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def shown_name(name: str) -> str:
    """Return a channel's name for a figure: on one line, not too long, never taken for hidden."""
    text = plain(name)
    text = text if len(text) <= _LONGEST else text[: _LONGEST - 1] + "…"
    return f" {text}" if text.startswith("_") else text  # a legend hides what starts with "_"


def axis_label(channel: Channel) -> str:
    """Return ``name (unit)`` for a channel, in the unit that it is shown in."""
    return f"{shown_name(channel.name)}\n({display(channel.unit).label})"


def loads_first(recording: Recording) -> list[int]:
    """Return the channels' rows with forces and moments before the rest."""
    return units_loads_first([channel.unit for channel in recording.channels])


def units_loads_first(units: Sequence[str]) -> list[int]:
    """Return the rows of channels in these SI units with forces and moments before the rest."""
    return sorted(range(len(units)), key=lambda row: Channel("", units[row]).quantity not in _LOADS)
