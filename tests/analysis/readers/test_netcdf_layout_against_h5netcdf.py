"""Oracle: what h5netcdf itself writes for the same variables, scale by scale."""

from pathlib import Path
from typing import Any

import h5netcdf
import h5py
import numpy as np
import pytest

from analysis.readers.netcdf_group import NetcdfGroup, describe


def _by_hand(path: Path, edges: int) -> None:
    with h5py.File(path, "w", track_order=True) as file:
        group = NetcdfGroup(file)
        describe(group.coordinate("time", 30, 10), {"units": "s"})
        describe(group.variable("force", ("time",), np.float64, 10), {"units": "N", "most": 3.0})
        group.dimension("edge", edges)
        group.variable("edges", ("edge",), np.float64)
        inner = group.group("sums")
        inner.dimension("row", 2)
        inner.dimension("block", 3)
        inner.variable("sum", ("row", "block"), np.uint32)


def _by_h5netcdf(path: Path, edges: int) -> None:
    with h5netcdf.File(path, "w") as file:
        file.dimensions["time"] = 30
        for name, attributes in (("time", {"units": "s"}), ("force", {"units": "N", "most": 3.0})):
            made = file.create_variable(name, ("time",), np.float64, chunks=(10,))
            made.attrs.update(attributes)
        file.dimensions["edge"] = edges
        file.create_variable("edges", ("edge",), np.float64)
        inner = file.create_group("sums")
        inner.dimensions = {"row": 2, "block": 3}
        inner.create_variable("sum", ("row", "block"), np.uint32)


def _told(path: Path) -> dict[str, Any]:
    """What the file has: of references how many, since they point into the file."""
    told: dict[str, Any] = {}

    def tell(name: str, item: Any) -> None:
        own = {
            key: len(value) if key.endswith("_LIST") else np.asarray(value).tolist()
            for key, value in item.attrs.items()
            if key != "_Netcdf4Dimid" or "DIMENSION_LIST" not in item.attrs
        }
        told[name] = own
        if isinstance(item, h5py.Dataset):
            scales = [[scale.name for scale in axis.values()] for axis in item.dims]
            told[name] = (own, item.shape, item.maxshape, item.dtype.str, item.chunks, scales)

    with h5py.File(path) as file:
        file.visititems(tell)
    return told


@pytest.mark.parametrize("edges", [0, 5])
def test_the_same_scales_shapes_and_attributes(tmp_path: Path, edges: int) -> None:
    _by_hand(tmp_path / "own.nc", edges)
    _by_h5netcdf(tmp_path / "other.nc", edges)
    assert _told(tmp_path / "own.nc") == _told(tmp_path / "other.nc")


def test_variables_keep_their_order_and_every_dimension_has_its_name(tmp_path: Path) -> None:
    _by_hand(tmp_path / "own.nc", 5)
    with h5netcdf.File(tmp_path / "own.nc") as file:  # refuses variables without dimensions
        assert list(file.variables) == ["time", "force", "edges"]
        assert file["edges"].dimensions == ("edge",)
        assert file["sums"]["sum"].dimensions == ("row", "block")
