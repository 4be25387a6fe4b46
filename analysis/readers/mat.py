"""Recordings from MATLAB: MAT files of version 5 (and 4, 6, 7), and 7.3, which is HDF5.

Every vector of numbers is a column, under its variable's name; a matrix with more rows than columns
is a column for each (``data#1``, ``data#2`` ...), a struct's fields are ``run.force`` and so on.
Scalars called ``fs``, ``sample_rate_hz`` or ``sample_rate`` state the rate, ``dt`` its inverse;
they have to agree.
"""

from collections.abc import Iterator, Mapping
from itertools import pairwise
from math import isclose
from pathlib import Path
from typing import Any, Final

import numpy as np

from analysis.foreign.columns import ForeignColumns
from analysis.readers.foreign import foreign_reader
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError

_RATES: Final = ("fs", "sample_rate_hz", "sample_rate", "samplerate")
_STEPS: Final = ("dt", "ts")
_SAME_RATE: Final = 1e-6  # relative: the last digit of a rounded inverse
_DEEPEST: Final = 4  # structs within structs
_HDF5: Final = b"\x89HDF\r\n\x1a\n"
_USER_BLOCK: Final = 512  # what MATLAB writes before the HDF5 of version 7.3


def read_mat(path: Path) -> ForeignColumns:
    """Return the columns of a MAT file.

    Raises
    ------
    DataError
        If it is none that can be read.
    """
    content = _version_73(path) if _is_hdf5(path) else _version_5(path)
    arrays = dict(_flat("", content, 0))
    return ForeignColumns(dict(_columns(arrays)), {}, *_rate(arrays))


READER: Final = foreign_reader("mat", read_mat)


def _is_hdf5(path: Path) -> bool:
    with path.open("rb") as file:
        head = file.read(_USER_BLOCK + len(_HDF5))
    return head.startswith(_HDF5) or head[_USER_BLOCK:] == _HDF5


def _version_5(path: Path) -> dict[str, Any]:
    from scipy.io import loadmat
    from scipy.io.matlab import MatReadError

    try:
        content: dict[str, Any] = loadmat(path, simplify_cells=True, mat_dtype=False)
    except (MatReadError, OSError, ValueError, TypeError, NotImplementedError) as error:
        raise DataError(f"not a MAT file that can be read: {error}") from None
    return {key: value for key, value in content.items() if not key.startswith("__")}


def _version_73(path: Path) -> dict[str, Any]:
    import h5py

    try:
        with h5py.File(path, "r") as file:
            return _group(file)
    except (OSError, RuntimeError, KeyError) as error:
        raise DataError(f"the MAT file (7.3) is damaged: {error}") from None


def _group(group: Any) -> dict[str, Any]:
    """Return a group's numbers; MATLAB keeps its arrays with the axes turned round."""
    import h5py

    content: dict[str, Any] = {}
    for key, item in group.items():
        if key.startswith("#"):
            continue  # where MATLAB keeps what others refer to
        if isinstance(item, h5py.Group):
            content[key] = _group(item)
        elif item.dtype.kind in "fiu" and _text(item.attrs.get("MATLAB_class")) != "char":
            content[key] = np.asarray(item[()]).T
    return content


def _text(value: Any) -> str:
    return value.decode() if isinstance(value, bytes) else str(value)


def _flat(prefix: str, content: Mapping[str, Any], depth: int) -> Iterator[tuple[str, Any]]:
    """Yield all arrays with the path to them."""
    for key, item in content.items():
        if isinstance(item, Mapping):
            if depth < _DEEPEST:
                yield from _flat(f"{prefix}{key}.", item, depth + 1)
        elif isinstance(item, np.ndarray | int | float) and not isinstance(item, bool):
            array = np.asarray(item)
            if array.dtype.kind in "fiu":
                yield f"{prefix}{key}", array.astype(np.float64, copy=False)


def _columns(arrays: Mapping[str, FloatArray]) -> Iterator[tuple[str, FloatArray]]:
    for name, array in arrays.items():
        squeezed = np.squeeze(array)
        if squeezed.ndim == 1 and squeezed.size > 1:
            yield name, np.ascontiguousarray(squeezed)
        elif squeezed.ndim == 2:
            upright = squeezed if squeezed.shape[0] >= squeezed.shape[1] else squeezed.T
            for k, column in enumerate(upright.T, 1):
                yield f"{name}#{k}", np.ascontiguousarray(column)


def _rate(arrays: Mapping[str, FloatArray]) -> tuple[float | None, str]:
    """Return the rate that scalars state, if any does, or how they contradict each other."""
    rates_hz = {}
    for name, array in arrays.items():
        last = name.rpartition(".")[2].casefold()
        if array.size != 1 or not float(array.flat[0]) > 0.0:
            continue
        if last in _RATES:
            rates_hz[name] = float(array.flat[0])
        if last in _STEPS:
            rates_hz[name] = 1.0 / float(array.flat[0])
    for (first, first_hz), (name, rate_hz) in pairwise(rates_hz.items()):
        if not isclose(first_hz, rate_hz, rel_tol=_SAME_RATE):
            return None, f"{first!r} states {first_hz:g} Hz and {name!r} {rate_hz:g} Hz"
    return next(iter(rates_hz.values()), None), ""
