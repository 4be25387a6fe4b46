"""Makes a recording of whatever a crash left of a run. Nothing that is there is ever destroyed."""

import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Any

from hardware.description.errors import DataError, PmmError
from hardware.description.flags import Flag, Severity
from hardware.raw_log import file_header
from hardware.raw_log_reading import LogState, look
from pmm.recorder.campaign_owner import own_campaign
from pmm.recorder.disk import DiskFullError
from pmm.recorder.file_changes import change_flags, changed_files, files_recovered
from pmm.recorder.files import (
    BUS,
    HEADER,
    MARKER,
    PULSES,
    RECORDING,
    RECOVERED,
    SAMPLES,
    STREAMS,
    contents_of,
    is_run,
    set_aside,
)
from pmm.recorder.journal_reconstruction import rebuild
from pmm.recorder.line_shapes import read_recovered
from pmm.recorder.pulse_comparison import doubtful_pulses
from pmm.recorder.recording import RunData, convert, read_run
from pmm.recorder.samples import SampleWriter, counts
from pmm.whole_file import write_whole


@dataclass(frozen=True)
class RecoveredRun:
    """What was made of a run.

    Attributes
    ----------
    path
        The recording.
    samples, missing
        Samples of each channel; SYNCs between the first and the last that are not there (NaN).
    frames
        Whole frames of the raw log.
    lost_tail_bytes
        Bytes at the ends of files that are not whole, by file.
    was_whole
        Whether the run had been closed and its recording was there: nothing was to do.
    flags
        What was noticed.
    changed
        Files that were not what was written.
    """

    path: Path
    samples: int
    missing: int
    frames: int
    lost_tail_bytes: Mapping[str, int]
    was_whole: bool
    flags: tuple[Flag, ...]
    changed: tuple[str, ...] = ()


class NothingWrittenError(DataError):
    """A run of which nothing had been recorded when its program ended."""


def _check_written(run: RunData) -> None:
    """Refuse a run, never closed, that has no more than what its recorder begins its files with."""
    if run.samples is not None or run.marker is not None or not (run.folder / HEADER).exists():
        return
    begun = {SAMPLES: SampleWriter(run.header).head(), BUS: file_header()}
    if all(_is_begun(run.folder / name, begun.get(name, b"")) for name in STREAMS):
        raise NothingWrittenError(
            f"{run.folder}: its recorder was opened, and the program ended before anything was "
            "written: there is nothing to recover, and nothing is lost"
        )


def _is_begun(path: Path, head: bytes) -> bool:
    """Whether a file is not there, or the beginning of what it begins with."""
    if not path.exists():
        return True
    return path.stat().st_size <= len(head) and head.startswith(path.read_bytes())


def runs_in(place: Path) -> tuple[Path, ...]:
    """Return the folders of runs: the place itself, or those in a campaign's folder, by name.

    Raises
    ------
    DataError
        If there are none.
    """
    if is_run(place):
        return (place,)
    folders = (
        sorted(folder for folder in place.iterdir() if is_run(folder)) if place.is_dir() else []
    )
    if not folders:
        raise DataError(f"{place}: holds no run: no {SAMPLES}, {BUS} or header in it or below it")
    return tuple(folders)


def recover(folder: Path, drivers: Iterable[EntryPoint] | None = None) -> RecoveredRun:
    """Make a recording of a run's folder, however the run ended; the same again does nothing.

    What the samples' journal has lost is decoded again from the raw log; a file that is not what
    was written is kept under another name where one is made in its place.

    Parameters
    ----------
    drivers
        Where the rig's drivers are looked for then; all installed ones by default.

    Raises
    ------
    OwnedElsewhereError
        If another process is writing into the run's campaign.
    NothingWrittenError
        If nothing had been recorded yet.
    DataError
        If there is no whole sample in it, and none to be decoded.
    DiskFullError
        If there is no room for the recording.
    """
    with own_campaign(folder.resolve().parent):
        run = read_run(folder)
        log = look(folder / BUS) if (folder / BUS).exists() else LogState(0, 0)
        changed = changed_files(run)
        is_recorded = (folder / RECORDING).exists() and RECORDING not in changed
        if is_recorded and not changed:
            return _outcome(run, log, _flags_before(folder), was_whole=run.marker is not None)
        _check_written(run)
        damage = changed.pop(RECORDING, None)
        flags, made = (*_torn(run, log), *change_flags(changed)), files_recovered(folder)
        doubt = doubtful_pulses(run)
        if _has_lost(run) or doubt:
            run, flags, made = _rebuilt(run, flags, made, drivers, doubt)
        if not is_recorded:
            set_aside(folder / RECORDING)
            convert(run, flags)
        if damage is not None:
            changed |= {RECORDING: damage}
            flags += change_flags({RECORDING: damage})
        outcome = _outcome(run, log, flags, was_whole=False, changed=tuple(changed))
        write_whole(folder / RECOVERED, _text(outcome, made))
        return outcome


def _has_lost(run: RunData) -> bool:
    """Tell whether samples were written that are not whole."""
    if run.samples is None or run.samples.changes:
        return True
    last = run.samples.first_sync + run.samples.sample_count - 1
    return run.marker is not None and last < run.marker.get("last_sync", last)


def _rebuilt(
    run: RunData,
    flags: tuple[Flag, ...],
    made: Mapping[str, Any],
    drivers: Iterable[EntryPoint] | None,
    doubt: str,
) -> tuple[RunData, tuple[Flag, ...], dict[str, Any]]:
    """Decode what was lost from the raw log; where that cannot be, what is whole has to do."""
    is_short = _has_lost(run)
    try:
        made_flags, names = rebuild(run, drivers, samples=is_short)
    except PmmError as error:
        if run.samples is None or isinstance(error, DiskFullError):
            raise
        losses = {"samples_lost": f"what {SAMPLES} has lost"} if is_short else {}
        if doubt and run.texts[PULSES]:  # without any, nothing tells whether there were some
            losses["pulses_lost"] = f"pulses that {PULSES} may have lost ({doubt})"
        lost = (
            Flag(code, Severity.WARNING, f"{words} cannot be decoded again: {error}")
            for code, words in losses.items()
        )
        return run, (*flags, *lost), dict(made)
    contents = {name: contents_of(run.folder / name) for name in names}
    return read_run(run.folder), (*flags, *made_flags), {**made, **contents}


def _torn(run: RunData, log: LogState) -> tuple[Flag, ...]:
    """Say what is not whole of a run that was not closed."""
    if run.marker is not None:
        return ()
    tails = {name: size for name, size in {**run.tails, BUS: log.tail_bytes}.items() if size}
    torn = ", ".join(f"{size} bytes of {name}" for name, size in tails.items()) or "nothing"
    message = (
        f"the run was not closed ({MARKER} is missing); made of its journals up to the last whole "
        f"batch; not whole: {torn}"
    )
    return (Flag("recovered", Severity.WARNING, message),)


def _outcome(
    run: RunData,
    log: LogState,
    flags: tuple[Flag, ...],
    *,
    was_whole: bool,
    changed: tuple[str, ...] = (),
) -> RecoveredRun:
    totals = counts(run.samples) if run.samples else {"samples": 0, "missing": 0}
    return RecoveredRun(
        run.folder / RECORDING,
        totals["samples"],
        totals["missing"],
        log.frames,
        {name: size for name, size in {**run.tails, BUS: log.tail_bytes}.items() if size},
        was_whole,
        flags,
        changed,
    )


def _text(outcome: RecoveredRun, made: Mapping[str, Any]) -> str:
    return json.dumps({**asdict(outcome), "path": outcome.path.name, "files": made}, indent=1)


def _flags_before(folder: Path) -> tuple[Flag, ...]:
    """Return what an earlier recovery noticed."""
    return tuple(map(Flag.read, read_recovered(folder).get("flags", ())))
