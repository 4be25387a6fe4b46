"""What only another master says on a bus: two of them would command the same axes (CiA 301)."""

from collections import Counter
from collections.abc import Collection
from typing import Final

import can

from hardware.bus import BusConfiguration
from hardware.errors import OtherMasterError

_NMT, _SYNC, _LSS = 0x000, 0x080, 0x7E5
_SDO_REQUEST, _HEARTBEAT, _KIND, _NODE = 0x600, 0x700, 0x780, 0x07F
_ECHOING: Final = ("udp_multicast",)  # interfaces of python-can that hand back what is sent
_DOWNLOAD: Final = (0, 1)  # client command specifiers: a segment or the beginning of a write
_COMMANDS: Final = {
    1: "start",
    2: "stop",
    128: "pre-operational",
    129: "reset",
    130: "reset communication",
}


class OtherMasterWatch:
    """Notices another master on a bus, from :meth:`begin` on."""

    def __init__(self, configuration: BusConfiguration) -> None:
        self._configuration = configuration
        self._rpdos: frozenset[int] = frozenset()
        self._attentive = False
        self._said: dict[str, None] = {}
        self._echoes = configuration.interface in _ECHOING or bool(
            configuration.options.get("receive_own_messages")
        )
        self._awaited: Counter[tuple[int, bytes]] = Counter()

    @property
    def is_other_heard(self) -> bool:
        """Whether another master was heard, since :meth:`forget` at the latest."""
        return bool(self._said)

    def begin(self, rpdos: Collection[int]) -> None:
        """Begin to look; ``rpdos`` are the identifiers by which this controller commands."""
        self._rpdos, self._attentive = frozenset(rpdos), True

    def forget(self) -> None:
        """Forget what was heard: the operator has seen to it."""
        self._said.clear()

    def sent(self, frame: can.Message) -> None:
        """Take a frame of this controller, which some buses hand back once."""
        if self._echoes:
            self._awaited[frame.arbitration_id, bytes(frame.data)] += 1

    def look(self, frame: can.Message, *, operating: bool) -> str:
        """Return in words what a received frame says of another master; empty if nothing.

        Parameters
        ----------
        operating
            Whether this controller runs the bus: then who only asks, a service tool for example,
            may.
        """
        if not self._attentive or frame.is_extended_id or frame.is_error_frame:
            return ""
        said = command_in(frame, self._configuration.master_node, self._rpdos)
        if not operating:
            said = said or question_in(frame)
        if not said or self._is_own(frame):
            return ""
        self._said[said] = None
        return said

    def _is_own(self, frame: can.Message) -> bool:
        """Whether it is this controller's own frame, come back."""
        message = frame.arbitration_id, bytes(frame.data)
        if not self._awaited[message]:
            return False
        self._awaited[message] -= 1
        return True

    def refuse(self) -> None:
        """Refuse to start where another master was heard.

        Raises
        ------
        OtherMasterError
            It names what was heard.
        """
        if self._said:
            bus = self._configuration
            raise OtherMasterError(
                f"bus {bus.interface}:{bus.channel}",
                f"another controller is on it: heard {', '.join(self._said)}; two would command "
                "the same axes. End it, or take it off the bus, and start again",
            )


def command_in(frame: can.Message, master_node: int, rpdos: Collection[int]) -> str:
    """Return in words what a frame commands; empty if it is none that a master alone sends.

    Parameters
    ----------
    master_node
        This controller's own node id: another's heartbeat under it would keep drives turning.
    rpdos
        Identifiers by which this controller commands its nodes.
    """
    at, data = frame.arbitration_id, frame.data
    if frame.is_remote_frame:
        return ""
    if at == _NMT and len(data) > 1:
        whom = f"node {data[1]}" if data[1] else "all nodes"
        return f"NMT {_COMMANDS.get(data[0], f'command {data[0]}')} to {whom}"
    if at == _HEARTBEAT + master_node:
        return f"a heartbeat of node {master_node}, which is this controller's own id"
    if at & _KIND == _SDO_REQUEST and len(data) and data[0] >> 5 in _DOWNLOAD:
        return f"an SDO write to node {at & _NODE}"
    return {_SYNC: "SYNC", _LSS: "an LSS command"}.get(at) or (
        f"process data 0x{at:03X}, which this controller sends" if at in rpdos else ""
    )


def question_in(frame: can.Message) -> str:
    """Return in words what a frame asks; empty if it is none that a master alone asks."""
    at = frame.arbitration_id
    if frame.is_remote_frame:
        return f"node guarding of node {at & _NODE}" if at & _KIND == _HEARTBEAT else ""
    return f"an SDO request to node {at & _NODE}" if at & _KIND == _SDO_REQUEST else ""
