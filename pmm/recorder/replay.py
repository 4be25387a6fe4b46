"""Runs a raw log through the live path again: the same decoding, the same resolver.

The rig is that of the run's own header, on a bus that plays ``bus.blf`` and ports that say the
lines of ``lines.jsonl`` again. Nothing is sent anywhere.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Any, Final

import numpy as np

from analysis.recording import FloatArray
from hardware.description.errors import DataError
from hardware.errors import DriveStateError, HardwareError, TransitionTimeoutError
from hardware.line_log import LoggedPort
from hardware.opening import carry_on
from hardware.pacing import FreeRunning
from hardware.playback import INTERFACE
from hardware.rig import Rig
from hardware.rig_configuration import RigConfiguration, read_rig
from hardware.roles import Pulse
from hardware.serial_port import PortSettings
from pmm.recorder.files import BUS, HARMONICS, LINES
from pmm.recorder.live_path import Gatherer, Taken
from pmm.recorder.recording import RunData, read_run
from pmm.recorder.resolving import largest_difference, resolve_again
from pmm.recorder.samples import JournalSamples, Piece

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

    @property
    def same(self) -> bool:
        """Whether samples and pulses are those of the run bit by bit, and the readings to 1e-12.

        A resolver that got its samples in other blocks rounds its sums in another way.
        """
        times = [one.time_s for one in self.pulses[: len(self.recorded_pulses_s)]]
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
        If the folder holds no samples, no raw log, or no rig to decode it with.
    ConfigurationError
        If the rig of the header cannot be built, because a driver is not installed for example.
    """
    run = read_run(folder)
    if run.samples is None:
        raise DataError(f"{folder}: holds no whole sample to compare a replay with")
    if not run.header.rig_tables:
        raise DataError(
            f"{folder}: its header does not say what the rig was; nothing can decode it"
        )
    tables = dict(run.header.rig_tables)
    if "bus" in tables:
        if not (folder / BUS).exists():
            raise DataError(f"{folder}: {BUS} is missing; without it nothing can be replayed")
        tables["bus"] = {
            **tables["bus"],
            "interface": INTERFACE,
            "channel": str(folder / BUS),
            "receive_thread": False,
            "options": {},
        }
    return _compare(run, run.samples, *_played(run, read_rig(tables, drivers)))


def _played(run: RunData, rig_of: RigConfiguration) -> tuple[list[Taken], list[str]]:
    """Run the log through a rig; return what each cycle brought, and the faults."""
    lines: dict[str, list[tuple[int, bytes]]] = {}
    for cycle, device, text in run.texts[LINES]:
        lines.setdefault(device, []).append((cycle, text.encode("latin-1")))
    rigs: list[Rig] = []

    def logged(name: str, _settings: PortSettings) -> LoggedPort:
        return LoggedPort(lines.get(name, ()), lambda: rigs[0].number)

    taken, faults = [], []
    with Rig(rig_of, lambda: 0.0, FreeRunning(), lambda _: None, ports=logged) as rig:
        rigs.append(rig)
        rig.number = run.header.first_sync - 1
        carry_on(rig, run.header.opening)
        path = Gatherer(rig, run.header.first_sync)
        for _ in range(_cycles(run)):
            try:
                rig.cycle()
            except (DriveStateError, TransitionTimeoutError):
                pass  # the replayed drives follow the run's commands, not this rig's
            except HardwareError as error:
                faults.append(str(error))
            taken.append(path.step(rig.number))
        taken.append(path.finish())
    return taken, faults


def _cycles(run: RunData) -> int:
    """Return how many cycles the run's samples, pulses and lines reach over."""
    samples = run.samples
    last = 0 if samples is None else samples.first_sync + samples.sample_count - 1
    heard = int(run.texts[LINES][-1][0]) if run.texts[LINES] else 0
    return max(last, heard) - run.header.first_sync + 4


def _compare(
    run: RunData, samples: JournalSamples, taken: list[Taken], faults: list[str]
) -> Replay:
    recorded = samples[:, 0 : samples.sample_count]
    again = _spread([one for each in taken for one in each.samples], recorded, samples.first_sync)
    differing = ~((again == recorded) | (np.isnan(again) & np.isnan(recorded)))
    told, again_read = tuple(run.texts[HARMONICS]), resolve_again(run, taken)
    return Replay(
        again,
        recorded,
        int(np.sum(differing)),
        tuple(one for each in taken for one in each.pulses),
        run.pulses_s,
        again_read,
        told,
        largest_difference(told, again_read),
        tuple(faults),
    )


def _spread(pieces: list[Piece], like: FloatArray, first: int) -> FloatArray:
    """Put stretches at their places among samples of a shape."""
    found = np.full(like.shape, np.nan)
    for start, values in pieces:
        at = np.arange(start, start + values.shape[1]) - first
        inside = (at >= 0) & (at < like.shape[1])
        found[:, at[inside]] = values[:, inside]
    return found
