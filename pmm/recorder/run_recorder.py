"""Records a run into a folder of its own, so that a crash at any moment costs a second at most.

The loop hands everything in and calls :meth:`RunRecorder.tick` once a cycle; nothing of it waits
for the disk, the opening of the files neither. ``docs/recording-safety.md`` describes the folder.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from enum import StrEnum
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError, PmmError
from hardware.description.flags import Flag
from hardware.raw_log import Frame, FramePacker, container, file_header
from hardware.roles import Pulse
from pmm.recorder.disk import DiskFullError, DiskWatch
from pmm.recorder.files import (
    BUS,
    CYCLES,
    EVENTS,
    HARMONICS,
    HEADER,
    LINES,
    MARKER,
    PULSES,
    SAMPLES,
    check_empty,
)
from pmm.recorder.header import RunHeader
from pmm.recorder.journal import Journal, Piece
from pmm.recorder.lateness import CycleStatistics, Lateness
from pmm.recorder.line_shapes import as_line
from pmm.recorder.recording import convert, marker_text, read_run
from pmm.recorder.samples import Piece as SamplePiece
from pmm.recorder.samples import SampleWriter
from pmm.whole_file import write_whole

_SHARE: Final = 0.5  # of flush_s: what is left of it is for the disk
_MOST_BEHIND: Final = 120  # hand-overs that may wait for a disk that has stopped answering


class RecordingStalledError(DataError):
    """The disk takes nothing any more: what is recorded now would be lost."""


class RunEnd(StrEnum):
    """How a recorded run ended, as its file says."""

    COMPLETE = "complete"
    STOPPED = "stopped"  # by the operator
    FAULT = "fault"


class RunRecorder:
    """Records one run; use it in a ``with`` block, which waits until the files are there.

    Without one, :meth:`opened` tells; what comes in the meantime is kept until then.

    Left without :meth:`close`, the journals stay as they are, without a completion marker: what a
    crash leaves, and ``pmm recover`` makes a recording of.

    Parameters
    ----------
    folder
        Made if it is not there; it must not hold a run.
    flush_s
        After so long at the latest everything is on the disk.
    disk
        Watches the room on the disk.
    admit
        Called before the folder is made, like all that is done to the disk in the journal's thread:
        refuses the run by raising, or completes the header.

    Attributes
    ----------
    header
        Complete once the recorder has opened.
    """

    def __init__(
        self,
        folder: Path,
        header: RunHeader,
        *,
        flush_s: float = 1.0,
        disk: DiskWatch | None = None,
        admit: Callable[[RunHeader], RunHeader] = lambda header: header,
    ) -> None:
        self.folder = folder
        self.header = header
        self._disk = disk
        self._every_s = _SHARE * flush_s
        self._due_s: float | None = None
        self._short: DiskFullError | None = None
        self._frames = FramePacker()
        self._samples: list[SamplePiece] = []
        self._texts: dict[str, list[bytes]] = {}
        self._next_sync = 0
        self._late = Lateness(1.0 / header.sample_rate_hz)
        self._closed = False
        self._journal = Journal(folder, partial(self._open, admit))
        self.frame: Callable[[Frame], None] = self._frames.take
        self.cycle_statistics: Callable[[float], None] = self._late.add

    def __enter__(self) -> "RunRecorder":
        try:
            self.opened(wait=True)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        if self._closed:
            return
        self._closed = True
        try:
            self._hand_over()
        except PmmError:
            pass  # the journal knows, and nothing is to hide what ended the block
        finally:
            self._journal.close()

    def opened(self, *, wait: bool) -> bool:
        """Tell whether the run's files are there.

        Parameters
        ----------
        wait
            Until they are; a loop that keeps time does not.

        Raises
        ------
        RunExistsError
            If the folder holds a run.
        DiskFullError, DataError
            If the files cannot be made.
        PmmError
            Whatever ``admit`` raises.
        """
        return self._journal.opened(wait=wait)

    @property
    def has_files(self) -> bool:
        """Whether the run has files of its own: there is something to keep."""
        return self._journal.has_files

    def samples(self, first_sync: int, values: FloatArray) -> None:
        """Take samples of consecutive SYNCs; shape ``(channels, n)``, NaN where there is none.

        Raises
        ------
        DataError
            If the number of channels is wrong or a SYNC comes twice; a gap is kept as one.
        """
        if values.ndim != 2 or values.shape[0] != len(self.header.channels):
            raise DataError(
                f"samples of shape {values.shape} do not fit {len(self.header.channels)} channels"
            )
        if first_sync < self._next_sync:
            raise DataError(
                f"the sample of SYNC {first_sync} comes again; the next one is {self._next_sync}"
            )
        if values.shape[1]:
            self._next_sync = first_sync + values.shape[1]
            self._samples.append((first_sync, values))

    def pulse(self, pulse: Pulse) -> None:
        """Take a pulse of the photocell."""
        angle = pulse.shaft_angle_rad
        angle_rad = None if np.isnan(angle) else angle
        self._say(PULSES, [pulse.number, pulse.time_s, angle_rad])

    def event(self, cycle: int, time_s: float, kind: str, text: str) -> None:
        """Take an event: a change of state, an alarm, what the operator answered."""
        self._say(EVENTS, {"cycle": cycle, "time_s": time_s, "kind": kind, "text": text})

    def harmonic(self, reading: Mapping[str, Any]) -> None:
        """Take a final reading, as :func:`pmm.recorder.live_path.as_record` makes it."""
        self._say(HARMONICS, dict(reading))

    def line(self, cycle: int, device: str, data: bytes) -> None:
        """Take a line of a serial device."""
        self._say(LINES, [cycle, device, data.decode("latin-1")])

    def statistics(self) -> CycleStatistics:
        """Return how late the cycles were so far."""
        return self._late.statistics()

    def tick(self, now_s: float) -> None:
        """Hand everything to the disk when it is time.

        Parameters
        ----------
        now_s
            Seconds of a monotonic clock: the wall's, because that is what the promise is about.

        Raises
        ------
        DiskFullError
            If there is no room left; the run has to stop, what is written stays.
        RecordingStalledError
            If the disk has stopped answering.
        """
        if self._due_s is None:
            self._due_s = now_s + self._every_s
        if now_s < self._due_s:
            return
        self._due_s = now_s + self._every_s
        self._hand_over(None if self._disk is None else partial(self._look, self._disk))
        if self._journal.behind > _MOST_BEHIND:
            behind_s = self._journal.behind * self._every_s
            raise RecordingStalledError(
                f"{self.folder}: the disk is {behind_s:.0f} s behind; stop and look at it"
            )
        if self._short is not None:
            raise self._short.with_traceback(None)

    def close(self, outcome: RunEnd, flags: Sequence[Flag] = ()) -> Path:
        """Write the completion marker and the recording as NetCDF; return its path.

        Raises
        ------
        DiskFullError
            If there was or is no room; the journals stay, and so does what they hold.
        DataError
            If there is nothing to make a recording of.
        """
        try:
            return self._close(outcome, flags)
        finally:
            self._closed = True
            self._journal.close()

    def _close(self, outcome: RunEnd, flags: Sequence[Flag]) -> Path:
        self.frame = _let_go  # the loop may go on while another thread closes
        self._hand_over()
        self._journal.finish()
        self._journal.check()
        frames, unpacked = self._frames.frames, self._frames.unpacked_bytes
        size = (self.folder / BUS).stat().st_size
        self._journal.replace_head(BUS, file_header(size, unpacked, frames))
        run = read_run(self.folder)
        text = marker_text(run, outcome, flags, self._journal.contents(), frames)
        write_whole(self.folder / MARKER, text)
        return convert(replace(run, marker=json.loads(text)))

    def _open(self, admit: Callable[[RunHeader], RunHeader]) -> Mapping[str, bytes]:
        """Make the folder and its header; return what the streams begin with."""
        self.header = admit(self.header)
        self.folder.mkdir(parents=True, exist_ok=True)
        check_empty(self.folder)
        write_whole(self.folder / HEADER, self.header.to_json())
        self._writer = SampleWriter(self.header)
        return {SAMPLES: self._writer.head(), BUS: file_header()}

    def _look(self, disk: DiskWatch) -> None:
        """Look how much room is left; the next :meth:`tick` says it."""
        try:
            disk.check_during(self._journal.size)
            self._short = None
        except DiskFullError as error:
            self._short = error

    def _batch(self, taken: list[SamplePiece]) -> bytes:
        return self._writer.batch(taken)

    def _say(self, name: str, value: object) -> None:
        self._texts.setdefault(name, []).append(as_line(value))

    def _hand_over(self, then: Callable[[], None] | None = None) -> None:
        """Give what has come to the journal's thread; ``then`` is called in it afterwards."""
        pieces: list[tuple[str, Piece]] = []
        if self._samples:
            taken, self._samples = self._samples, []
            pieces.append((SAMPLES, partial(self._batch, taken)))
        pieces += [(BUS, partial(container, objects)) for objects in self._frames.drain()]
        texts, self._texts = self._texts, {}
        for name, lines in texts.items():
            pieces.append((name, partial(b"".join, lines)))
        delays = self._late.statistics()
        if delays.cycles:
            line = as_line([delays.cycles, delays.p50_s, delays.p99_s, delays.worst_s, delays.late])
            pieces.append((CYCLES, lambda: line))
        self._journal.hand_over(pieces, then)


def _let_go(_frame: Frame) -> None:
    """Take no notice of a frame after the run."""
