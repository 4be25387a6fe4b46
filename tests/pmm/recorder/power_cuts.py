"""Runs recorded on a faulty disk, and what a cut of the power at any step leaves of them."""

from bisect import bisect_right
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from analysis.readers import read_recording
from analysis.recording import Recording
from hardware.description.errors import DataError
from hardware.errors import HardwareError
from pmm.recorder.files import MARKER
from pmm.recorder.recovery import RecoveredRun, recover
from pmm.recorder.run_recorder import RunEnd, RunRecorder
from tests.pmm.recorder.faulty_disk import Faults, FaultyDisk
from tests.pmm.recorder.recorded import fed, header, truth

SYNCS: Final = 1200
BLOCK: Final = 10
TICK_S: Final = 0.005  # a batch every hundred samples: larger than a sector
CLOSING: Final = 12  # steps at the end, in which a run is closed: half of the cuts are there
# An honest disk twice as often as one that fails and ones that report too early.
DISKS: Final = (Faults(), Faults(), Faults(failing=0.05), Faults(late=0.3), Faults(late=1.0))


@dataclass(frozen=True)
class Recorded:
    """A run that was recorded on a faulty disk.

    Attributes
    ----------
    promised
        Step of the disk, and how many samples are promised to be on it from then on.
    """

    disk: FaultyDisk
    faults: Faults
    promised: tuple[tuple[int, int], ...]
    closed: bool

    def kept(self, steps: int) -> int:
        """Return how many samples have to be there after so many steps."""
        at = bisect_right([step for step, _ in self.promised], steps)
        return self.promised[at - 1][1] if at and self.faults.honest else 0


def record(seed: int, place: Path) -> Recorded:
    """Record a run on a disk with the faults that the seed stands for."""
    faults = DISKS[seed % len(DISKS)]
    disk, promised, closed = FaultyDisk(place, faults, seed), [], False
    place.mkdir(parents=True)
    with disk.watched():
        try:
            with RunRecorder(place, header()) as recorder:
                for first in range(1, SYNCS + 1, BLOCK):
                    fed(recorder, range(first, first + BLOCK), TICK_S)
                    while recorder._journal.behind:
                        pass
                    if not recorder._samples:
                        promised.append((len(disk.steps), first + BLOCK - 1))
                recorder.close(RunEnd.COMPLETE)
            promised.append((len(disk.steps), SYNCS))
            closed = True
        except (DataError, HardwareError, OSError):
            if promised:
                promised.pop()  # of what failed nothing was promised
    return Recorded(disk, faults, tuple(promised), closed)


def cut(run: Recorded, seed: int, place: Path) -> tuple[str, str]:
    """Cut the power at a step and recover; return what came of it, and what of that is wrong."""
    rng, steps = np.random.default_rng(seed), len(run.disk.steps)
    steps = int(rng.integers(max(1, steps - CLOSING) if rng.random() < 0.5 else 1, steps + 1))
    run.disk.image(steps, seed, place)
    is_marked, kept = (place / MARKER).exists(), run.kept(steps)
    try:
        found = recover(place)
    except DataError as error:
        return "nothing to recover", f"{kept} samples are lost: {error}" if kept else ""
    recording = read_recording(found.path)
    kind = "closed" if is_marked else "not closed"
    return kind, _wrong(recording, found, kept, is_marked=is_marked)


def _wrong(recording: Recording, found: RecoveredRun, kept: int, *, is_marked: bool) -> str:
    """Say what was lost of what was promised, or altered or lost unseen."""
    first = round(recording.start_s * recording.sample_rate_hz)
    values = recording.samples[:, 0 : recording.sample_count]
    there = ~np.isnan(values).any(axis=0)
    expected = truth(range(first, first + recording.sample_count))
    if not np.array_equal(values[:, there], expected[:, there]):
        return "values are not those that were recorded"
    numbers = np.flatnonzero(there) + first
    if lost := np.setdiff1d(np.arange(1, kept + 1), numbers).size:
        return f"{lost} samples of {kept} are lost"
    edges = [] if recording.photocell_edges_s is None else recording.photocell_edges_s.tolist()
    if not set(edges) <= {number + 0.0123 for number in range(1, SYNCS // 100 + 1)}:
        return "pulses are not those that were recorded"
    is_said = bool(found.changed) or bool(recording.flags)
    if not is_said and (numbers.size < SYNCS or not is_marked):
        return f"{SYNCS - numbers.size} samples are lost unseen"
    return ""
