"""What is watched in every cycle: error frames, heartbeats, emergencies, process data."""

import math
from collections.abc import Iterable, Iterator
from typing import Final

import can
from canopen.emcy import EMCY_STRUCT

from hardware.bus import BusConfiguration
from hardware.errors import (
    BusOffError,
    EmergencyError,
    ErrorFramesError,
    FollowingError,
    HardwareError,
    HeartbeatLostError,
    NodeStateError,
    OtherMasterError,
    ProcessDataLostError,
)
from hardware.node import Node

OPERATIONAL: Final = 5
_PRE_OPERATIONAL: Final = 127
_BUS_OFF: Final = 0x40  # error class in the identifier of an error frame
_FOLLOWING_ERROR: Final = 0x8611


class ErrorFrames:
    """Counts error frames as a CAN controller counts errors: 8 up a frame, 1 down a cycle."""

    LIMIT: Final = 128

    def __init__(self) -> None:
        self.total = 0
        self._level = 0
        self._told = False
        self._bus_off = False

    def take(self, frame: can.Message) -> None:
        """Count an error frame."""
        self.total += 1
        self._level += 8
        self._bus_off = self._bus_off or bool(frame.arbitration_id & _BUS_OFF)

    def check(self, state: can.BusState) -> Iterator[HardwareError]:
        """Yield what a cycle's error frames and the controller's state amount to."""
        if self._bus_off or state is can.BusState.ERROR:
            self._bus_off = False
            yield BusOffError("bus", "the controller is bus-off; check cable, termination, rate")
        if self._level >= self.LIMIT and not self._told:
            self._told = True
            yield ErrorFramesError(
                "bus",
                f"{self.total} error frames, faster than cycles wear them off "
                f"(level {self._level}, limit {self.LIMIT}); check cable, termination, bit rate",
            )
        self._level = max(self._level - 1, 0)
        self._told = self._told and self._level > 0


class Supervisor:
    """Watches the nodes; every finding is told once, until :meth:`reset`."""

    def __init__(self, configuration: BusConfiguration, nodes: Iterable[Node]) -> None:
        self._nodes = {node.node_id: node for node in nodes}
        self._gap = configuration.allowed_gap_cycles
        beat_cycles = configuration.heartbeat_ms / 1000.0 * configuration.sync_rate_hz
        self._beat_limit = math.ceil(beat_cycles) + self._gap
        self._found: list[HardwareError] = []
        self._told: set[tuple[str, str]] = set()
        self._started = 0

    def start(self, number: int) -> None:
        """Begin to count from cycle ``number``.

        A heartbeat of before may still be on its way, so that the state has as long as the first
        heartbeat.
        """
        self._started = number
        for node in self._nodes.values():
            node.last_beat = number
            for stream in node.streams:
                stream.last = number
        self.reset()

    def reset(self) -> None:
        """Forget what was told: findings that persist are told again."""
        self._found.clear()
        self._told.clear()

    def heartbeat(self, node_id: int, data: bytes | bytearray, number: int) -> None:
        """Note a node's heartbeat in cycle ``number``; report a state other than operational."""
        node = self._nodes[node_id]
        node.last_beat = number
        state = data[0] & 0x7F if data else -1
        on_its_way = state == _PRE_OPERATIONAL and number - self._started <= self._beat_limit
        if state != OPERATIONAL and not on_its_way:
            change = "booted" if state == 0 else f"is in state {state}, not operational"
            self._tell(NodeStateError(node.name, f"node {node_id} {change} during operation"))

    def emergency(self, node_id: int, data: bytes | bytearray) -> None:
        """Take an emergency message; a reset (code 00xx) lets the same one be told again."""
        code, register, vendor = EMCY_STRUCT.unpack(bytes(data[:8]).ljust(8, b"\0"))
        name = self._nodes[node_id].name
        if code & 0xFF00 == 0:
            self._told = {key for key in self._told if key[1] != name}
        elif code == _FOLLOWING_ERROR:
            self._tell(FollowingError(name, f"emergency 0x{code:04X}: outside its window"))
        else:
            self._tell(EmergencyError(name, code, register, vendor))

    def other_master(self, said: str) -> None:
        """Report a command that came from another master, ``said`` in words."""
        self._tell(
            OtherMasterError(
                "bus", f"another controller sent {said}; end it, see to the axes, then reset"
            )
        )

    def check(self, number: int) -> list[HardwareError]:
        """Return what is new since the last call, gaps up to SYNC ``number`` included."""
        for node in self._nodes.values():
            if number - node.last_beat > self._beat_limit:
                self._tell(self._no_beat(node, number))
            for stream in node.streams:
                if number - stream.last > self._gap:
                    self._tell(self._no_data(node, stream.layout.cob_id, number - stream.last))
        errors, self._found = self._found, []
        return errors

    def _no_beat(self, node: Node, number: int) -> HardwareError:
        return HeartbeatLostError(
            node.name,
            f"no heartbeat of node {node.node_id} for {number - node.last_beat} cycles "
            f"(limit {self._beat_limit})",
        )

    def _no_data(self, node: Node, cob_id: int, gap: int) -> HardwareError:
        return ProcessDataLostError(
            node.name, f"no TPDO 0x{cob_id:03X} for {gap} cycles (limit {self._gap})"
        )

    def _tell(self, error: HardwareError) -> None:
        code = error.code if isinstance(error, EmergencyError) else ""
        key = (f"{type(error).__name__}{code}", error.device)
        if key not in self._told:
            self._told.add(key)
            self._found.append(error)
