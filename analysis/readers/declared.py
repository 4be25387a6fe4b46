"""What an HDF5 file says that it holds, against what it can: a shape costs a file no bytes."""

import math
from pathlib import Path
from typing import Any, Final

from analysis.limits import ReadingLimits, limits
from hardware.description.dataset import EDGE_TIME

_PACKING: Final = 1032  # bytes of zeros that deflate keeps in one: more is not in the file
_LARGEST_CHUNK: Final = 1 << 26  # bytes, read whole for any of its samples; ours have 2^19


def check_declared(path: Path) -> None:
    """Refuse a file whose variables are larger than what lies in it, before any is read.

    Raises
    ------
    DataError
        With the variable, what it says and what is there.
    """
    import h5py

    allowed = limits()
    with h5py.File(path, "r") as file:
        for name, one in file.items():
            if isinstance(one, h5py.Dataset):
                _check(one, f"{path}: the variable {name!r}", allowed)


def _check(one: Any, where: str, allowed: ReadingLimits) -> None:
    stored, chunk = one.id.get_storage_size(), math.prod(one.chunks or ()) * one.dtype.itemsize
    if one.chunks and chunk > _LARGEST_CHUNK:
        raise allowed.too_large(where, f"its chunks of {chunk} bytes, where 2^26 are the most")
    if one.nbytes > max(allowed.memory_bytes / 4.0, _PACKING * stored):
        raise allowed.too_large(where, f"it says {one.nbytes} bytes, of which {stored} are there")
    if one.ndim and one.name == f"/{EDGE_TIME}":
        allowed.check_rows(one.shape[0], 1, where)
