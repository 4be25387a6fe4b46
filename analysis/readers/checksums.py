"""Checksums of a recording's file: what each block of a variable and each attribute was.

They lie in a group of their own, which other programs need not know: the CRC-32 of every block of
every variable's values as little-endian doubles, and of every attribute's text. A file that says
that it has them and does not was changed; one that does not say so is another program's.
"""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final
from zlib import crc32

import numpy as np
from numpy.typing import NDArray

from analysis.readers.netcdf_group import NetcdfGroup, describe
from hardware.description import dataset as schema
from hardware.description.arrays import BoolArray, FloatArray

KIND: Final = "crc32"
BLOCK_SAMPLES: Final = 1024  # what a flipped bit costs: 10 s at 100 Hz
BLOCK_EDGES: Final = 16
RUN: Final = ""  # stands for the run itself among the variables
_BYTES: Final = 8  # of a value
_VARIABLE, _BLOCK, _EDGE_BLOCK = "variable", "block", "edge_block"
_SUMS, _EDGE_SUMS = "block_crc32", "edge_block_crc32"
_NAMES, _COUNTS, _ATTRIBUTES = "variables", "counts", "attributes"
# What NetCDF keeps its dimensions in.
_DIMENSIONS: Final = ("CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST", "_Netcdf4Dimid")
_HIDDEN: Final = (*_DIMENSIONS, "_Netcdf4Coordinates", "_nc3_strict", "_NCProperties")

SumArray = NDArray[np.uint32]
AttributeSums = Mapping[str, Mapping[str, int]]


@dataclass(frozen=True, eq=False)
class Sums:
    """What a file was when it was written.

    Attributes
    ----------
    blocks
        Variable to the checksum of each of its blocks.
    counts
        Variable to how many values it had.
    attributes
        Variable, or :data:`RUN`, to the checksum of each of its attributes.
    """

    blocks: Mapping[str, SumArray]
    counts: Mapping[str, int]
    attributes: AttributeSums

    def is_same(self, name: str, values: FloatArray, first: int) -> BoolArray:
        """Tell of each block of values whether it is what was written.

        Parameters
        ----------
        first
            Number of the first value, with which a block begins.
        """
        actual = block_sums(values, block_of(name))
        at = first // block_of(name)
        agreement: BoolArray = actual == self.blocks[name][at : at + actual.size]
        return agreement


def block_of(name: str) -> int:
    """Return how many values of a variable have one checksum."""
    return BLOCK_EDGES if name == schema.EDGE_TIME else BLOCK_SAMPLES


def block_sums(values: FloatArray, block: int) -> SumArray:
    """Return the checksum of each block of values; the last may be shorter."""
    data = np.ascontiguousarray(values, dtype="<f8").view(np.uint8).data
    step = _BYTES * block
    return np.array([crc32(data[at : at + step]) for at in range(0, len(data), step)], np.uint32)


def attribute_sum(value: Any) -> int:
    """Return the checksum of an attribute: a text or numbers."""
    plain = value if isinstance(value, str) else np.ravel(value).tolist()
    return crc32(repr(plain).encode())


def attribute_sums(attributes: Mapping[str, Any]) -> dict[str, int]:
    """Return the checksum of each attribute but for those that keep a file's dimensions."""
    return {key: attribute_sum(attributes[key]) for key in attributes if key not in _HIDDEN}


class Summing:
    """Takes checksums of what is written into a file, as it is written."""

    def __init__(self) -> None:
        self._blocks: dict[str, list[SumArray]] = {}
        self._counts: dict[str, int] = {}
        self._attributes: dict[str, dict[str, int]] = {}

    def take(self, variable: Any, values: FloatArray) -> None:
        """Take a stretch of a variable, whole blocks of it but for the last."""
        name = variable.name.rpartition("/")[2]
        self._blocks.setdefault(name, []).append(block_sums(values, block_of(name)))
        self._counts[name] = self._counts.get(name, 0) + len(values)
        self._attributes[name] = attribute_sums(variable.attrs)

    def finish(self, file: NetcdfGroup) -> None:
        """Write the checksums into the file."""
        blocks = {name: np.concatenate(sums) for name, sums in self._blocks.items()}
        edges = blocks.pop(schema.EDGE_TIME, None)
        attributes = {RUN: attribute_sums(file.store.attrs), **self._attributes}
        group = file.group(schema.CHECKSUMS)
        group.dimension(_VARIABLE, len(blocks))
        group.dimension(_BLOCK, blocks[schema.TIME].size)
        texts = {_NAMES: list(blocks), _COUNTS: self._counts, _ATTRIBUTES: attributes}
        describe(group.store, {name: json.dumps(value) for name, value in texts.items()})
        group.variable(_SUMS, (_VARIABLE, _BLOCK), np.uint32)[:] = np.array(list(blocks.values()))
        if edges is not None:
            group.dimension(_EDGE_BLOCK, edges.size)
            group.variable(_EDGE_SUMS, (_EDGE_BLOCK,), np.uint32)[:] = edges


def read_sums(file: Any) -> Sums | None:
    """Read the checksums of a file that is open as :class:`h5py.File`.

    It is ``None`` if they are not there whole.
    """
    try:
        return _read(file[schema.CHECKSUMS])
    except (OSError, KeyError, RuntimeError, TypeError, ValueError, AttributeError):
        return None


def has_sums(file: Any) -> bool:
    """Tell whether a file has checksums, or says so."""
    return schema.ATTR_CHECKSUMS in file.attrs or schema.CHECKSUMS in file


def _read(group: Any) -> Sums:
    names, counts = json.loads(group.attrs[_NAMES]), json.loads(group.attrs[_COUNTS])
    blocks = dict(zip(names, np.asarray(group[_SUMS][...], np.uint32), strict=True))
    if _EDGE_SUMS in group:
        blocks[schema.EDGE_TIME] = np.asarray(group[_EDGE_SUMS][...], np.uint32)
    for name, block_sums in blocks.items():
        if block_sums.size != -(-counts[name] // block_of(name)):
            raise ValueError(f"{name}: {block_sums.size} checksums of {counts[name]} values")
    attributes = json.loads(group.attrs[_ATTRIBUTES])
    return Sums(
        blocks,
        counts,
        {name: dict(attribute_sums.items()) for name, attribute_sums in attributes.items()},
    )


def changed_attributes(sums: Sums, actual: AttributeSums) -> Iterator[tuple[str, str]]:
    """Yield variable and name of each attribute that is not what it was, is new or is gone."""
    for name, written in sums.attributes.items():
        now = actual.get(name, {})
        for key in sorted(written.keys() | now.keys()):
            if written.get(key) != now.get(key):
                yield name, key
