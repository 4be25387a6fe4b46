"""``pmm doctor``: whether this machine can do what is wanted of it."""

from collections.abc import Iterator
from pathlib import Path

import click

from pmm.cli.options import JSON
from pmm.doctor.findings import MachineFinding, MachineStatus


@click.command()
@click.argument("rig", metavar="[RIG.toml]", required=False)
@click.option("--output", "folder", metavar="FOLDER", default=".", show_default=True,
              help="Where runs would be recorded.")  # fmt: skip
@click.option("--listen", "listen_s", metavar="S", type=click.FloatRange(min=0.0), default=1.1,
              show_default=True, help="How long to listen to the rig's devices.")  # fmt: skip
@JSON
def doctor(rig: str | None, folder: str, listen_s: float, as_json: bool) -> None:
    """Check installation, buses, ports, devices, permissions, clock and disk.

    Each fault is named with its cure. With a rig's file, its devices are asked too; nothing moves
    and nothing is changed. Exit status: 0 no fault, 1 faults, 2 the rig's file is wrong.
    """
    from pmm.cli.screen import busy, show
    from pmm.report.doctor_document import doctor_document

    with busy("looking"):
        findings = list(_check(rig, Path(folder), listen_s))
    show(doctor_document(findings), as_json=as_json)
    if any(finding.status is MachineStatus.FAULT for finding in findings):
        click.get_current_context().exit(1)


def _check(rig: str | None, folder: Path, listen_s: float) -> Iterator[MachineFinding]:
    from pmm.doctor.host import check_host
    from pmm.doctor.installation import check_installation
    from pmm.doctor.machine import Machine
    from pmm.doctor.reach import check_buses, check_ports

    machine = Machine()
    yield from check_installation(machine)
    yield from check_buses(machine)
    yield from check_ports(machine)
    if rig is not None:
        yield from _devices(Path(rig), listen_s)
    yield from check_host(machine, folder)


def _devices(path: Path, listen_s: float) -> Iterator[MachineFinding]:
    from hardware.errors import HardwareError
    from pmm.devices.device_source import DeviceTables
    from pmm.devices.survey import survey_rig
    from pmm.doctor.reach import check_rig

    tables = DeviceTables(path)
    try:
        survey = survey_rig(tables, listen_s)
    except HardwareError as error:
        cure = f"is the bus there and up, and no other program on it? `pmm devices scan {path}`"
        yield MachineFinding("devices", error.device, MachineStatus.FAULT, str(error), cure)
        return
    answering = {node.node_id for node in survey.nodes}
    names = [name for node, name in survey.names.items() if node in answering]
    ports = [name for name, port in survey.heard_ports.items() if port.device_kind != "silent"]
    yield from check_rig(path, [*names, *ports, *survey.modbus_devices], survey.faults)
