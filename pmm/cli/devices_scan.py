"""``pmm devices scan`` and ``ports``: who answers on a bus and on serial ports."""

import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final

import click

from hardware.bus import BusConfiguration
from hardware.description.errors import ConfigurationError
from hardware.errors import HardwareError
from hardware.listening import Heard, listen
from hardware.master import Master
from hardware.scan import Ear, FoundNode
from hardware.scan import scan as scan_bus
from hardware.serial_port import PortSettings, SerialPort, plugged_ports
from pmm.cli.devices_common import print_json, print_table
from pmm.cli.devices_scan_printing import print_document, print_heard, print_nodes
from pmm.cli.screen import busy, error_line, output
from pmm.devices.opening import DeviceTables, bus_alone

_PORT: Final = "port"


@dataclass(frozen=True)
class DeviceScanOptions:
    """The options of ``pmm devices scan`` by their names there."""

    rig: str | None
    interface: str | None
    channel: str
    bitrate: int
    options: tuple[str, ...]
    port: str | None
    baud: int
    as_json: bool
    listen_s: float = 1.1

    def tables(self) -> DeviceTables | None:
        """Return the rig's file.

        Raises
        ------
        ConfigurationError
            If nothing to look at is named, or two things are.
        """
        named = [one for one in (self.rig, self.interface, self.port) if one]
        if len(named) != 1:
            raise ConfigurationError(
                f"{' and '.join(named) or 'nothing'} to look at: name one of RIG.toml, "
                "--interface (with --channel), --port"
            )
        return DeviceTables(Path(self.rig)) if self.rig else None

    def bus(self) -> BusConfiguration:
        """Return the bus that is named alone."""
        found = dict(_option(one) for one in self.options)
        return bus_alone(self.interface or "", self.channel, self.bitrate, found)

    def port_settings(self) -> PortSettings:
        """Return the port that is named alone."""
        return PortSettings(self.port or "", self.baud)


@dataclass(frozen=True)
class _Expected:
    """What a rig's file wants of the bus."""

    name: str
    node_id: int
    profile: int


@dataclass(frozen=True)
class Survey:
    """Who answers.

    Attributes
    ----------
    names
        Of the nodes that the rig's file names, by node id.
    wrong
        What is missing or does not fit, with what to do.
    """

    nodes: tuple[FoundNode, ...]
    names: dict[int, str]
    heard: dict[str, Heard]
    wrong: list[str]


def survey_rig(tables: DeviceTables, listen_s: float) -> Survey:
    """Ask all devices that a rig's file names; nothing is changed.

    Raises
    ------
    ConfigurationError, HardwareError
        If the file is wrong, or its bus cannot be opened.
    """
    rig = tables.configuration()
    expected = _expected(tables)
    heard: dict[str, Heard] = {}
    wrong: list[str] = []
    nodes = _scan(rig.bus, listen_s) if rig.bus is not None else ()
    for name, port in tables.ports().items():
        _hear(name, PortSettings(**port), listen_s, heard, wrong)
    wrong += _missing(nodes, expected)
    return Survey(nodes, {one.node_id: one.name for one in expected}, heard, wrong)


def _survey_alone(request: DeviceScanOptions) -> Survey:
    """Ask a bus or a port of which nothing is known."""
    heard: dict[str, Heard] = {}
    wrong: list[str] = []
    if not request.interface:
        _hear(_PORT, request.port_settings(), request.listen_s, heard, wrong)
        return Survey((), {}, heard, wrong)
    nodes = _scan(request.bus(), request.listen_s)
    if not nodes:
        wrong.append(
            f"nobody answers on {request.interface}:{request.channel} at {request.bitrate} bit/s; "
            "check power, bit rate and termination"
        )
    return Survey(nodes, {}, heard, wrong)


def run(request: DeviceScanOptions) -> None:
    """Scan, print what was found, and end with status 1 if something is missing."""
    tables = request.tables()
    with busy("scanning"):
        found = survey_rig(tables, request.listen_s) if tables else _survey_alone(request)
    silent = [f"{name}: {one.what}" for name, one in found.heard.items() if one.what == "silent"]
    wrong = found.wrong + silent
    if request.as_json:
        print_document(found.nodes, found.names, found.heard, wrong)
    else:
        print_nodes(found.nodes, found.names)
        print_heard(found.heard)
        for one in wrong:
            error_line(one)
    if wrong:
        raise click.exceptions.Exit(1)


def print_ports(*, as_json: bool) -> None:
    """Print the serial ports of this machine."""
    found = plugged_ports()
    if as_json:
        print_json("ports", {"ports": [asdict(one) for one in found]})
    elif found:
        print_table(
            ("device", "url", "description"),
            [(one.device, one.url, one.description) for one in found],
        )
    else:
        output().print("no serial ports")


def _scan(bus: BusConfiguration, listen_s: float) -> tuple[FoundNode, ...]:
    ear = Ear()
    master = Master(bus, time.monotonic, (ear,))
    try:
        return scan_bus(master, ear, listen_s)
    finally:
        master.close()


def _hear(
    name: str, settings: PortSettings, seconds: float, heard: dict[str, Heard], wrong: list[str]
) -> None:
    try:
        port = SerialPort(name, settings)
    except HardwareError as error:
        wrong.append(str(error))
        return
    try:
        heard[name] = listen(port, seconds, time.monotonic, time.sleep)
    except HardwareError as error:
        wrong.append(str(error))
    finally:
        port.close()


def _expected(tables: DeviceTables) -> tuple[_Expected, ...]:
    from hardware.dictionary import Entry, load, variable

    found = []
    for part in tables.configuration().parts():
        for plan in part.nodes():
            at = variable(load(plan.eds, plan.node_id, plan.name), Entry(0x1000))
            profile = int(at.default or 0) & 0xFFFF if at is not None else 0
            found.append(_Expected(plan.name, plan.node_id, profile))
    return tuple(found)


def _missing(nodes: Sequence[FoundNode], expected: Sequence[_Expected]) -> list[str]:
    """Return what does not fit between the bus and the rig's file."""
    found = {one.node_id: one for one in nodes}
    wrong = []
    for one in expected:
        node = found.pop(one.node_id, None)
        if node is None:
            wrong.append(
                f"{one.name}: node {one.node_id} does not answer; check its power, its node id and "
                "the bit rate"
            )
        elif one.profile and node.profile != one.profile:
            wrong.append(
                f"{one.name}: node {one.node_id} follows profile {node.profile} where its EDS says "
                f"{one.profile}; check the node ids"
            )
    wrong += [f"node {node_id} answers and is not in the rig's file" for node_id in found]
    return wrong


def _option(text: str) -> tuple[str, int | float | str | bool]:
    name, equals, value = text.partition("=")
    if not equals:
        raise ConfigurationError(f"--option {text!r}: write NAME=VALUE")
    if value in ("true", "false"):
        return name, value == "true"
    for kind in (int, float):
        try:
            return name, kind(value)
        except ValueError:
            continue
    return name, value
