"""The host: clock, priority and disk."""

from collections.abc import Iterator
from pathlib import Path
from typing import Final

from pmm.doctor.findings import MachineFinding, MachineStatus
from pmm.doctor.machine import Machine

_RESOLUTION_S: Final = 1e-4  # a cycle at 200 Hz takes 5 ms
_LATE_S: Final = 0.005
_PRIORITY: Final = 10
_RESERVE: Final = 200_000_000  # bytes: what the recorder keeps free
_LITTLE: Final = 10 * _RESERVE
_MEGA: Final = 1e6


def check_host(machine: Machine, folder: Path) -> Iterator[MachineFinding]:
    """Look at what a run in real time needs of the host; ``folder`` is where it would record."""
    yield _resolution(machine)
    yield _lateness(machine)
    yield _network_time(machine)
    yield _priority(machine)
    yield _memory(machine)
    yield _disk(machine, folder)


def _finding(
    area: str,
    item: str,
    fine: bool | None,
    state: str,
    cure: str,
    worse: MachineStatus = MachineStatus.WARNING,
) -> MachineFinding:
    """Return a finding; ``None`` is what the system does not tell."""
    if fine is None or fine:
        return MachineFinding(area, item, MachineStatus.OK if fine else MachineStatus.NOTE, state)
    return MachineFinding(area, item, worse, state, cure)


def _resolution(machine: Machine) -> MachineFinding:
    resolution_s = machine.monotonic_resolution_s()
    text = f"resolves {1e6 * resolution_s:.3g} us (limit {1e6 * _RESOLUTION_S:g} us)"
    cure = "run on a system with a high-resolution timer"
    fine = resolution_s <= _RESOLUTION_S
    return _finding("clock", "monotonic clock", fine, text, cure, MachineStatus.FAULT)


def _lateness(machine: Machine) -> MachineFinding:
    lateness_s = machine.worst_lateness_s()
    text = (
        f"a nap of 2 ms ends at worst {1e3 * lateness_s:.2g} ms late (limit {1e3 * _LATE_S:g} ms)"
    )
    cure = "end what else runs here, and switch power saving off"
    return _finding("clock", "timer", lateness_s <= _LATE_S, text, cure)


def _network_time(machine: Machine) -> MachineFinding:
    is_synchronised = machine.synchronised()
    texts = {
        None: "the system does not tell whether it is synchronised",
        True: "synchronised over the network",
        False: "not synchronised: recordings may be dated wrongly (intervals are not touched)",
    }
    cure = "timedatectl set-ntp true, or start chrony"
    return _finding("clock", "time of day", is_synchronised, texts[is_synchronised], cure)


def _priority(machine: Machine) -> MachineFinding:
    priority = machine.highest_priority()
    fine = None if priority is None else priority >= _PRIORITY
    texts = {
        None: "not known of here",
        True: f"up to {priority}",
        False: f"up to {priority}, wanted are {_PRIORITY}: other programs can make cycles late",
    }
    cure = f"'* - rtprio {_PRIORITY}' in /etc/security/limits.conf, then log in anew"
    return _finding("permissions", "real-time priority", fine, texts[fine], cure)


def _memory(machine: Machine) -> MachineFinding:
    may_lock = machine.may_lock_memory()
    texts = {
        None: "not known of here",
        True: "without a limit",
        False: "limited, wanted is no limit: what is moved out of memory makes cycles late",
    }
    cure = "'* - memlock unlimited' in /etc/security/limits.conf, then log in anew"
    return _finding("permissions", "locked memory", may_lock, texts[may_lock], cure)


def _disk(machine: Machine, folder: Path) -> MachineFinding:
    item = f"disk of {folder}"
    if not machine.may_write(folder):
        text, cure = "no permission to write", "record to another folder: --output"
        return _finding("disk", item, False, text, cure, MachineStatus.FAULT)
    free = machine.free_bytes(folder)
    text = f"{free / _MEGA:.0f} MB free (limit {_RESERVE / _MEGA:.0f} MB)"
    if free < _RESERVE:
        cure = "make room, or record to another disk: --output"
        return _finding("disk", item, False, text, cure, MachineStatus.FAULT)
    return _finding("disk", item, free >= _LITTLE, text, "make room before a long campaign")
