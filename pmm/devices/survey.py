"""Who answers on a bus and on serial ports, and what of a rig's file is missing there."""

import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from hardware.asked_device import spans
from hardware.asked_link import AskedSettings, read_once
from hardware.bus import BusConfiguration
from hardware.errors import HardwareError
from hardware.listening import PortLines, listen
from hardware.master import Master
from hardware.modbus_link import ModbusSettings
from hardware.scan import Ear, FoundNode, scan
from hardware.serial_port import PortSettings, SerialPort
from pmm.devices.device_source import DeviceTables


@dataclass(frozen=True)
class _ExpectedNode:
    """What a rig's file wants of the bus."""

    name: str
    node_id: int
    profile: int


@dataclass(frozen=True)
class Survey:
    """Who answers.

    Attributes
    ----------
    modbus_devices
        Modbus devices that answer, by their part's name: how many registers they showed.
    names
        Of the nodes that the rig's file names, by node id.
    faults
        What is missing or does not fit, with what to do.
    """

    nodes: tuple[FoundNode, ...]
    names: dict[int, str]
    heard_ports: dict[str, PortLines]
    faults: list[str]
    modbus_devices: dict[str, str] = field(default_factory=dict)


def survey_rig(tables: DeviceTables, listen_s: float) -> Survey:
    """Ask all devices that a rig's file names; nothing is changed.

    Raises
    ------
    ConfigurationError, HardwareError
        If the file is wrong, or its bus cannot be opened.
    """
    rig = tables.configuration()
    expected = _expected(tables)
    heard: dict[str, PortLines] = {}
    faults: list[str] = []
    nodes = _scan(rig.bus, listen_s) if rig.bus is not None else ()
    asks = [part for part in rig.parts() if isinstance(part.settings, AskedSettings)]
    silent = {part.name: part for part in asks if not part.nodes()}  # others are on the bus
    for name, port in tables.ports().items():
        if name not in silent:
            _hear(name, PortSettings(**port), listen_s, heard, faults)
    answers: dict[str, str] = {}
    for name, part in silent.items():
        _ask(name, part.settings, answers, faults)
    faults += _missing(nodes, expected)
    return Survey(nodes, {node.node_id: node.name for node in expected}, heard, faults, answers)


def survey_bus(bus: BusConfiguration, listen_s: float) -> Survey:
    """Ask a bus of which nothing is known."""
    nodes = _scan(bus, listen_s)
    faults = [] if nodes else [
        f"nobody answers on {bus.interface}:{bus.channel} at {bus.bit_rate} bit/s; "
        "check power, bit rate and termination"
    ]  # fmt: skip
    return Survey(nodes, {}, {}, faults)


def survey_port(settings: PortSettings, listen_s: float) -> Survey:
    """Listen to a serial port of which nothing is known."""
    heard: dict[str, PortLines] = {}
    faults: list[str] = []
    _hear("port", settings, listen_s, heard, faults)
    return Survey((), {}, heard, faults)


def _scan(bus: BusConfiguration, listen_s: float) -> tuple[FoundNode, ...]:
    ear = Ear()
    master = Master(bus, time.monotonic, (ear,))
    try:
        return scan(master, ear, listen_s)
    finally:
        master.close()


def _hear(
    name: str,
    settings: PortSettings,
    seconds: float,
    heard: dict[str, PortLines],
    faults: list[str],
) -> None:
    try:
        port = SerialPort(name, settings)
    except HardwareError as error:
        faults.append(str(error))
        return
    try:
        heard[name] = listen(port, seconds, time.monotonic, time.sleep)
    except HardwareError as error:
        faults.append(str(error))
    finally:
        port.close()


def _ask(name: str, settings: Any, answers: dict[str, str], faults: list[str]) -> None:
    """Read what a device shows that says nothing by itself, once; nothing is written."""
    places = spans(settings.signals.read().values(), settings.signals.status)
    try:
        register_count = read_once(name, settings, places)
    except HardwareError as error:
        faults.append(str(error))
    else:
        has_registers = isinstance(settings, ModbusSettings)
        answers[name] = f"{register_count} registers" if has_registers else f"{len(places)} lines"


def _expected(tables: DeviceTables) -> tuple[_ExpectedNode, ...]:
    from hardware.dictionary import Entry, load, variable

    nodes = []
    for part in tables.configuration().parts():
        for plan in part.nodes():
            entry = variable(load(plan.eds, plan.node_id, plan.name), Entry(0x1000))
            profile = int(entry.default or 0) & 0xFFFF if entry is not None else 0
            nodes.append(_ExpectedNode(plan.name, plan.node_id, profile))
    return tuple(nodes)


def _missing(nodes: Sequence[FoundNode], expected: Sequence[_ExpectedNode]) -> list[str]:
    """Return what does not fit between the bus and the rig's file."""
    nodes_by_id = {node.node_id: node for node in nodes}
    faults = []
    for expected_node in expected:
        node = nodes_by_id.pop(expected_node.node_id, None)
        if node is None:
            faults.append(
                f"{expected_node.name}: node {expected_node.node_id} does not answer; check its "
                "power, its node id and the bit rate"
            )
        elif expected_node.profile and node.profile != expected_node.profile:
            faults.append(
                f"{expected_node.name}: node {expected_node.node_id} follows profile "
                f"{node.profile} where its EDS says {expected_node.profile}; check the node ids"
            )
    faults += [f"node {node_id} answers and is not in the rig's file" for node_id in nodes_by_id]
    return faults
