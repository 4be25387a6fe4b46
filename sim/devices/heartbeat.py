"""A node's heartbeat consumer (object 1016) as CiA 301 has it."""

from sim.devices.network import Wire


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
