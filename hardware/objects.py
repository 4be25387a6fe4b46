"""The objects that nodes have mapped to their process data, read by SDO: no SYNC is needed."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Final

import canopen
from canopen.objectdictionary import datatypes

from hardware.dictionary import Entry, load, variable
from hardware.errors import HardwareError
from hardware.master import Master
from hardware.scan import FoundNode
from hardware.sdo import Sdo

# The dictionary that names a node's objects and their types, by the profile that it follows.
_EDS: Final = {402: "cia402-drive.eds", 404: "cia404-amplifier.eds"}


@dataclass(frozen=True)
class ObjectValue:
    """An object's present value; a word where it could not be read."""

    node_id: int
    name: str
    value: float | str


class MappedObjects:
    """Reads what the nodes of a scan send as process data.

    Names and types are those of the node's profile; of an object that it does not have, the bytes
    are taken for a whole number with sign.
    """

    def __init__(self, master: Master, nodes: Sequence[FoundNode]) -> None:
        self._asked = [
            (node, Sdo(f"node {node.node_id}", node.node_id, canopen.ObjectDictionary(), master))
            for node in nodes
        ]

    def read(self) -> tuple[ObjectValue, ...]:
        """Return all values now."""
        return tuple(self._read())

    def _read(self) -> Iterator[ObjectValue]:
        for node, sdo in self._asked:
            for at in dict.fromkeys(at for tpdo in node.tpdos for at in tpdo.entries):
                try:
                    raw = sdo.read_raw(at)
                except HardwareError as error:
                    yield ObjectValue(node.node_id, f"{at}", str(error))
                    continue
                yield _decode(node, at, raw)


def _decode(node: FoundNode, at: Entry, raw: bytes) -> ObjectValue:
    dictionary = _dictionary(node.profile)
    od_variable = None if dictionary is None else variable(dictionary, at)
    if od_variable is not None and od_variable.data_type in datatypes.NUMBER_TYPES:
        return ObjectValue(
            node.node_id, f"{at} {od_variable.name}", float(od_variable.decode_raw(raw))
        )
    return ObjectValue(node.node_id, f"{at}", float(int.from_bytes(raw, "little", signed=True)))


@cache
def _dictionary(profile: int) -> canopen.ObjectDictionary | None:
    return load(_EDS[profile], 1, "profile") if profile in _EDS else None
