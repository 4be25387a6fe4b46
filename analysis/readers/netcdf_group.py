"""NetCDF4 as HDF5 has it: variables that hang on a scale for each of their dimensions.

h5py alone writes it. h5netcdf looks every name up anew at every step, which takes ten times as long
as writing the samples of a run.
"""

from collections.abc import Iterator, Mapping
from itertools import count
from typing import Any

import numpy as np

_ALONE = b"This is a netCDF dimension but not a netCDF variable."


class NetcdfGroup:
    """A group that is being written: the file itself, or a group in it.

    Attributes
    ----------
    store
        The group as h5py has it.
    """

    def __init__(self, store: Any, numbers: Iterator[int] | None = None) -> None:
        """Take a new file or group of h5py that tracks the order of what is put in."""
        self.store = store
        self._numbers = count() if numbers is None else numbers
        self._scales: dict[str, Any] = {}

    def group(self, name: str) -> "NetcdfGroup":
        """Make a group in this one."""
        return NetcdfGroup(self.store.create_group(name, track_order=True), self._numbers)

    def dimension(self, name: str, size: int) -> None:
        """Make a dimension that has no variable of its name."""
        scale = self._create(name, (size,), ">f4", None)
        self._scales[name] = _with_scale(scale, _ALONE + f"{size:10}".encode(), self._numbers)

    def coordinate(self, name: str, size: int, chunk: int) -> Any:
        """Make a dimension, and the variable of doubles that has its name; return the variable."""
        scale = self._create(name, (size,), np.float64, (chunk,))
        self._scales[name] = _with_scale(scale, name, self._numbers)
        self._number(scale, (name,))
        return scale

    def variable(
        self, name: str, dimensions: tuple[str, ...], dtype: type, chunk: int | None = None
    ) -> Any:
        """Make a variable along dimensions of the group; return it as h5py has it."""
        shape = tuple(self._scales[dimension].shape[0] for dimension in dimensions)
        made = self._create(name, shape, dtype, chunk and (chunk,))
        for axis, dimension in enumerate(dimensions):
            made.dims[axis].attach_scale(self._scales[dimension])
        self._number(made, dimensions)
        return made

    def _create(self, name: str, shape: tuple[int, ...], dtype: Any, chunks: Any) -> Any:
        # What has no size yet may grow: NetCDF has no dimensions of none.
        most = None if all(shape) else tuple(size or None for size in shape)
        return self.store.create_dataset(
            name, shape, dtype, chunks=chunks, maxshape=most, track_order=True
        )

    def _number(self, variable: Any, dimensions: tuple[str, ...]) -> None:
        numbers = [self._scales[dimension].attrs["_Netcdf4Dimid"] for dimension in dimensions]
        variable.attrs["_Netcdf4Coordinates"] = np.array(numbers, np.int32)
        variable.attrs["_Netcdf4Dimid"] = numbers[0]


def _with_scale(scale: Any, name: str | bytes, numbers: Iterator[int]) -> Any:
    scale.make_scale(name)
    scale.attrs["_Netcdf4Dimid"] = np.int32(next(numbers))
    return scale


def describe(target: Any, attributes: Mapping[str, str | float]) -> None:
    """Write attributes of a group or variable; a number is a row of one, as NetCDF has it."""
    for name, value in attributes.items():
        target.attrs[name] = value if isinstance(value, str) else np.atleast_1d(value)
