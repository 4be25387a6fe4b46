"""Tables and the document of ``pmm devices scan``."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any, Final

from hardware.listening import Heard
from hardware.scan import FoundNode, Mapping
from pmm.cli.devices_common import print_json, print_table

_PROFILES: Final = {401: "input and output", 402: "drive", 404: "measuring device", 406: "encoder"}


def _mapping(one: Mapping) -> str:
    objects = " ".join(str(at) for at in one.entries)
    return f"{one.cob_id:03X} {objects} ({_transmission(one.transmission)})"


def _transmission(kind: int) -> str:
    if kind == 0:
        return "SYNC, if changed"
    return ("SYNC" if kind == 1 else f"SYNC/{kind}") if kind <= 240 else "event"


def _identity(node: FoundNode) -> str:
    parts = (node.vendor, node.product, node.revision, node.serial)
    return " ".join("-" if one is None else f"{one:X}" for one in parts)


def print_nodes(nodes: Sequence[FoundNode], names: dict[int, str]) -> None:
    """Print the nodes that answered; ``names`` are those of the rig's file, by node id."""
    if not nodes:
        return
    print_table(
        ("node", "part", "type", "identity (1018)", "state", "heartbeat", "TPDO", "RPDO"),
        [
            (
                str(one.node_id),
                names.get(one.node_id, "") or one.name,
                f"{one.profile} {_PROFILES.get(one.profile, '')}".strip(),
                _identity(one),
                one.state or "not told",
                f"{one.heartbeat_ms} ms" if one.heartbeat_ms else "none",
                "\n".join(map(_mapping, one.tpdos)),
                "\n".join(map(_mapping, one.rpdos)),
            )
            for one in nodes
        ],
        "node",
    )


def print_heard(heard: dict[str, Heard]) -> None:
    """Print what was heard on each port."""
    if not heard:
        return
    print_table(
        ("port", "is", "lines", "per second", "lost", "refused", "last"),
        [
            (
                name,
                one.what,
                str(sum(one.counts.values())),
                f"{one.rate_hz:.4g}" if one.rate_hz == one.rate_hz else "-",
                str(one.lost),
                str(one.refused),
                _last(one),
            )
            for name, one in heard.items()
        ],
        "lines,per second,lost,refused",
    )


def _last(heard: Heard) -> str:
    lines = [f"{kind} {line.value:g}" for kind, line in heard.last.items()]
    return ", ".join(lines) or heard.first_refused


def print_document(
    nodes: Sequence[FoundNode], names: dict[int, str], heard: dict[str, Heard], wrong: list[str]
) -> None:
    """Print everything as one JSON document."""

    def pdo(one: Mapping) -> dict[str, Any]:
        objects = [str(at) for at in one.entries]
        return {"cob_id": one.cob_id, "transmission": one.transmission, "objects": objects}

    print_json(
        "scan",
        {
            "nodes": [
                {
                    **asdict(one),
                    "part": names.get(one.node_id, ""),
                    "profile": one.profile,
                    "tpdos": [pdo(each) for each in one.tpdos],
                    "rpdos": [pdo(each) for each in one.rpdos],
                }
                for one in nodes
            ],
            "ports": {
                name: {
                    "is": one.what,
                    "lines": {str(kind): count for kind, count in one.counts.items()},
                    "per_second": one.rate_hz,
                    "lost": one.lost,
                    "refused": one.refused,
                    "last": {str(kind): line.value for kind, line in one.last.items()},
                }
                for name, one in heard.items()
            },
            "wrong": wrong,
        },
    )
