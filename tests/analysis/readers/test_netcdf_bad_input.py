"""Bad NetCDF files and datasets get a clear word, and no recording is ever destroyed."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr

from analysis.readers import ColumnMap, from_dataset, read_recording, to_dataset, write_recording
from analysis.recording import Recording
from hardware.description.channels import Channel
from hardware.description.errors import ConfigurationError, DataError


def example(*names: str, count: int = 500) -> Recording:
    channels = tuple(Channel(name, "N") for name in names or ("a", "b"))
    samples = np.random.default_rng(5).standard_normal((len(channels), count))
    return Recording("run", channels, samples, sample_rate_hz=100.0)


def test_truncated(tmp_path: Path) -> None:
    path = write_recording(example(), tmp_path / "run.nc")
    path.write_bytes(path.read_bytes()[:-500])
    with pytest.raises(DataError, match=r"run\.nc: the NetCDF file is cut short"):
        read_recording(path)


def test_not_netcdf(tmp_path: Path) -> None:
    path = tmp_path / "run.nc"
    path.write_text("Time [s],F [N]\n0,1\n")
    with pytest.raises(DataError, match=r"run\.nc: not a NetCDF file"):
        read_recording(path)


def test_older_netcdf(tmp_path: Path) -> None:
    path = tmp_path / "run.nc"
    to_dataset(example()).to_netcdf(path, engine="scipy")
    with pytest.raises(DataError, match="NetCDF 3 file; convert it with 'nccopy -k nc4'"):
        read_recording(path)


def test_hdf5_of_something_else(tmp_path: Path) -> None:
    path = tmp_path / "run.nc"
    with h5py.File(path, "w") as file:
        file["stuff"] = np.arange(3)
    with pytest.raises(DataError, match="coordinate 'time'"):
        read_recording(path)


def test_column_map_for_netcdf(tmp_path: Path) -> None:
    path = write_recording(example(), tmp_path / "run.nc")
    with pytest.raises(ConfigurationError, match="leave out the column map and the sample rate"):
        read_recording(path, ColumnMap())
    with pytest.raises(ConfigurationError, match="leave out"):
        read_recording(path, sample_rate_hz=5.0)


def without(key: str) -> Callable[[xr.Dataset], xr.Dataset]:
    return lambda dataset: dataset.drop_attrs(deep=False).assign_attrs(
        {name: value for name, value in dataset.attrs.items() if name != key}
    )


def shifted(dataset: xr.Dataset) -> xr.Dataset:
    time = dataset["time"].values.copy()
    time[300:] += 0.004
    return dataset.assign_coords(time=time)


def with_units(unit: str) -> Callable[[xr.Dataset], xr.Dataset]:
    return lambda dataset: dataset.assign(a=dataset["a"].assign_attrs(units=unit))


BAD = [
    (without("schema"), "the attribute 'schema' is None, not 'pmm-run-1'"),
    (without("sample_rate_hz"), "'sample_rate_hz' is nan, not a positive rate"),
    (lambda d: d.assign_attrs(schema="pmm-run-9"), "'schema' is 'pmm-run-9'"),
    (lambda d: d.assign_attrs(sample_rate_hz=-1.0), "'sample_rate_hz' is -1"),
    (lambda d: d.assign_attrs(flags="[{"), "a damaged attribute"),
    (lambda d: d.assign_attrs(set_point='{"speed": 1}'), "a damaged attribute.*speed"),
    (lambda d: d.assign_attrs(set_point='{"medium": "oil"}'), "a damaged attribute.*oil"),
    (shifted, "the time of sample 300 is 3.004 s, where 100 Hz gives 3 s"),
    (with_units("kN"), "channel 'a' is in 'kN'; a recording is kept in SI units, 'N'"),
    (lambda d: d.assign(c=("other", [1.0, 2.0])), "variable 'c' is over .*other.*not over time"),
    (lambda d: d.drop_vars(["a", "b"]), "no channel over 'time'"),
    (lambda d: d.isel(time=slice(0, 0)), "no samples"),
    (lambda d: d.drop_vars("time"), "coordinate 'time'"),
]


@pytest.mark.parametrize(("spoil", "message"), BAD)
def test_datasets_beside_the_schema(
    tmp_path: Path, spoil: Callable[[xr.Dataset], xr.Dataset], message: str
) -> None:
    dataset = spoil(to_dataset(example()))
    with pytest.raises(DataError, match=message):
        from_dataset(dataset)
    dataset.to_netcdf(tmp_path / "run.nc", engine="h5netcdf")
    with pytest.raises(DataError, match=message):
        read_recording(tmp_path / "run.nc")


@pytest.mark.parametrize("name", ["run 3", None])
def test_what_is_wrong_is_said_of_the_run_by_its_name(name: str | None) -> None:
    dataset = to_dataset(replace(example(), name="its own")).drop_vars(["a", "b"])
    with pytest.raises(DataError, match=f"^{name or 'its own'}: "):
        from_dataset(dataset, name)


def test_packed_values(tmp_path: Path) -> None:
    packing = {"a": {"dtype": "int16", "scale_factor": 0.001, "_FillValue": -32768}}
    to_dataset(example()).to_netcdf(tmp_path / "run.nc", engine="h5netcdf", encoding=packing)
    with pytest.raises(DataError, match="'a' is packed"):
        read_recording(tmp_path / "run.nc")


@pytest.mark.parametrize("name", ["", "time", "photocell_edge_time", "a/b", " a", "a ", "#1"])
def test_channel_names_that_cannot_be_kept(tmp_path: Path, name: str) -> None:
    with pytest.raises(DataError, match="cannot be kept"):
        write_recording(example(name), tmp_path / "run.nc")
    assert list(tmp_path.iterdir()) == []


def test_a_name_twice(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"'a' cannot be kept.*twice"):
        to_dataset(example("a", "a"))


def test_units_that_are_not_si(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="'mm'; a recording is kept in SI units, 'm'"):
        write_recording(replace(example("a"), channels=(Channel("a", "mm"),)), tmp_path / "r.nc")


def test_nothing_to_keep(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="no samples"):
        write_recording(example(count=0), tmp_path / "run.nc")


def test_another_ending(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"end the name with \.nc"):
        write_recording(example(), tmp_path / "run.csv")


def test_no_such_folder(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="the recording is not written"):
        write_recording(example(), tmp_path / "none" / "run.nc")


def test_an_existing_recording_is_not_overwritten_unasked(tmp_path: Path) -> None:
    path = write_recording(example("a"), tmp_path / "run.nc")
    before = path.read_bytes()
    with pytest.raises(DataError, match="exists already"):
        write_recording(example("b"), path)
    assert path.read_bytes() == before
    write_recording(example("b"), path, overwrite=True)
    assert read_recording(path).channel_names == ("b",)
    assert list(tmp_path.iterdir()) == [path]


class Broken:
    """Samples that fail halfway, as a disk or a source file may."""

    shape = (2, 500)

    def __getitem__(self, key: object, /) -> np.ndarray:
        raise DataError("the source is gone")


def test_a_failed_write_leaves_the_old_recording_and_nothing_else(tmp_path: Path) -> None:
    path = write_recording(example(), tmp_path / "run.nc")
    before = path.read_bytes()
    with pytest.raises(DataError, match="the source is gone"):
        write_recording(replace(example(), samples=Broken()), path, overwrite=True)
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_a_file_that_changed_since_it_was_opened(tmp_path: Path) -> None:
    path = write_recording(example(), tmp_path / "run.nc")
    recording = read_recording(path)
    write_recording(example("c"), path, overwrite=True)
    with pytest.raises(DataError, match="changed since it was opened"):
        recording.samples[:, 0:10]
    path.unlink()
    with pytest.raises(DataError, match="cannot be read: No such file"):
        recording.samples[:, 0:10]
