"""What ``pmm devices`` shows: who answers, what is read, what came of a test."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from hardware.listening import PortLines
from hardware.roles import Reading
from hardware.scan import FoundNode
from hardware.serial_port import PluggedPort
from pmm.devices.device_readings import DeviceRow
from pmm.devices.photocell_test import PhotocellRecord
from pmm.devices.pulses import Interval
from pmm.devices.push_session import Pushed
from pmm.devices.readings import Shown
from pmm.devices.survey import Survey
from pmm.document.content import (
    Column,
    Content,
    Data,
    Document,
    Section,
    Table,
    Text,
    data_only,
    number,
    word,
)
from pmm.document.notation import written

SCHEMA: Final = "pmm-devices-1"
_PROFILES: Final = {
    401: "input and output", 402: "drive", 404: "measuring device", 406: "encoder",
}  # fmt: skip


def _document(job: str, *contents: Content) -> Document:
    return Document("", "devices", (Section("", (Data("job", job), *contents)),), SCHEMA)


@dataclass(frozen=True)
class _Node:
    """A node that answered, and what the rig's file calls it."""

    node: FoundNode
    part: str


def _of_node(
    key: str, heading: str | None = None, text: Callable[[Any], str] = str
) -> Column[_Node]:
    return Column(heading, lambda row: getattr(row.node, key), key, text)


def _pdos(key: str, heading: str) -> Column[_Node]:
    """Return a column of what a node has mapped."""

    def mapped(row: _Node) -> list[dict[str, Any]]:
        return [
            {
                "cob_id": pdo.cob_id,
                "transmission": pdo.transmission,
                "objects": [str(entry) for entry in pdo.entries],
            }
            for pdo in getattr(row.node, key)
        ]

    return Column(heading, mapped, key, lambda pdos: "\n".join(map(_mapping, pdos)))


def _mapping(pdo: Mapping[str, Any]) -> str:
    objects = " ".join(pdo["objects"])
    return f"{pdo['cob_id']:03X} {objects} ({_transmission(pdo['transmission'])})"


def _transmission(kind: int) -> str:
    if kind == 0:
        return "SYNC, if changed"
    return ("SYNC" if kind == 1 else f"SYNC/{kind}") if kind <= 240 else "event"


def _identity(row: _Node) -> str:
    node = row.node
    parts = (node.vendor, node.product, node.revision, node.serial)
    return " ".join("-" if part is None else f"{part:X}" for part in parts)


_NODES: Final[tuple[Column[_Node], ...]] = (
    Column("node", lambda row: row.node.node_id, "node_id", number=True),
    Column("part", lambda row: row.part or row.node.name),
    Column("type", lambda row: row.node.profile, "profile",
           lambda profile: f"{profile} {_PROFILES.get(profile, '')}".strip()),
    Column("identity (1018)", _identity),
    _of_node("state", "state", lambda state: state or "not told"),
    _of_node("heartbeat_ms", "heartbeat", lambda ms: f"{ms} ms" if ms else "none"),
    _pdos("tpdos", "TPDO"),
    _pdos("rpdos", "RPDO"),
    *data_only("part"),
    *(_of_node(key) for key in
      ("device_type", "vendor", "product", "revision", "serial", "name")),
)  # fmt: skip
_HEARD: Final[tuple[Column[tuple[str, PortLines]], ...]] = (
    Column("port", lambda row: row[0]),
    Column("is", lambda row: row[1].device_kind, "is"),
    Column("lines", lambda row: {str(kind): count for kind, count in row[1].counts.items()},
           "lines", lambda counts: str(sum(counts.values())), number=True),
    Column("per second", lambda row: row[1].rate_hz, "per_second", written(".4g"), number=True),
    Column("lost", lambda row: row[1].lost, "lost", number=True),
    Column("refused", lambda row: row[1].refused, "refused", number=True),
    Column("last", lambda row: _last_lines(row[1])),
    Column(None, lambda row: {str(kind): line.value for kind, line in row[1].last.items()}, "last"),
)  # fmt: skip


_ASKED: Final[tuple[Column[tuple[str, str]], ...]] = (
    Column("device", lambda row: row[0], "device"),
    Column("shows", lambda row: row[1], "shows"),
)


def _last_lines(heard: PortLines) -> str:
    lines = [f"{kind} {line.value:g}" for kind, line in heard.last.items()]
    return ", ".join(lines) or heard.first_refused


def scan_document(survey: Survey, wrong: Sequence[str]) -> Document:
    """Return who answers; ``wrong`` is what is missing or does not fit."""
    nodes = [_Node(node, survey.names.get(node.node_id, "")) for node in survey.nodes]
    heard = Table(
        "Ports", _HEARD, tuple(survey.heard_ports.items()), "ports", by=lambda row: row[0]
    )
    modbus = Table("Modbus", _ASKED, tuple(survey.modbus_devices.items()), "modbus")
    nodes_table = Table("Nodes", _NODES, nodes, "nodes")
    return _document("scan", nodes_table, heard, modbus, Data("wrong", wrong))


_PORTS: Final = (word("device", "device"), word("url", "url"), word("description", "description"))


def ports_document(ports: Sequence[PluggedPort]) -> Document:
    """Return the serial ports of this machine."""
    none = Text(() if ports else ("no serial ports",))
    return _document("ports", Table("Ports", _PORTS, ports, "ports"), none)


_VALUES: Final[tuple[Column[DeviceRow], ...]] = (
    Column("device", lambda row: row.device, "device", once=True),
    word("what", "what"),
    number(
        "value", "value", lambda value: value if isinstance(value, str) else written(".6g")(value)
    ),
    word("unit", "unit"),
)


def values_table(rows: Sequence[DeviceRow]) -> Table[DeviceRow]:
    """Return what devices read now."""
    return Table("Values", _VALUES, rows, "values")


def values_document(shown: Shown) -> Document:
    """Return what devices read now, and the faults that they reported."""
    return _document("read", values_table(shown.rows), Data("said", shown.faults))


def move_document(axis: str, wanted: float, unit: str, reading: Reading) -> Document:
    """Return where an axis stands."""
    message = (
        f"{axis} stands at {reading.value:.6g} ± {reading.standard_uncertainty:.2g} {unit} "
        f"({reading.source}); wanted {wanted:.6g} {unit}"
    )
    return _document(
        "move",
        Text((message,)),
        Data("axis", axis),
        Data("wanted", wanted),
        Data("unit", unit),
        Data("reading", reading),
    )


_INTERVALS: Final[tuple[Column[Interval], ...]] = (
    number("pulse", "number"),
    number("time", "time_s", written(".4f"), "s"),
    number("interval", "seconds", written(".4f"), "s"),
    number("turns", "turns", written(".4f")),
    word("verdict", "verdict", lambda verdict: verdict or "ok"),
    *data_only("missing", "extra", "lost"),
)


def photocell_document(record: PhotocellRecord) -> Document:
    """Return a photocell's pulses and what lies between them."""
    return _document(
        "photocell",
        Table("Intervals", _INTERVALS, record.intervals, "intervals"),
        Data("pulses", record.pulses),
        Data("said", record.driver_messages),
        Data("good", record.good),
    )


def gauges_document(gauges: Sequence[Pushed]) -> Document:
    """Return which gauges were pushed, and which way."""
    return _document("gauges", Data("gauges", gauges))


def push_line(pushed: Pushed) -> str:
    """Return which gauge a push came in on; empty if there was none."""
    push = pushed.push
    if push is None:
        return ""
    sign = "+" if push.sign > 0 else "-"
    right = "WRONG" if pushed.wrong else "right"
    return (
        f"{pushed.asked}: came in on {push.channel}, sign {sign}, {push.change:+.3g} {push.unit} "
        f"(a push is more than {push.threshold:.2g} {push.unit}): {right}"
    )
