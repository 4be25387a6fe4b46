"""Who answers on a CAN bus: asked by SDO, listened to for heartbeats; nothing is changed.

No SYNC and no NMT command is sent, so that a bus in operation can be looked at.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Final

import can
import canopen

from hardware.dictionary import Entry
from hardware.errors import HardwareError
from hardware.master import Master
from hardware.sdo import Sdo

# 0 is the boot-up message, with which a node enters pre-operational (CiA 301).
STATES: Final = {0: "pre-operational", 4: "stopped", 5: "operational", 127: "pre-operational"}
_REQUEST, _RESPONSE, _HEARTBEAT = 0x600, 0x580, 0x700
_ASK_DEVICE_TYPE: Final = bytes.fromhex("4000100000000000")
_APART_S, _ANSWER_S, _GUARD_S = 0.002, 0.3, 0.05
_NOT_VALID: Final = 1 << 31
_PDOS: Final = 4


@dataclass(frozen=True)
class Mapping:
    """A PDO as the node has it now.

    Attributes
    ----------
    transmission
        1 to 240: with every so-manieth SYNC; 254, 255: on an event.
    entries, bits
        What it carries, and how many bits each takes.
    """

    cob_id: int
    transmission: int
    entries: tuple[Entry, ...]
    bits: tuple[int, ...]


@dataclass(frozen=True)
class FoundNode:
    """What a node says of itself; ``None`` and empty where it does not say.

    Attributes
    ----------
    device_type
        Object 1000; its lower half is the profile, 402 for drives and 404 for measuring devices.
    vendor, product, revision, serial
        Object 1018.
    state
        Of its heartbeat, or its answer to node guarding; empty if it gives neither.
    heartbeat_ms
        Object 1017; 0: it sends none.
    """

    node_id: int
    device_type: int
    vendor: int | None = None
    product: int | None = None
    revision: int | None = None
    serial: int | None = None
    name: str = ""
    state: str = ""
    heartbeat_ms: int | None = None
    tpdos: tuple[Mapping, ...] = ()
    rpdos: tuple[Mapping, ...] = ()

    @property
    def profile(self) -> int:
        """The number of the CiA profile that it follows; 0 if none."""
        return self.device_type & 0xFFFF


@dataclass
class Ear:
    """Listens to all frames of a bus; hand it to the master as an observer."""

    states: dict[int, int] = field(default_factory=dict)
    types: dict[int, int] = field(default_factory=dict)

    def __call__(self, frame: can.Message) -> None:
        """Note states and device types."""
        if not frame.is_rx or frame.is_error_frame or frame.is_remote_frame or not frame.data:
            return
        kind, node_id = frame.arbitration_id & 0x780, frame.arbitration_id & 0x7F
        if kind == _HEARTBEAT:
            self.states[node_id] = frame.data[0] & 0x7F
        elif kind == _RESPONSE and bytes(frame.data[1:4]) == _ASK_DEVICE_TYPE[1:4]:
            if frame.data[0] != 0x80:  # not an abort
                self.types[node_id] = int.from_bytes(frame.data[4:8], "little")
            else:
                self.types[node_id] = 0


def scan(master: Master, ear: Ear, listen_s: float = 1.1) -> tuple[FoundNode, ...]:
    """Return the nodes that answer, by their ids.

    Parameters
    ----------
    master
        A master that has not been prepared, with ``ear`` among its observers.
    listen_s
        How long to listen for heartbeats: longer than the slowest period.

    Raises
    ------
    BusOffError, DeadReceiveThreadError
        If the bus cannot carry the questions.
    """
    for node_id in range(1, 128):
        master.send(_REQUEST + node_id, _ASK_DEVICE_TYPE)
        _listen(master, _APART_S)
    _listen(master, max(listen_s, _ANSWER_S))
    for node_id in sorted(set(ear.types) - set(ear.states)):
        master.request(_HEARTBEAT + node_id)
        _listen(master, _GUARD_S)
    return tuple(
        _ask(master, node_id, ear.types[node_id], STATES.get(ear.states.get(node_id, -1), ""))
        for node_id in sorted(ear.types)
    )


def _listen(master: Master, seconds: float) -> None:
    """Deliver what comes; a bus on which nothing can come any more says so at once."""
    end = master.clock() + seconds
    while (frame := master.receive(max(end - master.clock(), 0.0))) is not None:
        master.deliver(frame)


class _Questions:
    """Reads objects of a node; what it does not have is ``None``."""

    def __init__(self, master: Master, node_id: int) -> None:
        self._sdo = Sdo(f"node {node_id}", node_id, canopen.ObjectDictionary(), master)

    def number(self, index: int, sub: int = 0) -> int | None:
        data = self._bytes(index, sub)
        return None if data is None else int.from_bytes(data, "little")

    def text(self, index: int) -> str:
        data = self._bytes(index, 0) or b""
        return data.rstrip(b"\0").decode("latin-1").strip()

    def _bytes(self, index: int, sub: int) -> bytes | None:
        try:
            return self._sdo.read_raw(Entry(index, sub))
        except HardwareError:
            return None


def _ask(master: Master, node_id: int, device_type: int, state: str) -> FoundNode:
    ask = _Questions(master, node_id)
    vendor, product, revision, serial = (ask.number(0x1018, sub) for sub in (1, 2, 3, 4))
    return FoundNode(
        node_id,
        device_type,
        vendor,
        product,
        revision,
        serial,
        ask.text(0x1008),
        state,
        ask.number(0x1017),
        tuple(_mappings(ask, 0x1800, 0x1A00)),
        tuple(_mappings(ask, 0x1400, 0x1600)),
    )


def _mappings(ask: _Questions, record: int, mapping: int) -> Iterator[Mapping]:
    for number in range(_PDOS):
        cob_id = ask.number(record + number, 1)
        if cob_id is None or cob_id & _NOT_VALID:
            continue
        count = ask.number(mapping + number) or 0
        words = [ask.number(mapping + number, sub) or 0 for sub in range(1, min(count, 8) + 1)]
        if words:
            yield Mapping(
                cob_id & 0x7FF,
                ask.number(record + number, 2) or 0,
                tuple(Entry(word >> 16, word >> 8 & 0xFF) for word in words),
                tuple(word & 0xFF for word in words),
            )
