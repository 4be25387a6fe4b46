"""What run control wants of a recorder, and the tap that hands it the frames of the bus."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

from hardware.description.arrays import FloatArray
from hardware.description.flags import Flag
from hardware.raw_log import Frame
from hardware.roles import Pulse
from pmm.recorder.lateness import CycleStatistics
from pmm.recorder.run_recorder import RunEnd, RunRecorder


class RunJournal(Protocol):
    """Keeps a run; :class:`pmm.recorder.run_recorder.RunRecorder` does it on disk."""

    @property
    def has_files(self) -> bool:
        """Whether there is something to keep, and to recover if it cannot be closed."""
        ...

    def opened(self, *, wait: bool) -> bool:
        """Tell whether it is open; with ``wait`` when it is. Raise if it cannot be."""
        ...

    def samples(self, first_sync: int, values: FloatArray) -> None:
        """Keep consecutive samples, shape ``(channels, n)``."""
        ...

    def pulse(self, pulse: Pulse) -> None:
        """Keep a pulse of the photocell."""
        ...

    def event(self, cycle: int, time_s: float, kind: str, text: str) -> None:
        """Keep an event of the run: its cycle, time in seconds, kind and text."""
        ...

    def harmonic(self, reading: Mapping[str, Any]) -> None:
        """Keep a final reading of the live resolver."""
        ...

    def cycle_statistics(self, lateness_s: float) -> None:
        """Keep how late a cycle began."""
        ...

    def statistics(self) -> CycleStatistics:
        """Return how late the cycles were so far."""
        ...

    def tick(self, now_s: float) -> None:
        """Flush what is due by the monotonic clock."""
        ...

    def close(self, outcome: RunEnd, flags: Sequence[Flag]) -> Path:
        """Complete the run; return its recording."""
        ...


class Taps:
    """Observers of bus and serial lines that hand on to the present recorder, if there is one."""

    def __init__(self) -> None:
        self.recorder: RunRecorder | None = None

    def frame(self, frame: Frame) -> None:
        """Take a frame of the bus."""
        if self.recorder is not None:
            self.recorder.frame(frame)

    def line(self, cycle: int, device: str, data: bytes) -> None:
        """Take a line of a serial device."""
        if self.recorder is not None:
            self.recorder.line(cycle, device, data)
