"""Decodes a raw log again, with the rig of the run's own header.

The rig stands on a bus that plays ``bus.blf`` and on ports that say the lines of ``lines.jsonl``
again. Nothing is sent anywhere.
"""

from collections.abc import Iterable
from importlib.metadata import EntryPoint
from typing import Any, Final

from hardware.carry_over import carry_on
from hardware.description.errors import DataError
from hardware.errors import DriveStateError, HardwareError, NotAtRestError, TransitionTimeoutError
from hardware.line_log import LoggedPort
from hardware.pacing import FreeRunning
from hardware.playback import INTERFACE
from hardware.raw_log_reading import read_frames
from hardware.rig import Rig
from hardware.rig_configuration import RigConfiguration, read_rig
from hardware.serial_port import PortSettings
from pmm.recorder.files import BUS, LINES
from pmm.recorder.live_path import PATIENCE_CYCLES, CycleSamples, LivePath
from pmm.recorder.recording import RunData

_SYNC: Final = 0x080
_SYNC_COUNTS: Final = 240  # CiA 301: the counter runs from 1 to 240


def decode(
    run: RunData, drivers: Iterable[EntryPoint] | None = None
) -> tuple[list[CycleSamples], list[str]]:
    """Return what each cycle of a run brought, and the faults that its devices reported, in words.

    Parameters
    ----------
    drivers
        Where the rig's drivers are looked for; all installed ones by default.

    Raises
    ------
    DataError
        If there is no raw log, or the header does not say what the rig was.
    ConfigurationError
        If the rig of the header cannot be built, because a driver is not installed for example.
    """
    if not run.header.rig_tables:
        raise DataError(
            f"{run.folder}: its header does not say what the rig was; nothing can decode it"
        )
    return _played(run, read_rig(_on_playback(run), drivers))


def _on_playback(run: RunData) -> dict[str, Any]:
    """Return the rig's tables with its bus played from the log."""
    tables = dict(run.header.rig_tables)
    if "bus" not in tables:
        return tables
    if not (run.folder / BUS).exists():
        raise DataError(f"{run.folder}: {BUS} is missing; without it nothing can be replayed")
    played = {"interface": INTERFACE, "channel": str(run.folder / BUS)}
    tables["bus"] = {**tables["bus"], **played, "receive_thread": False, "options": {}}
    return tables


def _played(run: RunData, rig_of: RigConfiguration) -> tuple[list[CycleSamples], list[str]]:
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
        path = LivePath(rig)
        for _ in range(_last_cycle(run) - rig.number):
            try:
                rig.cycle()
            except (DriveStateError, NotAtRestError, TransitionTimeoutError):
                pass  # the replayed drives follow the run's commands, not this rig's
            except HardwareError as error:
                faults.append(str(error))
            taken.append(path.step())
    return taken, faults


def _last_cycle(run: RunData) -> int:
    """Return the last cycle that the log tells of, or in which the last sample was given up."""
    number, samples = run.header.first_sync - 1, run.samples
    heard = int(run.texts[LINES][-1][0]) if run.texts[LINES] else number
    if samples is not None:
        return max(samples.first_sync + samples.sample_count - 1 + PATIENCE_CYCLES, heard)
    return max(_last_sync(run), heard)


def _last_sync(run: RunData) -> int:
    """Return the number of the raw log's last SYNC, by their counters."""
    number = run.header.first_sync - 1
    if not (run.folder / BUS).exists():
        return number
    before: int | None = None
    for frame in read_frames(run.folder / BUS):
        if frame.is_rx or frame.is_error_frame or frame.arbitration_id != _SYNC:
            continue
        counter = frame.data[0] if frame.data else None
        if counter is None or before is None:
            number += 1
        else:
            number += (counter - before - 1) % _SYNC_COUNTS + 1
        before = counter
    return number
