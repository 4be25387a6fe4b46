"""A simulated CANopen node: objects, mapping, process data on SYNC, heartbeat."""

from collections.abc import Callable
from typing import Any, Final

import canopen
from canopen.objectdictionary import datatypes
from canopen.sdo.exceptions import SdoAbortedError

from hardware.description.errors import ConfigurationError
from hardware.dictionary import Entry, PdoLayout, layout, load, variable
from sim.devices.network import HEARTBEAT, Wire

Number = int | float
_START, _STOP, _PRE_OPERATIONAL, _RESET, _RESET_COMMUNICATION = 1, 2, 128, 129, 130
_STATES: Final = {_START: 5, _STOP: 4, _PRE_OPERATIONAL: 127}
_NOT_VALID: Final = 1 << 31
_COMMUNICATION: Final = range(0x1000, 0x2000)  # CiA 301's objects
_CONSUMED_BEAT, _PRODUCED_BEAT = Entry(0x1016, 1), Entry(0x1017)
_SYNC_PERIOD, _OUT_OF_RANGE = Entry(0x1006), 0x06090030
_NO_SUCH_OBJECT: Final = 0x06020000
_CANNOT_BE_MAPPED, _TOO_LONG = 0x06040041, 0x06040042


class SimulatedNode:
    """A node on the simulated bus.

    canopen's ``LocalNode`` serves SDO; the process data are packed here.

    Attributes
    ----------
    values
        Every object that has been written or that the device keeps up to date.
    beating, talking
        Faults: without heartbeat, without process data.
    lacking
        Indices of objects of the EDS that this device does not have.
    """

    def __init__(
        self, wire: Wire, name: str, node_id: int, eds: str, sample_rate_hz: float
    ) -> None:
        self.name = name
        self.node_id = node_id
        self.wire = wire
        self.sample_rate_hz = sample_rate_hz
        self.dictionary = load(eds, node_id, name)
        self.values: dict[tuple[int, int], Number] = {}
        self.operational = False
        self.beating = self.talking = True
        self.lacking: set[int] = set()
        self._state = _STATES[_PRE_OPERATIONAL]
        self._toggle = 0x80  # the first answer has the bit at 0
        self._packed: tuple[tuple[int, Callable[..., bytes], tuple[Entry, ...]], ...] = ()
        self._beat_every = 0
        self._master = HeartbeatConsumer(wire, sample_rate_hz)
        self._local = canopen.LocalNode(node_id, self.dictionary)
        wire[node_id] = self._local
        self._local.add_read_callback(self._read)
        self._local.add_write_callback(self._write)
        wire.subscribe(0, self._on_nmt)
        wire.guarded[node_id] = self._guard

    def tick(self) -> None:
        """Go on by one sample."""

    def written(self, at: Entry, value: Number) -> None:
        """Act on an object that was written by SDO."""

    def commanded(self) -> None:
        """Act on a whole RPDO."""

    def number(self, at: Entry) -> Number:
        """Return an object's value, or its default in the EDS, or 0."""
        if at not in self.values:
            variable_at = variable(self.dictionary, at)
            default = None if variable_at is None else variable_at.default
            self.values[at] = default if isinstance(default, int | float) else 0
        return self.values[at]

    def answer(self) -> None:
        """Send heartbeat and process data for the present tick."""
        wire = self.wire
        self.beat()
        if self.operational and self.talking:
            values = self.values
            for cob_id, pack, entries in self._packed:
                wire.emit(cob_id, pack(*[values[at] for at in entries]))

    def beat(self) -> None:
        """Send the heartbeat if it is due in the present tick."""
        if self._beat_every and self.beating and not self.wire.number % self._beat_every:
            self.wire.emit(HEARTBEAT + self.node_id, bytes((self._state,)))

    def emergency(self, code: int, register: int = 1) -> None:
        """Send an emergency message; code 0 says that all is well again."""
        self._local.emcy.send(code, register)

    def boot(self) -> None:
        """Lose power for a moment: boot-up message, pre-operational, volatile objects forgotten."""
        self._enter(_STATES[_PRE_OPERATIONAL])
        self.values.clear()
        self._local.data_store.clear()
        self._beat_every = 0
        self._master.watch(0)
        self.wire.emit(HEARTBEAT + self.node_id, b"\0")

    def disconnected(self) -> None:
        """Act on an NMT command that ends process data: stop, or reset of the communication."""

    def _restart_communication(self) -> None:
        """Forget the communication's objects, and say so as after power-on; the device goes on."""
        self.disconnected()
        self._enter(_STATES[_PRE_OPERATIONAL])
        for at in [address for address in self.values if address[0] in _COMMUNICATION]:
            del self.values[at]
            self._local.data_store.get(at[0], {}).pop(at[1], None)
        self._beat_every = 0
        self._master.watch(0)
        self.wire.emit(HEARTBEAT + self.node_id, b"\0")

    def master_lost(self) -> bool:
        """Tell whether the heartbeat that this node watches has stayed away for too long."""
        return self._master.lost

    def _guard(self) -> int:
        """Return the state, with a toggle bit that changes at each question (CiA 301)."""
        self._toggle ^= 0x80
        return self._state | self._toggle

    def _on_nmt(self, _identifier: int, data: bytearray, _time: float) -> None:
        command, node_id = data[0], data[1]
        if node_id not in (0, self.node_id):
            return
        if command == _RESET:
            self.boot()
        elif command == _RESET_COMMUNICATION:
            self._restart_communication()
        elif command in _STATES:
            self._enter(_STATES[command])
            if command == _STOP:
                self.disconnected()

    def _enter(self, state: int) -> None:
        self._state, self.operational = state, state == _STATES[_START]
        for cob_id in [
            cob_id_used for cob_id_used in self.wire.rpdos if cob_id_used & 0x7F == self.node_id
        ]:
            del self.wire.rpdos[cob_id]
        if self.operational:
            self._packed = tuple(
                (pdo.cob_id, pdo.code.pack, pdo.entries) for pdo in self._mapped(0x1800, 0x1A00)
            )
            for pdo in self._mapped(0x1400, 0x1600):
                self.wire.rpdos[pdo.cob_id] = self._taker(pdo)

    def _mapped(self, record: int, mapping: int) -> list[PdoLayout]:
        pdos = []
        for n in range(4):
            cob_id = int(self.number(Entry(record + n, 1)))
            count = int(self.number(Entry(mapping + n, 0)))
            words = [int(self.number(Entry(mapping + n, sub + 1))) for sub in range(count)]
            if words and cob_id and not cob_id & _NOT_VALID:
                pdos.append(self._layout(words, cob_id & 0x7FF))
        for at in (at for pdo in pdos for at in pdo.entries):
            self.number(at)  # from now on it has a value
        return pdos

    def _layout(self, words: list[int], cob_id: int = 0) -> PdoLayout:
        entries = tuple(Entry(word >> 16, word >> 8 & 0xFF) for word in words)
        return layout(self.dictionary, entries, cob_id, self.name)

    def _taker(self, pdo: PdoLayout) -> Callable[[bytes | bytearray], None]:
        def take(data: bytes | bytearray) -> None:
            if len(data) >= pdo.size:
                self.values.update(zip(pdo.entries, pdo.code.unpack_from(data), strict=True))
                self.commanded()

        return take

    def _read(self, index: int, subindex: int, od: Any) -> Number | None:
        self._refuse_lacking(index)
        return self.values.get((index, subindex))

    def _write(self, index: int, subindex: int, od: Any, data: bytes) -> None:
        self._refuse_lacking(index)
        if od.data_type not in datatypes.NUMBER_TYPES:
            return
        at, value = Entry(index, subindex), od.decode_raw(data)
        if 0x1600 <= index < 0x1604 or 0x1A00 <= index < 0x1A04:
            self._check_mapping(at, value)
        if at == _SYNC_PERIOD and abs(value * self.sample_rate_hz - 1e6) > self.sample_rate_hz:
            raise SdoAbortedError(_OUT_OF_RANGE)
        self.values[at] = value
        if at == _CONSUMED_BEAT:
            self._master.watch(int(value))
        if at == _PRODUCED_BEAT:
            self._beat_every = max(1, int(value * self.sample_rate_hz / 1000.0)) if value else 0
        self.written(at, value)

    def _refuse_lacking(self, index: int) -> None:
        if index in self.lacking:
            raise SdoAbortedError(_NO_SUCH_OBJECT)

    def _check_mapping(self, at: Entry, word: int) -> None:
        """Refuse, as a device does, what cannot be mapped or does not fit into 8 bytes."""
        words = [word]
        if not at.subindex:
            words = [int(self.number(Entry(at.object_index, sub + 1))) for sub in range(word)]
        try:
            self._layout(words)
        except ConfigurationError as error:
            raise SdoAbortedError(_CANNOT_BE_MAPPED if at.subindex else _TOO_LONG) from error


class HeartbeatConsumer:
    """Watches the heartbeat of one other node.

    It begins with the first heartbeat after it was set, so that a producer of before does not
    count, and it watches in every NMT state: what the node makes of a loss is its profile's affair.
    """

    def __init__(self, wire: Wire, sample_rate_hz: float) -> None:
        self._wire, self._rate_hz = wire, sample_rate_hz
        self._watched, self._patience = 0, 0.0
        self._last: int | None = None
        wire.hearing.append(self._hear)

    def watch(self, entry: int) -> None:
        """Take what is written to 1016: node id in bits 16 to 22, milliseconds below; 0 is none."""
        self._watched = entry >> 16 & 0x7F
        self._patience = (entry & 0xFFFF) * self._rate_hz / 1000.0
        self._last = None

    @property
    def lost(self) -> bool:
        """Whether the heartbeat came and has stayed away for longer than it may."""
        return self._last is not None and self._wire.number - self._last > self._patience

    def _hear(self, node_id: int) -> None:
        if self._patience and node_id == self._watched:
            self._last = self._wire.number
