"""The heaps of an HDF5 file, in which texts and dimensions lie: each has to have an end.

HDF5 walks through the objects of a heap as soon as it reads one of them, by the sizes that they
state. At one that states to take no room it walks on the spot for ever, and no signal reaches it.
So the heaps are walked through before, by the sizes of lengths that HDF5 writes unless told
otherwise.
"""

import struct
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO, Final

from hardware.description.errors import DataError

_MARK: Final = b"GCOL\x01\x00\x00\x00"  # of a heap, version 1
_HEAD: Final = struct.Struct("<8sQ")  # the mark and the heap's size
_OBJECT: Final = struct.Struct("<H6xQ")  # its number, 0 where the heap is free, and its size
_BLOCK: Final = 1 << 20  # bytes looked at in one go
_LARGEST: Final = 1 << 26  # bytes of a heap: usually 4096, or one long text


def check_heaps(path: Path) -> None:
    """Refuse a file with a heap that HDF5 would not come to the end of.

    Raises
    ------
    DataError
        With the place of the heap.
    """
    with path.open("rb") as file:
        for place in _marks(file):
            file.seek(place)
            size = _HEAD.unpack(file.read(_HEAD.size).ljust(_HEAD.size))[1]
            if _is_endless(file.read(max(0, min(size, _LARGEST) - _HEAD.size))):
                raise DataError(
                    f"{path}: the NetCDF file is damaged: its heap at byte {place} has no end"
                )


def _marks(file: BinaryIO) -> Iterator[int]:
    """Yield where heaps begin, also those that lie across two blocks."""
    place, kept = 0, b""
    while block := file.read(_BLOCK):
        data, at = kept + block, place - len(kept)
        found = data.find(_MARK)
        while found >= 0:
            yield at + found
            found = data.find(_MARK, found + 1)
        place += len(block)
        kept = data[1 - len(_MARK) :]
        file.seek(place)


def _is_endless(heap: bytes) -> bool:
    """Tell whether an object takes no room; one that takes too much is refused by HDF5."""
    at = 0
    while at + _OBJECT.size <= len(heap):
        number, size = _OBJECT.unpack_from(heap, at)
        room = size if number == 0 else _OBJECT.size + (size + 7) // 8 * 8
        if room % (1 << 64) == 0:  # as HDF5 counts
            return True
        at += room
    return False
