"""Recordings in and out: text of any system by a column map, and NetCDF4 as this project keeps it.

Every reader returns an :class:`analysis.recording.Recording`: evenly spaced samples in SI units,
with flags for everything that was noticed or repaired. ``docs/formats.md`` lists keys, units,
attributes and flag codes.
"""

from analysis.readers.columns import (
    ChannelColumn,
    ColumnMap,
    Edge,
    PhotocellColumn,
    TextLayout,
    TimeColumn,
)
from analysis.readers.dataset import from_dataset, to_dataset
from analysis.readers.netcdf import write_recording
from analysis.readers.reader import read_recording

__all__ = [
    "ChannelColumn",
    "ColumnMap",
    "Edge",
    "PhotocellColumn",
    "TextLayout",
    "TimeColumn",
    "from_dataset",
    "read_recording",
    "to_dataset",
    "write_recording",
]
