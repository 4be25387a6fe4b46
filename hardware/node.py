"""One node on the bus: its objects, its process data, its settings for operation."""

from typing import Final

import canopen

from hardware.bus import BusConfiguration
from hardware.dictionary import Entry, PdoLayout, has
from hardware.errors import ProcessDataLostError
from hardware.sdo import Carrier, Number, Sdo

Values = tuple[Number, ...]
_NOT_VALID: Final = 1 << 31
_EVERY_SYNC, _AT_ONCE = 1, 255
_SYNC_COB_ID, _SYNC_PERIOD, _SYNC_OVERFLOW = Entry(0x1005), Entry(0x1006), Entry(0x1019)
CONSUMED_BEAT, _PRODUCED_BEAT = Entry(0x1016, 1), Entry(0x1017)


class PdoStream:
    """The frames of one TPDO, numbered by the SYNC that asked for them.

    ``samples`` are those of the last cycle: usually one; none if it is late; two if the one of the
    cycle before came late. A sample is never lost because the host was slow.
    """

    def __init__(self, layout: PdoLayout, owner: "Node") -> None:
        self.layout = layout
        self.samples: list[tuple[int, Values]] = []
        self.last = 0
        self._owner = owner
        self._frames: list[Values] = []

    def take(self, data: bytes | bytearray) -> None:
        """Take a frame.

        Raises
        ------
        ProcessDataLostError
            If it has not the length of the mapping.
        """
        layout = self.layout
        if len(data) != layout.code.size:
            raise ProcessDataLostError(
                self._owner.name,
                f"TPDO 0x{self.layout.cob_id:03X} has {len(data)} bytes where its mapping "
                f"({', '.join(map(str, self.layout.entries))}) has {self.layout.size}",
            )
        values = layout.code.unpack(data)
        self._frames.append(values)
        self._owner.values.update(zip(layout.entries, values, strict=True))

    def close(self, number: int) -> None:
        """Number what came until now: the last frame belongs to SYNC ``number``."""
        frames = self._frames
        if len(frames) == 1:
            self.samples = [(number, frames[0])]
        else:
            recent_frames = frames[self.last - number :] if number > self.last else []
            first = number - len(recent_frames) + 1
            self.samples = [(first + i, values) for i, values in enumerate(recent_frames)]
        if frames:
            self.last = number
            self._frames = []


class Node:
    """A device on the bus, as its EDS describes it.

    Attributes
    ----------
    values
        The latest process data by object.
    streams
        Its TPDOs, one per mapping, in order.
    last_beat
        Number of the cycle in which its heartbeat last came.
    cyclic
        Whether it takes its RPDOs at each SYNC, and misses one that is not sent.
    """

    def __init__(
        self,
        name: str,
        node_id: int,
        dictionary: canopen.ObjectDictionary,
        tpdos: tuple[PdoLayout, ...],
        rpdos: tuple[PdoLayout, ...],
        carrier: Carrier,
    ) -> None:
        self.name = name
        self.node_id = node_id
        self.dictionary = dictionary
        self.sdo = Sdo(name, node_id, dictionary, carrier)
        self.values: dict[Entry, Number] = {at: 0 for pdo in (*tpdos, *rpdos) for at in pdo.entries}
        self.streams = tuple(PdoStream(tpdo, self) for tpdo in tpdos)
        self.last_beat = 0
        self.cyclic = False
        self._rpdos = rpdos
        self._wanted: dict[Entry, Number] = {at: 0 for rpdo in rpdos for at in rpdo.entries}
        self._sent: dict[int, bytes] = {}

    @property
    def rpdos(self) -> frozenset[int]:
        """Identifiers by which the node is commanded."""
        return frozenset(rpdo.cob_id for rpdo in self._rpdos)

    def put(self, at: Entry, value: Number) -> None:
        """Set an object of an RPDO; it goes out at the end of the cycle."""
        self._wanted[at] = value

    def outputs(self, *, repeat: bool = False) -> list[tuple[int, bytes]]:
        """Return the RPDOs to send: those that changed, or all of them to ``repeat``."""
        due = []
        for rpdo in self._rpdos:
            data = rpdo.code.pack(*[self._wanted[at] for at in rpdo.entries])
            if repeat or self.cyclic or self._sent.get(rpdo.cob_id) != data:
                self._sent[rpdo.cob_id] = data
                due.append((rpdo.cob_id, data))
        return due

    def configure(self, bus: BusConfiguration) -> None:
        """Write what the node needs to know of SYNC, heartbeats and its PDOs (by SDO).

        Raises
        ------
        SdoTimeoutError, SdoAbortError
            If the node does not answer or refuses.
        """
        consumed = bus.master_node << 16 | bus.heartbeat_limit_ms
        for at, value in (
            (_SYNC_COB_ID, 0x80),
            (_SYNC_PERIOD, round(bus.period_s * 1e6)),
            (_SYNC_OVERFLOW, bus.sync_overflow),
            (CONSUMED_BEAT, 0),  # an earlier controller's last heartbeat must not count
            (CONSUMED_BEAT, consumed),
            (_PRODUCED_BEAT, bus.heartbeat_ms),
        ):
            if has(self.dictionary, at):
                self.sdo.write(at, value)
        tpdos = tuple(stream.layout for stream in self.streams)
        self._map(0x1800, 0x1A00, 0x180, tpdos, _EVERY_SYNC)
        taken = _EVERY_SYNC if self.cyclic else _AT_ONCE
        self._map(0x1400, 0x1600, 0x200, self._rpdos, taken)

    def _map(
        self, record: int, mapping: int, cob_id: int, layouts: tuple[PdoLayout, ...], kind: int
    ) -> None:
        for number in range(4):
            if not has(self.dictionary, Entry(record + number, 1)):
                continue
            off = cob_id + 0x100 * number + self.node_id | _NOT_VALID
            self.sdo.write(Entry(record + number, 1), off)
            if number < len(layouts):
                self._map_one(record + number, mapping + number, layouts[number], kind)

    def _map_one(self, record: int, mapping: int, layout: PdoLayout, kind: int) -> None:
        self.sdo.write(Entry(record, 2), kind)
        self.sdo.write(Entry(mapping, 0), 0)
        for sub, (at, bits) in enumerate(zip(layout.entries, layout.bits, strict=True), start=1):
            self.sdo.write(Entry(mapping, sub), at.object_index << 16 | at.subindex << 8 | bits)
        self.sdo.write(Entry(mapping, 0), len(layout.entries))
        self.sdo.write(Entry(record, 1), layout.cob_id)
