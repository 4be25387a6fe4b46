"""Makes lost journals of samples and pulses again out of the raw log, which holds all of them."""

import os
from collections.abc import Iterable, Sequence
from importlib.metadata import EntryPoint
from pathlib import Path

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity
from hardware.roles import Pulse
from pmm.recorder.decoding import decode
from pmm.recorder.disk import DiskFullError, free_bytes
from pmm.recorder.files import BUS, LINES, PULSES, SAMPLES, set_aside
from pmm.recorder.line_shapes import as_line
from pmm.recorder.live_path import CycleSamples, joined_samples
from pmm.recorder.pulse_comparison import compare_pulses, united_pulses
from pmm.recorder.recording import RunData, marker_is_whole
from pmm.recorder.samples import SampleWriter
from pmm.whole_file import write_whole


def rebuild(
    run: RunData, drivers: Iterable[EntryPoint] | None = None, *, samples: bool = True
) -> tuple[tuple[Flag, ...], tuple[str, ...]]:
    """Write ``samples.arrows`` from the raw log, and ``pulses.jsonl`` where that is lost as well.

    They are decoded by the same code as in the run, so they are the same bit by bit; those that are
    whole stay. The bytes of a damaged file are kept under another name.

    It returns what was done, and the names of the files that were made.

    Parameters
    ----------
    samples
        Whether ``samples.arrows`` has lost any.

    Raises
    ------
    DataError
        If the raw log holds no sample either, or nothing says how to decode it; nothing is changed.
    DiskFullError
        If there is no room for them.
    ConfigurationError
        If the run's rig cannot be built, because a driver is not installed for example.
    """
    try:
        taken, _ = decode(run, drivers)
    except DataError as error:
        words = "lost samples or pulses" if run.samples else "no whole sample, and none"
        raise DataError(f"{run.folder}: holds {words} can be decoded: {error}") from error
    lost: dict[str, str] = {}
    if samples:
        first, values = _with_whole(run, run.header.first_sync, _samples(run, taken))
        _check_room(run.folder, values)
        set_aside(run.folder / SAMPLES)
        _write_samples(run, first, values)
        lost[SAMPLES] = "samples_rebuilt"
    pulses = [pulse for each in taken for pulse in each.pulses]
    if _has_lost_pulses(run, pulses, len(taken)):
        set_aside(run.folder / PULSES)
        rows = united_pulses(run.texts[PULSES], pulses)
        write_whole(run.folder / PULSES, "".join(as_line(row).decode() for row in rows))
        lost[PULSES] = "pulses_rebuilt"
    flags = (
        Flag(
            code,
            Severity.WARNING,
            f"what {name} had lost is decoded again from the raw log ({BUS})",
        )
        for name, code in lost.items()
    )
    return tuple(flags), tuple(lost)


def _has_lost_pulses(run: RunData, pulses: Sequence[Pulse], cycles: int) -> bool:
    """Tell whether the journal lacks pulses; that of a run that was closed is its marker's."""
    if not (run.folder / PULSES).exists():
        return True
    end_s = (run.header.first_sync + cycles - 1) / run.header.sample_rate_hz
    return run.marker is None and not compare_pulses(run.texts[PULSES], pulses, end_s).same


def _check_room(folder: Path, values: FloatArray) -> None:
    need, free = 8 * (values.shape[0] + 1) * values.shape[1], free_bytes(folder)
    if free < need:
        raise DiskFullError(
            f"{folder / SAMPLES}: needs {need / 1e6:.1f} MB, {free / 1e6:.1f} MB are free; "
            f"make room, then: pmm recover {folder}"
        )


def _with_whole(run: RunData, first: int, decoded: FloatArray) -> tuple[int, FloatArray]:
    """Return the first SYNC and all samples, those of the journal where they are whole."""
    if run.samples is None:
        return first, decoded
    marker = run.marker if run.marker is not None and marker_is_whole(run.marker) else {}
    samples = run.samples
    last = samples.first_sync + samples.sample_count - 1
    begin = marker.get("first_sync", min(first, samples.first_sync))
    end = marker.get("last_sync", max(first + decoded.shape[1] - 1, last))
    values = np.full((decoded.shape[0], end - begin + 1), np.nan)
    for start, part in ((first, decoded), (samples.first_sync, samples[:, :])):
        skipped = max(begin - start, 0)
        overlap = part[:, skipped : end + 1 - start]
        place = values[:, start + skipped - begin :][:, : overlap.shape[1]]
        np.copyto(place, overlap, where=~np.isnan(overlap))
    return begin, values


def _samples(run: RunData, taken: Sequence[CycleSamples]) -> FloatArray:
    """Return all samples that were decoded."""
    values = joined_samples(taken, len(run.header.channels))
    if np.isnan(values).all():
        raise DataError(f"{run.folder}: holds no whole sample, and neither do {BUS} and {LINES}")
    return values


def _write_samples(run: RunData, first: int, values: FloatArray) -> None:
    """Write the stream so that it is there whole or not at all; a SYNC without values is a gap."""
    writer = SampleWriter(run.header)
    places = np.flatnonzero(~np.isnan(values).all(axis=0))
    stretches = np.split(places, np.flatnonzero(np.diff(places) > 1) + 1)
    part = run.folder / f".{SAMPLES}.part"
    with part.open("wb") as file:
        file.write(writer.head())
        file.write(writer.batch([(first + int(at[0]), values[:, at]) for at in stretches]))
        file.flush()
        os.fsync(file.fileno())
    part.replace(run.folder / SAMPLES)
