"""A recording from text: columns to channels in SI units on an even grid."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

from analysis.readers.clock import CLOCK, past_midnight
from analysis.readers.columns import ColumnMap, PhotocellColumn
from analysis.readers.conditioning import repair_missing, saturation_flags, without_spikes
from analysis.readers.headers import Header
from analysis.readers.missing_values import with_missing_said, without_beyond
from analysis.readers.photocell import check_edges, edge_flags, edges_of_level, read_edges
from analysis.readers.reader import Reader
from analysis.readers.text_layout import find_layout
from analysis.readers.text_plan import ColumnPlan, plan_columns, time_factor, without_idle
from analysis.readers.text_source import Progress, TextSource
from analysis.readers.text_table import read_numbers
from analysis.readers.time_base import TimeBase, fit_time_base
from analysis.recording import Recording
from hardware.description.arrays import FloatArray
from hardware.description.flags import Flag

Table = Mapping[Header, FloatArray]


@dataclass(frozen=True)
class Origin:
    """Where columns come from.

    Attributes
    ----------
    name
        Of the recording.
    reader
        Which one read them.
    sha256
        Of the whole file.
    """

    path: Path
    name: str
    reader: str
    sha256: str


def read_text_recording(path: Path, columns: ColumnMap, name: str, progress: Progress) -> Recording:
    """Read a recording from a text file; see :func:`analysis.readers.read_recording`."""
    source = TextSource(path, progress)
    layout = find_layout(source, columns.layout)
    plan = plan_columns(layout.headers, columns, str(path))
    numbers = read_numbers(source, layout, plan.wanted)
    origin = Origin(path, name, "csv", numbers.sha256)
    return from_columns(plan, numbers.columns, columns, origin, numbers.flags)


READER: Final = Reader(read_text_recording, text=True)


def from_columns(
    plan: ColumnPlan,
    table: Table,
    columns: ColumnMap,
    origin: Origin,
    noticed: tuple[Flag, ...] = (),
) -> Recording:
    """Return a recording of columns of numbers, whatever file they stood in.

    It raises what :func:`analysis.readers.read_recording` raises.

    Parameters
    ----------
    table
        At least the plan's wanted columns, all of one length.
    noticed
        What the file's own reader says of it.
    """
    path, where = origin.path, str(origin.path)
    plan = without_idle(plan, table, where)
    base = _time_base(plan, table, columns, where)
    resolved = [channel.resolve() for channel in plan.channels]
    channels = tuple(channel for channel, _, _ in resolved)
    samples = np.empty((len(channels), base.sample_count))
    for row, part, (_, factor, _) in zip(samples, plan.channels, resolved, strict=True):
        np.multiply(_on_grid(table[part.header], base), factor, out=row)
    edges, edges_flags = _edges(columns.photocell, plan, table, base, path, origin.name)
    read = Recording(
        name=origin.name,
        channels=channels,
        samples=samples,
        sample_rate_hz=base.sample_rate_hz,
        start_s=base.start_s,
        photocell_edges_s=edges,
        provenance=_provenance(origin, columns),
        flags=(
            *noticed,
            *plan.flags,
            *base.flags,
            *(flag for _, _, flags in resolved for flag in flags),
            *edges_flags,
        ),
        stamps_s=base.stamps_s,
    )
    return _repaired(read, samples, where)


def _repaired(read: Recording, samples: FloatArray, where: str) -> Recording:
    """Return a recording without spikes and short gaps, where samples are evenly spaced."""
    if read.stamps_s is not None:
        flagged = with_missing_said(read)
        return replace(flagged, flags=(*flagged.flags, *saturation_flags(samples, read.channels)))
    recording, channels = without_spikes(without_beyond(read)), read.channels
    for number, row in enumerate(samples):
        row[:] = recording.samples[number : number + 1, 0 : recording.sample_count][0]
    flags = (
        *recording.flags,
        *repair_missing(samples, channels, where),
        *saturation_flags(samples, channels),
    )
    return replace(recording, samples=samples, flags=flags)


def _time_base(plan: ColumnPlan, table: Table, columns: ColumnMap, where: str) -> TimeBase:
    """Return the grid of the time stamps, or of the given rate where there is one."""
    flags: tuple[Flag, ...] = ()
    time_s = np.zeros(1)
    if plan.time is not None:
        factor, flags = time_factor(plan.time, columns.time, table[plan.time], where)
        time_s = table[plan.time] * factor
        if plan.time.unit == CLOCK:
            time_s, passed = past_midnight(time_s)
            flags += passed
    if columns.sample_rate_hz is None:
        base = fit_time_base(time_s, where)
        return replace(base, flags=flags + base.flags)
    start = float(time_s[0]) if np.isfinite(time_s[0]) else 0.0
    rows = next(iter(table.values())).size
    return TimeBase(start, columns.sample_rate_hz, rows, None, flags)


def _on_grid(values: FloatArray, base: TimeBase) -> FloatArray:
    """Put rows at their places; missing rows become NaN."""
    if base.places is None:
        return values
    row = np.full(base.sample_count, np.nan)
    row[base.places] = values
    return row


def _edges(
    photocell: PhotocellColumn | None,
    plan: ColumnPlan,
    table: Table,
    base: TimeBase,
    path: Path,
    name: str,
) -> tuple[FloatArray | None, tuple[Flag, ...]]:
    """Return the photocell's edges in seconds, and what is to be said of them."""
    if photocell is None:
        return None, ()
    if plan.photocell is not None:
        level = _on_grid(table[plan.photocell], base)
        places = edges_of_level(level, photocell.threshold, photocell.edge)
        if base.stamps_s is not None:
            edges = np.interp(places, np.arange(base.sample_count), base.stamps_s)
        else:
            edges = base.start_s + places / base.sample_rate_hz
        return edges, edge_flags(edges, 1.0 / base.sample_rate_hz)
    if photocell.edges_file is not None:
        edges = read_edges(path.parent / photocell.edges_file.replace("{stem}", name))
    else:
        edges = check_edges(np.array(photocell.edges_s or (), dtype=np.float64), str(path))
    return edges, edge_flags(edges, None)


def _provenance(origin: Origin, columns: ColumnMap) -> dict[str, str]:
    return {
        "reader": origin.reader,
        "source_file": origin.path.name,
        "sha256": origin.sha256,
        "column_map": columns.origin,
    }
