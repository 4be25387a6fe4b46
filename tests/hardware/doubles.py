"""Small devices that answer on python-can's virtual bus, pumped in the test's own thread.

``PumpedBus`` is the virtual bus as the master opens it, except that receiving lets the doubles
answer first: no threads, no waiting, and time is counted in SYNCs.
"""

import threading
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.resources import files
from typing import ClassVar

import can
import canopen

from hardware.cia402 import TRANSITIONS, DriveCommand, DriveState, StatusWord, state_of

EDS = files("hardware") / "eds"
OPERATIONAL = 5
WORDS = {  # status words as CiA 402 lays them down, with voltage enabled and remote
    DriveState.NOT_READY_TO_SWITCH_ON: 0x0200,
    DriveState.SWITCH_ON_DISABLED: 0x0250,
    DriveState.READY_TO_SWITCH_ON: 0x0231,
    DriveState.SWITCHED_ON: 0x0233,
    DriveState.OPERATION_ENABLED: 0x0237,
    DriveState.QUICK_STOP_ACTIVE: 0x0217,
    DriveState.FAULT_REACTION_ACTIVE: 0x021F,
    DriveState.FAULT: 0x0218,
}


class Network(canopen.Network):
    """canopen's network over a queue: what the nodes send, the master receives."""

    def __init__(self) -> None:
        super().__init__()
        self.sent: deque[can.Message] = deque()

    def send_message(self, can_id: int, data: bytes, remote: bool = False) -> None:
        self.sent.append(can.Message(arbitration_id=can_id, data=bytes(data), is_extended_id=False))

    def send_periodic(self, *_: object, **__: object) -> "Network":
        """Take the heartbeat's timer: the doubles send it in every SYNC instead."""
        return self

    def update(self, _data: bytes) -> None:
        """Nothing to update."""

    def stop(self) -> None:
        """Nothing to stop."""


class Node:
    """A node: its objects, its TPDOs on SYNC, its heartbeat in every SYNC."""

    def __init__(self, network: Network, node_id: int, eds: str) -> None:
        self.node = network.create_node(node_id, str(EDS / eds))
        self.network = network
        self.node_id = node_id
        self.operational = False
        self.silent = False
        self.beating = True
        network.subscribe(0x80, self._on_sync)
        network.subscribe(0x000, self._on_nmt)
        for number in range(4):
            network.subscribe(0x200 + 0x100 * number + node_id, self._on_rpdo)

    def get(self, index: int, subindex: int = 0) -> int | float:
        variable = self.node.object_dictionary.get_variable(index, subindex)
        return variable.decode_raw(self.node.get_data(index, subindex))

    def set(self, index: int, value: int | float, subindex: int = 0) -> None:
        variable = self.node.object_dictionary.get_variable(index, subindex)
        self.node.set_data(index, subindex, variable.encode_raw(value))

    def emergency(self, code: int, register: int = 1) -> None:
        self.node.emcy.send(code, register)

    def step(self) -> None:
        """Move on by one SYNC; a node with a life of its own does more."""

    def _on_nmt(self, _identifier: int, data: bytes, _time: float) -> None:
        if data[1] in (0, self.node_id):
            self.operational = data[0] == 1

    def _on_sync(self, _identifier: int, data: bytes, _time: float) -> None:
        self.step()
        if self.silent or not self.operational:
            return
        if self.beating:
            self.network.send_message(0x700 + self.node_id, bytes((OPERATIONAL,)))
        for number in range(4):
            cob_id = int(self.get(0x1800 + number, 1))
            mapped = self._mapped(0x1A00 + number)
            if not cob_id >> 31 and mapped:
                data = b"".join(self.node.get_data(*at) for at in mapped)
                self.network.send_message(cob_id & 0x7FF, data)

    def _on_rpdo(self, identifier: int, data: bytes, _time: float) -> None:
        number = (identifier - 0x200) >> 8
        at = 0
        for index, subindex in self._mapped(0x1600 + number):
            size = len(self.node.object_dictionary.get_variable(index, subindex)) // 8
            self.node.set_data(index, subindex, bytes(data[at : at + size]))
            at += size
        if self.operational:
            self.commanded()

    def commanded(self) -> None:
        """Act on a whole RPDO."""

    def _mapped(self, index: int) -> list[tuple[int, int]]:
        if self.node.object_dictionary.get(index) is None:
            return []
        count = int(self.get(index, 0))
        words = [int(self.get(index, sub)) for sub in range(1, count + 1)]
        return [(word >> 16, word >> 8 & 0xFF) for word in words]


class Drive(Node):
    """A CiA 402 drive without dynamics: speeds are taken at once, positions within two SYNCs."""

    def __init__(self, network: Network, node_id: int, period_s: float = 0.01) -> None:
        super().__init__(network, node_id, "cia402-drive.eds")
        self.state = DriveState.SWITCH_ON_DISABLED
        self.bits = 0
        self.position = 0.0
        self.velocity = 0
        self.period_s = period_s
        self.obeys = True
        self.photocell: Callable[[float, float], float | None] | None = None
        self._control = 0
        self._target: int | None = None
        self._show()

    def fault(self, code: int) -> None:
        self.state, self.velocity = DriveState.FAULT, 0
        self.set(0x603F, code)
        self._show()

    def commanded(self) -> None:
        control, before = int(self.get(0x6040)), self._control
        self._control = control
        mode = int(self.get(0x6060))
        self.set(0x6061, mode)
        if self.obeys:
            self._transit(control, before)
        if self.state is not DriveState.OPERATION_ENABLED:
            self.velocity, self._target, self.bits = 0, None, 0
        elif mode == 3:
            self.velocity = int(self.get(0x60FF))
            self.bits = int(StatusWord.TARGET_REACHED)
        else:
            self._set_point(control, before, mode)
        self._show()

    def step(self) -> None:
        before = self.position
        if self._target is not None:
            self.position = float(self._target)
            self.bits |= int(StatusWord.TARGET_REACHED)
            if int(self.get(0x6061)) == 6:
                self.bits |= int(StatusWord.HOMING_ATTAINED)
            self._target = None
        self.position += self.velocity * self.period_s
        edge = self.photocell(before, self.position) if self.photocell else None
        if edge is not None:
            self.set(0x60D5, (int(self.get(0x60D5)) + 1) % 2**16)
            self.set(0x60BA, _signed(round(edge)))
        self._show()

    def _transit(self, control: int, before: int) -> None:
        for command in (one for one in DriveCommand if _is(one, control, before)):
            following = TRANSITIONS.get((self.state, command))
            if following is not None:
                self.state = following[1]
                return

    def _set_point(self, control: int, before: int, mode: int) -> None:
        risen = control & ~before & 0x10
        if mode == 6 and risen:
            self._target, self.bits = int(self.get(0x607C)), 0
        elif mode == 1:
            if risen:
                self._target = int(self.get(0x607A))
                self.bits = int(StatusWord.SET_POINT_ACKNOWLEDGED)
            elif not control & 0x10:
                self.bits &= ~int(StatusWord.SET_POINT_ACKNOWLEDGED)

    def _show(self) -> None:
        self.set(0x6041, WORDS[self.state] | self.bits)
        self.set(0x6064, _signed(round(self.position)))
        self.set(0x606C, self.velocity)
        assert state_of(int(self.get(0x6041))) is self.state


def _is(command: DriveCommand, control: int, before: int) -> bool:
    if command is DriveCommand.FAULT_RESET:
        return bool(control & ~before & 0x80)
    if command is DriveCommand.DISABLE_VOLTAGE:
        return control & 0x82 == 0
    if command is DriveCommand.QUICK_STOP:
        return control & 0x86 == 0x02
    if command is DriveCommand.SHUTDOWN:
        return control & 0x87 == 0x06
    return control & 0x8F == command


def _signed(value: int) -> int:
    return (value + 2**31) % 2**32 - 2**31


class Amplifier(Node):
    """A CiA 404 amplifier: :meth:`force` sets the raw value of a channel, with a little noise."""

    def __init__(self, network: Network, node_id: int) -> None:
        super().__init__(network, node_id, "cia404-amplifier.eds")
        self.raw = [0, 0, 0, 0]
        self._parity = 0

    def step(self) -> None:
        self._parity ^= 1
        for i, raw in enumerate(self.raw):
            self.set(0x9130, raw + self._parity, i + 1)


class PumpedBus(can.BusABC):
    """A bus whose other end are doubles; whoever receives lets them answer."""

    private = True
    networks: ClassVar[dict[str, Network]] = {}

    def __init__(self, channel: str, **kwargs: object) -> None:
        super().__init__(channel)
        self.channel_info = f"pumped bus {channel}"
        self.network = self.networks[channel]
        self.off = False

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        if self.off:
            raise can.CanOperationError("bus off")
        self.network.notify(msg.arbitration_id, bytearray(msg.data), msg.timestamp)

    def recv(self, timeout: float | None = None) -> can.Message | None:
        if self.network.sent:
            return self.network.sent.popleft()
        return None


@contextmanager
def bench(channel: str) -> Iterator[Network]:
    """A network under a channel's name, opened by ``interface = "pumped"``."""
    network = Network()
    PumpedBus.networks[channel] = network
    can.interface.BACKENDS["pumped"] = (__name__, "PumpedBus")
    try:
        yield network
    finally:
        del PumpedBus.networks[channel]
        del can.interface.BACKENDS["pumped"]


@contextmanager
def virtual(channel: str) -> Iterator[Network]:
    """The same behind python-can's virtual bus, served by a thread as a device would be."""
    network = Network()
    bus = can.Bus(interface="virtual", channel=channel, ignore_config=True)
    stop = threading.Event()

    def serve() -> None:
        while not stop.is_set():
            frame = bus.recv(0.02)
            if frame is not None:
                network.notify(frame.arbitration_id, frame.data, frame.timestamp)
            while network.sent:
                bus.send(network.sent.popleft())

    thread = threading.Thread(target=serve, name="doubles")
    thread.start()
    try:
        yield network
    finally:
        stop.set()
        thread.join()
        bus.shutdown()
