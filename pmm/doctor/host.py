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


def _resolution(machine: Machine) -> MachineFinding:
    found = machine.monotonic_resolution_s()
    told = f"resolves {1e6 * found:.3g} us (limit {1e6 * _RESOLUTION_S:g} us)"
    if found <= _RESOLUTION_S:
        return MachineFinding("clock", "monotonic clock", MachineStatus.OK, told)
    return MachineFinding(
        "clock",
        "monotonic clock",
        MachineStatus.FAULT,
        told,
        "run on a system with a high-resolution timer",
    )


def _lateness(machine: Machine) -> MachineFinding:
    found = machine.worst_lateness_s()
    told = f"a nap of 2 ms ends at worst {1e3 * found:.2g} ms late (limit {1e3 * _LATE_S:g} ms)"
    if found <= _LATE_S:
        return MachineFinding("clock", "timer", MachineStatus.OK, told)
    return MachineFinding(
        "clock",
        "timer",
        MachineStatus.WARNING,
        told,
        "end what else runs here, and switch power saving off",
    )


def _network_time(machine: Machine) -> MachineFinding:
    found = machine.synchronised()
    if found is None:
        return MachineFinding(
            "clock",
            "time of day",
            MachineStatus.NOTE,
            "the system does not tell whether it is synchronised",
        )
    if found:
        return MachineFinding(
            "clock", "time of day", MachineStatus.OK, "synchronised over the network"
        )
    return MachineFinding(
        "clock",
        "time of day",
        MachineStatus.WARNING,
        "not synchronised: recordings may be dated wrongly (intervals are not touched)",
        "timedatectl set-ntp true, or start chrony",
    )


def _priority(machine: Machine) -> MachineFinding:
    found = machine.highest_priority()
    if found is None:
        return MachineFinding(
            "permissions", "real-time priority", MachineStatus.NOTE, "not known of here"
        )
    if found >= _PRIORITY:
        return MachineFinding(
            "permissions", "real-time priority", MachineStatus.OK, f"up to {found}"
        )
    return MachineFinding(
        "permissions",
        "real-time priority",
        MachineStatus.WARNING,
        f"up to {found}, wanted are {_PRIORITY}: other programs can make cycles late",
        f"'* - rtprio {_PRIORITY}' in /etc/security/limits.conf, then log in anew",
    )


def _memory(machine: Machine) -> MachineFinding:
    found = machine.may_lock_memory()
    if found is None:
        return MachineFinding(
            "permissions", "locked memory", MachineStatus.NOTE, "not known of here"
        )
    if found:
        return MachineFinding("permissions", "locked memory", MachineStatus.OK, "without a limit")
    return MachineFinding(
        "permissions",
        "locked memory",
        MachineStatus.WARNING,
        "limited, wanted is no limit: what is moved out of memory makes cycles late",
        "'* - memlock unlimited' in /etc/security/limits.conf, then log in anew",
    )


def _disk(machine: Machine, folder: Path) -> MachineFinding:
    what = f"disk of {folder}"
    if not machine.may_write(folder):
        return MachineFinding(
            "disk",
            what,
            MachineStatus.FAULT,
            "no permission to write",
            "record to another folder: --output",
        )
    free = machine.free_bytes(folder)
    told = f"{free / _MEGA:.0f} MB free (limit {_RESERVE / _MEGA:.0f} MB)"
    if free < _RESERVE:
        return MachineFinding(
            "disk",
            what,
            MachineStatus.FAULT,
            told,
            "make room, or record to another disk: --output",
        )
    if free < _LITTLE:
        return MachineFinding(
            "disk", what, MachineStatus.WARNING, told, "make room before a long campaign"
        )
    return MachineFinding("disk", what, MachineStatus.OK, told)
