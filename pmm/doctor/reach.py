"""What can be reached: CAN interfaces, serial ports, and the devices that a rig's file names."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

from pmm.doctor.findings import MachineFinding, MachineStatus
from pmm.doctor.machine import Machine

_CAN: Final = "280"  # ARPHRD_CAN
_UP: Final = 1  # IFF_UP


def check_buses(machine: Machine) -> Iterator[MachineFinding]:
    """Look at the CAN interfaces that the kernel knows."""
    folders = sorted((machine.root / "sys/class/net").glob("*"))
    buses = [folder for folder in folders if _read(folder / "type") == _CAN]
    if not buses:
        yield MachineFinding(
            "buses",
            "SocketCAN",
            MachineStatus.NOTE,
            "no interface: a rig on another adapter, or simulated, needs none",
            "for a USB adapter: plug it in and look at `ip -details link`",
        )
    for folder in buses:
        is_up = int(_read(folder / "flags") or "0", 16) & _UP
        state = _read(folder / "operstate") or "unknown"
        if is_up:
            yield MachineFinding("buses", f"CAN {folder.name}", MachineStatus.OK, f"up ({state})")
        else:
            yield MachineFinding(
                "buses",
                f"CAN {folder.name}",
                MachineStatus.FAULT,
                "down",
                f"sudo ip link set {folder.name} up type can bitrate 1000000",
            )


def check_ports(machine: Machine) -> Iterator[MachineFinding]:
    """Look at the serial ports that are plugged in."""
    ports = machine.ports()
    if not ports:
        yield MachineFinding("ports", "serial ports", MachineStatus.NOTE, "none is plugged in")
    for port in ports:
        item = f"serial port {port.device}"
        description = f'{port.description or "no description"}, url = "{port.url}"'
        if machine.may_use(port.device):
            yield MachineFinding("ports", item, MachineStatus.OK, description)
        else:
            group = _group(port.device)
            yield MachineFinding(
                "ports",
                item,
                MachineStatus.FAULT,
                f"no permission to read and write; {description}",
                f"sudo usermod -aG {group} $USER, then log in anew",
            )


def check_rig(path: Path, names: Sequence[str], faults: Sequence[str]) -> Iterator[MachineFinding]:
    """Turn what a survey of a rig's devices found, and found wrong, into findings."""
    for fault in faults:
        part, _, reason = fault.partition(": ")
        state, _, cure = reason.partition("; ")
        yield MachineFinding(
            "devices",
            part,
            MachineStatus.FAULT,
            state or "does not fit",
            cure or f"see {path} and `pmm devices scan {path}`",
        )
    if names:
        yield MachineFinding("devices", str(path), MachineStatus.OK, f"{', '.join(names)} answer")


def _read(path: Path) -> str:
    try:
        return path.read_text(encoding="ascii").strip()
    except (OSError, UnicodeDecodeError):
        return ""


def _group(device: str) -> str:
    """Return the group that the device belongs to, ``dialout`` where that cannot be told."""
    try:
        return Path(device).group()
    except (OSError, KeyError, NotImplementedError):
        return "dialout"
