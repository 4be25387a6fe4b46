"""The CANopen master: one exchange per cycle, and nothing behind the caller's back."""

import threading
from collections.abc import Callable, Sequence
from contextlib import ExitStack, suppress
from typing import Final

import can
import canopen

from hardware.bus import BusConfiguration, Pumped, Receiver, Sender, Threaded, open_bus
from hardware.bus_owner import is_private, owned_bus
from hardware.dictionary import PdoLayout
from hardware.errors import HardwareError, as_fault
from hardware.node import Node, PdoStream
from hardware.other_master import OtherMasterWatch
from hardware.sdo import GuardedNetwork
from hardware.supervision import OPERATIONAL, ErrorFrames, Supervisor

Clock = Callable[[], float]
Observer = Callable[[can.Message], None]
Prompt = Callable[[str], str | None]
_NMT, _SYNC, _EMCY, _HEARTBEAT = 0x000, 0x080, 0x080, 0x700
_START, _PRE_OPERATIONAL = 0x01, 0x80
_REPEAT_CYCLES: Final = 10  # RPDOs go out when they change, and again so often
_FRAMES_A_CYCLE: Final = 4096  # a babbling node must not keep the loop for ever


class Master:
    """Owns a bus: sends SYNC and heartbeat, collects process data, watches the nodes.

    Parameters
    ----------
    clock
        Monotonic seconds: the host's in real time, the simulated bus's otherwise. It only limits
        waiting; samples are numbered by SYNC.
    observers
        Called with every frame sent and received, for a raw log.

    Raises
    ------
    BusOpenError
        If the bus cannot be opened.
    """

    def __init__(
        self, configuration: BusConfiguration, clock: Clock, observers: Sequence[Observer] = ()
    ) -> None:
        self.configuration = configuration
        self.clock = clock
        self.lock = threading.RLock()
        self.delivering = False
        self.healthy = True
        self.nodes: list[Node] = []
        self.error_frames = ErrorFrames()
        self._observers = tuple(observers)
        with ExitStack() as stack:
            stack.enter_context(owned_bus(configuration))
            self._bus = open_bus(configuration)
            self._owned = stack.pop_all()
        self._sender = Sender(self._bus)
        receiver = Threaded if configuration.receive_thread else Pumped
        self._receiver: Receiver = receiver(self._bus)
        self.network = GuardedNetwork(self._send)
        self._streams: dict[int, PdoStream] = {}
        self._supervisor = Supervisor(configuration, ())
        self._supervised: dict[int, tuple[Callable[..., None], int]] = {}
        self._number = 0
        self._commanded = False  # whether any node's state was commanded
        self._company = OtherMasterWatch(configuration)
        self._operating = False
        self._missing = 0
        beat_cycles = configuration.heartbeat_ms / 1000.0 * configuration.sync_rate_hz
        self._beat_every = max(1, int(beat_cycles))

    @property
    def operator(self) -> Callable[[Prompt], Prompt] | None:
        """What the bus knows of an operator: a simulated rig's does with its own hands."""
        return getattr(self._bus, "operator", None)

    def add(
        self,
        name: str,
        node_id: int,
        dictionary: canopen.ObjectDictionary,
        tpdos: tuple[PdoLayout, ...] = (),
        rpdos: tuple[PdoLayout, ...] = (),
    ) -> Node:
        """Add a node with its PDOs; :meth:`start` configures and starts it."""
        node = Node(name, node_id, dictionary, tpdos, rpdos, self)
        self.nodes.append(node)
        self._streams |= {stream.layout.cob_id: stream for stream in node.streams}
        return node

    def prepare(self) -> None:
        """Listen for another master, then bring all nodes to pre-operational and configure them.

        Raises
        ------
        OtherMasterError
            If another one commands the bus: nothing was sent.
        SdoTimeoutError, SdoAbortError
            If a node does not answer or refuses.
        """
        self._listen()
        self._commanded = True
        self._send(_NMT, bytes((_PRE_OPERATIONAL, 0)))
        for node in self.nodes:
            node.configure(self.configuration)

    def start(self) -> None:
        """Start all nodes and the supervision.

        Raises
        ------
        OtherMasterError
            If another one has commanded the bus meanwhile.
        """
        self._drain()
        self._company.refuse()
        self._supervisor = Supervisor(self.configuration, self.nodes)
        self._supervisor.start(self._number)
        for node in self.nodes:
            self._supervised[_HEARTBEAT + node.node_id] = (self._heartbeat, node.node_id)
            self._supervised[_EMCY + node.node_id] = (self._emergency, node.node_id)
        self._send(_NMT, bytes((_START, 0)))
        self._operating = True

    def exchange(self, number: int) -> list[HardwareError]:
        """Run the bus part of cycle ``number``: heartbeat, SYNC, answers; return what was found.

        The heartbeat goes out here only, and only while :attr:`healthy`: a loop that hangs or has
        lost its bus falls silent, and the drives stop by themselves.
        """
        with self.lock:
            self._number = number
            try:
                self._announce(number)
                faults = self._collect()
            except Exception as error:  # an adapter may raise anything
                faults = [as_fault("bus", error)]
            try:
                faults += self._watch(number)
            except Exception as error:  # what is found in a cycle is told, whatever comes of it
                faults.append(as_fault("bus", error))
            return faults

    def flush(self) -> list[HardwareError]:
        """Send the process data that the devices have set; return what went wrong.

        A value that fits no object of a node does not keep the other nodes from theirs; a bus that
        takes nothing is not tried again and again.
        """
        repeat = self._number % _REPEAT_CYCLES == 0
        faults: list[HardwareError] = []
        for node in self.nodes:
            try:
                for identifier, data in node.outputs(repeat=repeat):
                    self._send(identifier, data)
            except HardwareError as error:
                return [*faults, error]
            except Exception as error:  # a value that does not fit its object, for example
                faults.append(as_fault(node.name, error))
        return faults

    def reset(self) -> None:
        """Let findings be told again and the heartbeat run: the operator has reset the faults."""
        self._supervisor.reset()
        self._company.forget()
        self.healthy = True

    def send(self, identifier: int, data: bytes) -> None:
        """Send one frame beside the cycle; for looking around on a bus.

        Raises
        ------
        BusOffError
            If the adapter cannot send.
        """
        self._send(identifier, data)

    def request(self, identifier: int) -> None:
        """Ask by remote frame for the frame of an identifier; raises as :meth:`send`."""
        self._sender.request(identifier)

    def receive(self, timeout_s: float) -> can.Message | None:
        """Return the next frame, or ``None``; for SDO transfers."""
        return self._receiver.receive(timeout_s)

    def deliver(self, frame: can.Message) -> None:
        """Hand a frame to the stream, the supervision or the SDO client that it concerns."""
        self.delivering = True
        try:
            for observe in self._observers:
                observe(frame)
            self._dispatch(frame)
        finally:
            self.delivering = False

    def close(self) -> None:
        """Bring the nodes to pre-operational if possible, and let go of the bus.

        A master that has only looked, as a scan does, leaves the nodes as they were; so does one
        that has met another.
        """
        try:
            if self._commanded and not self._company.is_other_heard:
                self._send(_NMT, bytes((_PRE_OPERATIONAL, 0)))
        except HardwareError:
            pass  # a lost bus cannot be told anything
        finally:
            self._receiver.close()
            with suppress(can.CanError, OSError):  # a dead adapter cannot be told good-bye
                self._bus.shutdown()
            self._owned.close()

    def _listen(self) -> None:
        """Listen for another master before anything is sent; on a private bus there is none."""
        self._company.begin([rpdo for node in self.nodes for rpdo in node.rpdos])
        listen_ms = 0 if is_private(self.configuration) else self.configuration.listen_ms
        end = self.clock() + listen_ms / 1000.0
        while (frame := self.receive(max(end - self.clock(), 0.0))) is not None:
            self.deliver(frame)
        self._company.refuse()

    def _look(self, frame: can.Message) -> None:
        """Notice what only another master sends."""
        if said := self._company.look(frame, operating=self._operating):
            self._supervisor.other_master(said)

    def _dispatch(self, frame: can.Message) -> None:
        identifier = frame.arbitration_id
        if frame.is_error_frame:
            self.error_frames.take(frame)
        elif frame.is_remote_frame or frame.is_extended_id:
            self._look(frame)
        elif (stream := self._streams.get(identifier)) is not None:
            self._missing -= 1
            stream.take(frame.data)
        elif (handler := self._supervised.get(identifier)) is not None:
            handler[0](handler[1], frame.data)
        else:
            self._look(frame)
            self.network.notify(identifier, frame.data, frame.timestamp)

    def _heartbeat(self, node_id: int, data: bytearray) -> None:
        self._supervisor.heartbeat(node_id, data, self._number)

    def _emergency(self, node_id: int, data: bytearray) -> None:
        self._supervisor.emergency(node_id, data)

    def _announce(self, number: int) -> None:
        if self.healthy and number % self._beat_every == 0:
            beat = _HEARTBEAT + self.configuration.master_node
            self._send(beat, bytes((OPERATIONAL,)))
        overflow = self.configuration.sync_overflow
        self._send(_SYNC, bytes(((number - 1) % overflow + 1,)) if overflow else b"")

    def _collect(self) -> list[HardwareError]:
        """Deliver frames until every TPDO has come or its time is over, and whatever is there."""
        faults: list[HardwareError] = []
        end = self.clock() + self.configuration.answer_s
        if self._operating:
            # A stream that missed its last SYNC owes two frames: so a late one is not taken for
            # the present one's.
            self._missing = sum(self._number - stream.last for stream in self._streams.values())
        for _ in range(_FRAMES_A_CYCLE):
            frame = self._receiver.receive(0.0)
            if frame is None and self._missing > 0:
                frame = self._receiver.receive(max(end - self.clock(), 0.0))
            if frame is None:
                return faults
            try:
                self.deliver(frame)
            except Exception as error:  # a frame of a foreign node may hold anything
                faults.append(as_fault("bus", error))
        return faults

    def _watch(self, number: int) -> list[HardwareError]:
        """Number what came, and return what a cycle shows of the bus."""
        for stream in self._streams.values():
            stream.close(number)
        faults = list(self.error_frames.check(self._bus.state))
        return faults + (self._supervisor.check(number) if self._operating else [])

    def _drain(self) -> None:
        while (frame := self._receiver.receive(0.0)) is not None:
            self.deliver(frame)

    def _send(self, identifier: int, data: bytes) -> None:
        frame = self._sender.send(identifier, data)
        self._company.sent(frame)
        for observe in self._observers:
            observe(frame)
