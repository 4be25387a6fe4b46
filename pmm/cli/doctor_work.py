"""What ``pmm doctor`` does: look at everything, print it, and end with 1 if there is a fault."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Final

import click

from hardware.errors import HardwareError
from pmm.cli.screen import busy, output
from pmm.doctor.findings import MachineFinding, MachineStatus
from pmm.doctor.host import check_host
from pmm.doctor.installation import check_installation
from pmm.doctor.machine import Machine
from pmm.doctor.reach import check_buses, check_ports, check_rig

JSON_SCHEMA: Final = "pmm-doctor-1"
_STYLES: Final = {
    MachineStatus.OK: "green",
    MachineStatus.NOTE: "cyan",
    MachineStatus.WARNING: "yellow",
    MachineStatus.FAULT: "bold red",
}


def run(
    rig: str | None,
    folder: str,
    listen_s: float,
    machine: Machine | None = None,
    *,
    as_json: bool,
) -> None:
    """Check, print, and set the exit status.

    Raises
    ------
    ConfigurationError
        If the rig's file is wrong.
    """
    with busy("looking"):
        found = list(_check(rig, Path(folder), listen_s, machine or Machine()))
    faults = [one for one in found if one.status is MachineStatus.FAULT]
    if as_json:
        findings = [asdict(one) for one in found]
        document = {"schema": JSON_SCHEMA, "faults": len(faults), "findings": findings}
        click.echo(json.dumps(document, indent=1))
    else:
        _print(found, len(faults))
    if faults:
        raise click.exceptions.Exit(1)


def _check(
    rig: str | None, folder: Path, listen_s: float, machine: Machine
) -> Iterator[MachineFinding]:
    yield from check_installation(machine)
    yield from check_buses(machine)
    yield from check_ports(machine)
    if rig is not None:
        yield from _devices(Path(rig), listen_s)
    yield from check_host(machine, folder)


def _devices(path: Path, listen_s: float) -> Iterator[MachineFinding]:
    from pmm.cli.devices_scan import survey_rig
    from pmm.devices.opening import DeviceTables

    tables = DeviceTables(path)
    try:
        found = survey_rig(tables, listen_s)
    except HardwareError as error:
        cure = f"is the bus there and up, and no other program on it? `pmm devices scan {path}`"
        yield MachineFinding("devices", error.device, MachineStatus.FAULT, str(error), cure)
        return
    answering = {one.node_id for one in found.nodes}
    names = [name for node, name in found.names.items() if node in answering]
    ports = [name for name, one in found.heard.items() if one.what != "silent"]
    yield from check_rig(path, [*names, *ports], found.wrong)


def _print(found: Sequence[MachineFinding], faults: int) -> None:
    from rich.table import Table
    from rich.text import Text

    console = output()
    table = Table(box=None, padding=(0, 1), pad_edge=False)
    for heading in ("area", "what", "", "found"):
        table.add_column(heading, overflow="fold")
    area = ""
    for one in found:
        shown = "" if one.area == area else one.area
        status = Text(one.status.value, style=_STYLES[one.status])
        table.add_row(shown, one.what, status, one.found)
        if one.cure:
            table.add_row("", "", "", Text(f"-> {one.cure}", style="bold"))
        area = one.area
    console.print(table)
    console.print(f"{faults} fault{'' if faults == 1 else 's'}" if faults else "no fault")
