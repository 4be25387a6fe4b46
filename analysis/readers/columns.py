"""Which column of a text file is what: the column map."""

from dataclasses import dataclass, field
from enum import StrEnum


class Edge(StrEnum):
    """Which side of the photocell's pulse marks the time."""

    RISING = "rising"
    FALLING = "falling"


@dataclass(frozen=True)
class TimeColumn:
    """The column of time stamps; without ``unit`` its header's unit counts, else seconds."""

    column: str
    unit: str | None = None


@dataclass(frozen=True)
class ChannelColumn:
    """One channel and the column it comes from.

    The value in SI units is ``sign * scale * cell * (factor of unit)``.

    Attributes
    ----------
    name
        What the channel is called from here on.
    column
        The column's header (with or without its unit), or ``column_3`` for the third.
    unit
        Unit of ``scale * cell``; ``None`` takes the header's.
    sign
        +1, or -1 for an instrument whose positive direction is the other one.
    scale
        Calibration of a raw column, for example newtons per volt.
    full_scale
        Largest magnitude of the instrument, in ``unit``; samples there are flagged as saturated.
    """

    name: str
    column: str
    unit: str | None = None
    sign: int = 1
    scale: float = 1.0
    full_scale: float | None = None


@dataclass(frozen=True)
class PhotocellColumn:
    """Where the photocell's edges are: a level column, a list of times, or a file of times.

    Attributes
    ----------
    column
        Column of the photocell's level; its edges are crossings of ``threshold``, interpolated.
    threshold
        Level of an edge in the column's own unit; ``None`` takes the middle of its extremes.
    edges_s
        Times of the edges in seconds, on the clock of the recording.
    edges_file
        CSV of such times, beside the recording; ``{stem}`` stands for the recording's name.
    """

    column: str | None = None
    threshold: float | None = None
    edge: Edge = Edge.RISING
    edges_s: tuple[float, ...] | None = None
    edges_file: str | None = None


@dataclass(frozen=True)
class TextLayout:
    """How the text is laid out; ``None`` lets the reader find out.

    Attributes
    ----------
    skip_rows
        Lines before the header.
    missing
        Cells that stand for a missing value, beside the empty cell and the usual ``NaN``, ``NA``.
    """

    separator: str | None = None
    decimal: str | None = None
    skip_rows: int = 0
    missing: tuple[str, ...] = ()


@dataclass(frozen=True)
class ColumnMap:
    """Which column of a text file is time, which are channels, which is the photocell.

    Attributes
    ----------
    channels
        The channels wanted; none means every column, as its header says.
    time
        The time column; ``None`` looks for one by its name, unless ``sample_rate_hz`` is given.
    sample_rate_hz
        Rate of samples without time stamps, or to be used in their place.
    keep_others
        Keep the columns that are not mapped too, as their headers say.
    origin
        The file or option the map came from, for messages and provenance.
    """

    channels: tuple[ChannelColumn, ...] = ()
    time: TimeColumn | None = None
    sample_rate_hz: float | None = None
    photocell: PhotocellColumn | None = None
    layout: TextLayout = field(default_factory=TextLayout)
    keep_others: bool = False
    origin: str = "column map"
