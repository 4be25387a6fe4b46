"""Runs a raw log through the live path again: the same decoding, the same resolver."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Any, Final

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from hardware.roles import Pulse
from pmm.recorder.campaign_owner import writer_of
from pmm.recorder.decoding import decode
from pmm.recorder.file_changes import changed_files
from pmm.recorder.files import HARMONICS
from pmm.recorder.live_path import Taken, joined
from pmm.recorder.recording import RunData, read_run
from pmm.recorder.resolving import largest_difference, resolve_again
from pmm.recorder.samples import JournalSamples

SAME_READING: Final = 1e-12


@dataclass(frozen=True)
class Replay:
    """What came out of the raw log, beside what the run had written.

    Attributes
    ----------
    samples
        Those of the replay, shape ``(channels, n)``, from the run's first SYNC on; NaN where none.
    recorded
        Those of the journal at the same SYNCs.
    differing_samples
        Values that are not the same bit by bit, a NaN being the same as a NaN.
    pulses, recorded_pulses_s
        Pulses of the replay, and their times in the journal.
    readings, recorded_readings
        Final readings of the resolver, as the journal keeps them; ``None`` where a recorded one
        did not come again.
    difference
        Largest difference of a coefficient, over the largest of its channel.
    faults
        What the devices reported again, in words.
    changed
        File of the run to what of it is not what was written, in words.
    """

    samples: FloatArray
    recorded: FloatArray
    differing_samples: int
    pulses: tuple[Pulse, ...]
    recorded_pulses_s: FloatArray
    readings: tuple[Mapping[str, Any] | None, ...]
    recorded_readings: tuple[Mapping[str, Any], ...]
    difference: float
    faults: tuple[str, ...]
    changed: Mapping[str, str]

    @property
    def same(self) -> bool:
        """Whether samples and pulses are those of the run bit by bit, and the readings to 1e-12.

        A resolver that got its samples in other blocks rounds its sums in another way.
        """
        times = [pulse.time_s for pulse in self.pulses[: len(self.recorded_pulses_s)]]
        return (
            self.differing_samples == 0
            and times == self.recorded_pulses_s.tolist()
            and self.difference <= SAME_READING
        )


def replay(folder: Path, drivers: Iterable[EntryPoint] | None = None) -> Replay:
    """Replay a run.

    Parameters
    ----------
    drivers
        Where the rig's drivers are looked for; all installed ones by default.

    Raises
    ------
    DataError
        If the folder holds no samples, no raw log, or no rig to decode it with, or the run is being
        recorded.
    ConfigurationError
        If the rig of the header cannot be built, because a driver is not installed for example.
    """
    run = read_run(folder)
    writer = writer_of(folder.resolve().parent)
    if run.marker is None and writer is not None:
        raise DataError(f"{folder}: is being recorded by {writer}; replay it when it has ended")
    if run.samples is None:
        raise DataError(f"{folder}: holds no whole sample to compare a replay with")
    return _compare(run, run.samples, *decode(run, drivers))


def _compare(
    run: RunData, samples: JournalSamples, taken: list[Taken], faults: list[str]
) -> Replay:
    recorded = samples[:, 0 : samples.sample_count]
    again = np.full(recorded.shape, np.nan)
    skipped = samples.first_sync - run.header.first_sync
    decoded = joined(taken, recorded.shape[0])[:, skipped : skipped + samples.sample_count]
    again[:, : decoded.shape[1]] = decoded
    differing = ~((again == recorded) | (np.isnan(again) & np.isnan(recorded)))
    told, again_read = tuple(run.texts[HARMONICS]), resolve_again(run, taken)
    return Replay(
        again,
        recorded,
        int(np.sum(differing)),
        tuple(pulse for each in taken for pulse in each.pulses),
        run.pulses_s,
        again_read,
        told,
        largest_difference(told, again_read),
        tuple(faults),
        changed_files(run),
    )
