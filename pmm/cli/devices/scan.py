"""``pmm devices scan``: who answers on a bus and on serial ports."""

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import click

from pmm.cli.devices import ANY, Target, print_json, print_table
from pmm.cli.screen import busy, error_line

if TYPE_CHECKING:
    from collections.abc import Sequence

    from hardware.listening import Heard
    from hardware.scan import FoundNode, Mapping
    from pmm.devices.survey import Survey

_PROFILES = {401: "input and output", 402: "drive", 404: "measuring device", 406: "encoder"}


@click.command()
@ANY
@click.option("--listen", "listen_s", metavar="S", type=click.FloatRange(min=0.0), default=1.1,
              show_default=True, help="How long to listen for heartbeats and lines.")  # fmt: skip
def scan(listen_s: float, as_json: bool, **options: Any) -> None:
    """List who answers: identity, state, heartbeat, mapping.

    Nothing is changed: no SYNC, no state is commanded. With a rig's file, who is missing is named.
    """
    with busy("scanning"):
        found = _survey(Target(**options), listen_s)
    silent = [f"{name}: {one.what}" for name, one in found.heard.items() if one.what == "silent"]
    wrong = found.wrong + silent
    if as_json:
        _print_document(found.nodes, found.names, found.heard, wrong)
    else:
        _print_nodes(found.nodes, found.names)
        _print_heard(found.heard)
        for one in wrong:
            error_line(one)
    if wrong:
        raise click.exceptions.Exit(1)


def _survey(target: Target, listen_s: float) -> "Survey":
    from pmm.devices.survey import survey_bus, survey_port, survey_rig

    tables = target.tables()
    if tables is not None:
        return survey_rig(tables, listen_s)
    if target.interface:
        return survey_bus(target.bus(), listen_s)
    return survey_port(target.port_settings(), listen_s)


def _mapping(one: "Mapping") -> str:
    objects = " ".join(str(at) for at in one.entries)
    return f"{one.cob_id:03X} {objects} ({_transmission(one.transmission)})"


def _transmission(kind: int) -> str:
    if kind == 0:
        return "SYNC, if changed"
    return ("SYNC" if kind == 1 else f"SYNC/{kind}") if kind <= 240 else "event"


def _identity(node: "FoundNode") -> str:
    parts = (node.vendor, node.product, node.revision, node.serial)
    return " ".join("-" if one is None else f"{one:X}" for one in parts)


def _print_nodes(nodes: "Sequence[FoundNode]", names: dict[int, str]) -> None:
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


def _print_heard(heard: "dict[str, Heard]") -> None:
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


def _last(heard: "Heard") -> str:
    lines = [f"{kind} {line.value:g}" for kind, line in heard.last.items()]
    return ", ".join(lines) or heard.first_refused


def _print_document(
    nodes: "Sequence[FoundNode]", names: dict[int, str], heard: "dict[str, Heard]", wrong: list[str]
) -> None:
    """Print everything as one JSON document."""

    def pdo(one: "Mapping") -> dict[str, Any]:
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
