"""The host: clock, priority and disk."""

from collections.abc import Iterator
from pathlib import Path
from typing import Final

from pmm.doctor.findings import Finding, Status
from pmm.doctor.machine import Machine

_RESOLUTION_S: Final = 1e-4  # a cycle at 200 Hz takes 5 ms
_LATE_S: Final = 0.005
_PRIORITY: Final = 10
_RESERVE: Final = 200_000_000  # bytes: what the recorder keeps free
_LITTLE: Final = 10 * _RESERVE
_MEGA: Final = 1e6


def check_host(machine: Machine, folder: Path) -> Iterator[Finding]:
    """Look at what a run in real time needs of the host; ``folder`` is where it would record."""
    yield _resolution(machine)
    yield _lateness(machine)
    yield _network_time(machine)
    yield _priority(machine)
    yield _memory(machine)
    yield _disk(machine, folder)


def _resolution(machine: Machine) -> Finding:
    found = machine.monotonic_resolution_s()
    told = f"resolves {1e6 * found:.3g} us (limit {1e6 * _RESOLUTION_S:g} us)"
    if found <= _RESOLUTION_S:
        return Finding("clock", "monotonic clock", Status.OK, told)
    return Finding("clock", "monotonic clock", Status.FAULT, told,
                   "run on a system with a high-resolution timer")  # fmt: skip


def _lateness(machine: Machine) -> Finding:
    found = machine.worst_lateness_s()
    told = f"a nap of 2 ms ends at worst {1e3 * found:.2g} ms late (limit {1e3 * _LATE_S:g} ms)"
    if found <= _LATE_S:
        return Finding("clock", "timer", Status.OK, told)
    return Finding("clock", "timer", Status.WARNING, told,
                   "end what else runs here, and switch power saving off")  # fmt: skip


def _network_time(machine: Machine) -> Finding:
    found = machine.synchronised()
    if found is None:
        return Finding("clock", "time of day", Status.NOTE, "the system does not tell whether it "
                       "is synchronised")  # fmt: skip
    if found:
        return Finding("clock", "time of day", Status.OK, "synchronised over the network")
    return Finding("clock", "time of day", Status.WARNING,
                   "not synchronised: recordings may be dated wrongly (intervals are not touched)",
                   "timedatectl set-ntp true, or start chrony")  # fmt: skip


def _priority(machine: Machine) -> Finding:
    found = machine.highest_priority()
    if found is None:
        return Finding("permissions", "real-time priority", Status.NOTE, "not known of here")
    if found >= _PRIORITY:
        return Finding("permissions", "real-time priority", Status.OK, f"up to {found}")
    return Finding("permissions", "real-time priority", Status.WARNING,
                   f"up to {found}, wanted are {_PRIORITY}: other programs can make cycles late",
                   f"'* - rtprio {_PRIORITY}' in /etc/security/limits.conf, then log in anew"
                   )  # fmt: skip


def _memory(machine: Machine) -> Finding:
    found = machine.may_lock_memory()
    if found is None:
        return Finding("permissions", "locked memory", Status.NOTE, "not known of here")
    if found:
        return Finding("permissions", "locked memory", Status.OK, "without a limit")
    return Finding("permissions", "locked memory", Status.WARNING,
                   "limited, wanted is no limit: what is moved out of memory makes cycles late",
                   "'* - memlock unlimited' in /etc/security/limits.conf, then log in anew"
                   )  # fmt: skip


def _disk(machine: Machine, folder: Path) -> Finding:
    what = f"disk of {folder}"
    if not machine.may_write(folder):
        return Finding("disk", what, Status.FAULT, "no permission to write",
                       "record to another folder: --output")  # fmt: skip
    free = machine.free_bytes(folder)
    told = f"{free / _MEGA:.0f} MB free (limit {_RESERVE / _MEGA:.0f} MB)"
    if free < _RESERVE:
        return Finding("disk", what, Status.FAULT, told,
                       "make room, or record to another disk: --output")  # fmt: skip
    if free < _LITTLE:
        return Finding("disk", what, Status.WARNING, told, "make room before a long campaign")
    return Finding("disk", what, Status.OK, told)
