"""Object dictionaries from EDS files, and PDO mappings checked against them."""

import re
import struct
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files
from pathlib import Path
from typing import Final, NamedTuple

import canopen
from canopen.objectdictionary import ODArray, ODVariable, datatypes, import_od

from hardware.description.errors import ConfigurationError

_CODES: Final = {
    datatypes.BOOLEAN: "B",
    datatypes.INTEGER8: "b",
    datatypes.INTEGER16: "h",
    datatypes.INTEGER32: "i",
    datatypes.INTEGER64: "q",
    datatypes.UNSIGNED8: "B",
    datatypes.UNSIGNED16: "H",
    datatypes.UNSIGNED32: "I",
    datatypes.UNSIGNED64: "Q",
    datatypes.REAL32: "f",
    datatypes.REAL64: "d",
}
_ENTRY: Final = re.compile(r"^(?:0x)?([0-9A-Fa-f]{4})(?::([0-9]{1,3}))?$")


class Entry(NamedTuple):
    """An object's address in the dictionary; written ``6041`` or ``9130:1`` in configurations."""

    object_index: int
    subindex: int = 0

    def __str__(self) -> str:
        return f"{self.object_index:04X}:{self.subindex}"


def entry(text: str) -> Entry:
    """Turn ``"6041"`` or ``"9130:1"`` (index in hexadecimal, sub-index in decimal) into an entry.

    Raises
    ------
    ConfigurationError
        If the text is neither.
    """
    match = _ENTRY.match(text.strip())
    if not match:
        raise ConfigurationError(f"{text!r} is no object: write it as '6041' or '9130:1'")
    return Entry(int(match[1], 16), int(match[2] or 0))


def load(eds: str, node_id: int, where: str) -> canopen.ObjectDictionary:
    """Read an EDS file: a path, or the name of one that comes with this package.

    Raises
    ------
    ConfigurationError
        If there is no such file, or it is no EDS; the message lists the package's own.
    """
    folder = files("hardware").joinpath("eds")
    path = Path(str(folder / eds)) if (folder / eds).is_file() else Path(eds)
    if not path.is_file():
        names = ", ".join(
            sorted(file.name for file in folder.iterdir() if file.name.endswith(".eds"))
        )
        raise ConfigurationError(
            f"{where}.eds = {eds!r}: no such file; give a path, or one of {names}"
        )
    try:
        dictionary = _parsed(path, node_id, path.stat().st_mtime_ns)
    except Exception as error:  # a parser meets everything in a broken file
        raise ConfigurationError(f"{where}.eds = {eds!r} cannot be read as EDS: {error}") from error
    if 0x1000 not in dictionary:
        raise ConfigurationError(f"{where}.eds = {eds!r} is no EDS: it has no object 1000")
    return dictionary


@lru_cache(maxsize=64)
def _parsed(path: Path, node_id: int, changed_ns: int) -> canopen.ObjectDictionary:  # noqa: ARG001  part of the key
    """Parse a file once for each node; nobody writes into a dictionary, so all may share it."""
    return import_od(str(path), node_id)


def variable(dictionary: canopen.ObjectDictionary, at: Entry) -> ODVariable | None:
    """Return the variable at an address, or ``None`` if the dictionary has none there.

    canopen makes up members of any array; that is right for compact arrays only, whose EDS states
    the first member for all.
    """
    od_variable = dictionary.get_variable(*at)
    holder = dictionary.get(at.object_index)
    if not isinstance(holder, ODArray) or at.subindex in holder.subindices:
        return od_variable
    if od_variable is None or len(holder.subindices) > 2:
        return None
    od_variable.pdo_mappable = holder[1].pdo_mappable
    return od_variable


def has(dictionary: canopen.ObjectDictionary, at: Entry) -> bool:
    """Tell whether the dictionary has a variable at an address."""
    return variable(dictionary, at) is not None


@dataclass(frozen=True)
class PdoLayout:
    """What a PDO carries: numbers one behind the other, little end first."""

    cob_id: int
    entries: tuple[Entry, ...]
    code: struct.Struct

    @property
    def size(self) -> int:
        """Data bytes."""
        return self.code.size

    @property
    def bits(self) -> tuple[int, ...]:
        """Bits of each entry."""
        formats = self.code.format.lstrip("<")
        return tuple(8 * struct.calcsize(f"<{code}") for code in formats)


def layout(
    dictionary: canopen.ObjectDictionary, entries: tuple[Entry, ...], cob_id: int, where: str
) -> PdoLayout:
    """Lay a PDO out after the types in the dictionary.

    Raises
    ------
    ConfigurationError
        If an object is not in the EDS, cannot be mapped or is no number, or if the PDO would be
        longer than 8 bytes.
    """
    code = "<"
    for at in entries:
        code += _code(dictionary, at, where)
    packed = struct.Struct(code)
    if packed.size > 8:
        raise ConfigurationError(
            f"{where}: {', '.join(map(str, entries))} take {packed.size} bytes; "
            "the limit of a PDO is 8"
        )
    return PdoLayout(cob_id, entries, packed)


def _code(dictionary: canopen.ObjectDictionary, at: Entry, where: str) -> str:
    od_variable = variable(dictionary, at)
    if od_variable is None:
        raise ConfigurationError(f"{where}: object {at} is not in the EDS")
    if not od_variable.pdo_mappable:
        raise ConfigurationError(
            f"{where}: object {at} ({od_variable.name}) cannot be mapped to a PDO"
        )
    code = _CODES.get(od_variable.data_type or 0)
    if code is None:
        raise ConfigurationError(
            f"{where}: object {at} ({od_variable.name}) is no number (data type "
            f"{od_variable.data_type})"
        )
    return code


def default_mapping(
    dictionary: canopen.ObjectDictionary, first_index: int
) -> tuple[tuple[Entry, ...], ...]:
    """Return the mappings that an EDS states from ``first_index`` (1A00 or 1600) on."""
    mappings = []
    for index in range(first_index, first_index + 4):
        count = variable(dictionary, Entry(index, 0))
        if count is None:
            break
        number = int(count.value if count.value is not None else count.default or 0)
        mappings.append(tuple(_mapped(dictionary, index, sub) for sub in range(1, number + 1)))
    return tuple(mappings)


def _mapped(dictionary: canopen.ObjectDictionary, index: int, sub: int) -> Entry:
    at = variable(dictionary, Entry(index, sub))
    word = 0 if at is None else int(at.value if at.value is not None else at.default or 0)
    return Entry(word >> 16, word >> 8 & 0xFF)
