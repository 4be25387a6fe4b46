"""MAT and TDMS files as scipy, h5py and npTDMS write them come back sample by sample."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from analysis.readers import ChannelColumn, ColumnMap, TimeColumn, read_recording, write_recording
from analysis.recording import Recording
from hardware.description.errors import ConfigurationError, DataError

RATE = 200.0
COUNT = 2000
TIME = np.arange(COUNT) / RATE
FORCE = 12.0 + 30.0 * np.sin(2.0 * np.pi * 0.5 * TIME)
STROKE = 20.0 * np.sin(2.0 * np.pi * 0.5 * TIME + 0.3)  # mm
START = np.datetime64("2025-03-01T10:00:00.000000")
MAP = ColumnMap(
    channels=(
        ChannelColumn("force_aft", "F1", "N", sign=-1),
        ChannelColumn("displacement_aft", "stroke", "mm"),
    ),
    time=TimeColumn("t", "s"),
    origin="map",
)


def check(found: Recording, reader: str) -> None:
    assert found.sample_rate_hz == pytest.approx(RATE, rel=1e-12)
    assert found.sample_count == COUNT
    assert [(one.name, one.unit) for one in found.channels] == [
        ("force_aft", "N"),
        ("displacement_aft", "m"),
    ]
    np.testing.assert_array_equal(found.values("force_aft"), -FORCE)
    np.testing.assert_allclose(found.values("displacement_aft"), 1e-3 * STROKE, rtol=1e-15)
    assert found.provenance["reader"] == reader
    assert len(found.provenance["sha256"]) == 64


def write_73(path: Path, content: dict[str, Any]) -> None:
    """Write a MAT file of version 7.3 as MATLAB does: a user block, then HDF5 with axes turned."""
    import h5py

    with h5py.File(path, "w", userblock_size=512) as file:
        _write_group(file, content)
    head = b"MATLAB 7.3 MAT-file, Platform: GLNXA64, HDF5 schema 1.00 .".ljust(116)
    head += b"\0" * 8 + b"\x00\x02IM"
    with path.open("r+b") as raw:
        raw.write(head)


def _write_group(group: Any, content: dict[str, Any]) -> None:
    for key, value in content.items():
        if isinstance(value, dict):
            inner = group.create_group(key)
            inner.attrs["MATLAB_class"] = np.bytes_("struct")
            _write_group(inner, value)
        elif isinstance(value, str):
            codes = np.array([[ord(c)] for c in value], dtype=np.uint16)
            group.create_dataset(key, data=codes).attrs["MATLAB_class"] = np.bytes_("char")
        else:
            stored = group.create_dataset(key, data=np.atleast_2d(value).T)
            stored.attrs["MATLAB_class"] = np.bytes_("double")


def write_5(path: Path, content: dict[str, Any], **options: Any) -> None:
    from scipy.io import savemat

    savemat(path, content, **options)


COLUMNS = {"t": TIME, "F1": FORCE, "stroke": STROKE, "note": "somebody's words"}


@pytest.mark.parametrize("options", [{}, {"do_compression": True}, {"oned_as": "column"}])
def test_version_5(tmp_path: Path, options: dict[str, Any]) -> None:
    write_5(tmp_path / "run.mat", COLUMNS, **options)
    check(read_recording(tmp_path / "run.mat", MAP), "mat")


def test_version_4(tmp_path: Path) -> None:
    write_5(tmp_path / "run.mat", {k: COLUMNS[k] for k in ("t", "F1", "stroke")}, format="4")
    check(read_recording(tmp_path / "run.mat", MAP), "mat")


def test_version_73(tmp_path: Path) -> None:
    write_73(tmp_path / "run.mat", COLUMNS)
    check(read_recording(tmp_path / "run.mat", MAP), "mat")


@pytest.mark.parametrize("write", [write_5, write_73])
@pytest.mark.parametrize("rate", [{"fs": RATE}, {"dt": 1.0 / RATE}])
def test_structs_matrices_and_a_rate_in_place_of_times(tmp_path: Path, write, rate) -> None:  # type: ignore[no-untyped-def]
    both = np.stack((FORCE, STROKE), axis=1)
    write(tmp_path / "run.mat", {"run": {"data": both, **rate}, "label": "x"})
    columns = ColumnMap(
        channels=(
            ChannelColumn("force_aft", "run.data#1", "N", sign=-1),
            ChannelColumn("displacement_aft", "run.data#2", "mm"),
        )
    )
    check(read_recording(tmp_path / "run.mat", columns), "mat")


def test_units_in_the_variables_names(tmp_path: Path) -> None:
    write_5(tmp_path / "run.mat", {"t": TIME, "force_aft_kN": FORCE})
    found = read_recording(tmp_path / "run.mat")
    np.testing.assert_allclose(found.values("force_aft"), 1e3 * FORCE, rtol=1e-15)


def test_shorter_variables_are_left_out_and_said(tmp_path: Path) -> None:
    write_5(tmp_path / "run.mat", {"t": TIME, "F1": FORCE, "calibration": np.arange(5.0)})
    found = read_recording(tmp_path / "run.mat")
    assert found.channel_names == ("F1",)
    (flag,) = [one for one in found.flags if one.code == "other_length"]
    assert "calibration" in flag.message


def write_tdms(path: Path, groups: dict[str, dict[str, Any]], **properties: Any) -> None:
    from nptdms import ChannelObject, TdmsWriter

    with TdmsWriter(path) as file:
        file.write_segment(
            [
                ChannelObject(group, name, values, properties | own)
                for group, channels in groups.items()
                for name, (values, own) in channels.items()
            ]
        )


def test_tdms_with_times(tmp_path: Path) -> None:
    channels = {"t": (TIME, {}), "F1": (FORCE, {}), "stroke": (STROKE, {})}
    write_tdms(tmp_path / "run.tdms", {"rig": channels})
    check(read_recording(tmp_path / "run.tdms", MAP), "tdms")


def test_tdms_with_units_and_increment(tmp_path: Path) -> None:
    channels = {
        "force_aft": (-FORCE, {"unit_string": "N"}),
        "displacement_aft": (STROKE, {"NI_UnitDescription": "mm"}),
    }
    write_tdms(tmp_path / "run.tdms", {"rig": channels}, wf_increment=1.0 / RATE)
    check(read_recording(tmp_path / "run.tdms"), "tdms")


def test_tdms_groups_of_one_name(tmp_path: Path) -> None:
    groups = {name: {"force": (FORCE, {"unit_string": "N"})} for name in ("aft", "fore")}
    write_tdms(tmp_path / "run.tdms", groups, wf_increment=1.0 / RATE)
    assert read_recording(tmp_path / "run.tdms").channel_names == ("aft/force", "fore/force")


@pytest.mark.parametrize(
    ("name", "content", "error", "message"),
    [
        ("run.mat", b"MATLAB 5.0 MAT-file, cut".ljust(140, b"\0"), DataError, "not a MAT file"),
        ("run.mat", b"\x89HDF\r\n\x1a\n" + bytes(90), DataError, r"MAT file \(7.3\) is damaged"),
        ("run.tdms", b"TDSm" + bytes(50), DataError, r"run\.tdms: "),
    ],
)
def test_damaged_files(tmp_path: Path, name: str, content: bytes, error, message: str) -> None:  # type: ignore[no-untyped-def]
    (tmp_path / name).write_bytes(content)
    with pytest.raises(error, match=message):
        read_recording(tmp_path / name)


def test_what_is_missing_is_named(tmp_path: Path) -> None:
    path = tmp_path / "run.mat"
    write_5(path, {"force": FORCE})
    with pytest.raises(DataError, match="no column is named as time"):
        read_recording(path)
    assert read_recording(path, sample_rate_hz=RATE).sample_rate_hz == RATE
    with pytest.raises(ConfigurationError, match="no column 't'"):
        read_recording(path, MAP)
    write_5(path, {"words": "nothing else"})
    with pytest.raises(DataError, match="no vector of numbers"):
        read_recording(path)


@pytest.mark.parametrize(
    ("own", "message"),
    [
        ({"wf_increment": 0.02}, "'x' states 100 Hz and 'y' 50 Hz"),
        ({"wf_increment": 0.0}, "'x' states 100 Hz and 'y' no rate"),
        ({"wf_start_offset": 0.25}, "'y' starts 0.25 s after 'x'"),
        ({"wf_start_time": START - np.timedelta64(4, "ms")}, "'y' starts -0.004 s after 'x'"),
    ],
)
def test_tdms_channels_of_several_clocks_are_refused(
    tmp_path: Path, own: dict[str, Any], message: str
) -> None:
    path, common = tmp_path / "run.tdms", {"wf_increment": 0.01, "wf_start_time": START}
    write_tdms(path, {"a": {"x": (FORCE, {}), "y": (FORCE, own)}}, **common)
    with pytest.raises(DataError, match=message):
        read_recording(path)
    assert read_recording(path, sample_rate_hz=RATE).sample_rate_hz == RATE
    write_tdms(path, {"a": {"t": (TIME, {}), "x": (FORCE, {}), "y": (FORCE, own)}}, **common)
    assert read_recording(path).sample_rate_hz == pytest.approx(RATE)


def test_tdms_channels_that_start_together_by_time_and_offset(tmp_path: Path) -> None:
    late = {"wf_start_time": START - np.timedelta64(4, "ms"), "wf_start_offset": 0.004}
    common = {"wf_increment": 1.0 / RATE, "wf_start_time": START}
    write_tdms(tmp_path / "run.tdms", {"a": {"x": (FORCE, {}), "y": (FORCE, late)}}, **common)
    assert read_recording(tmp_path / "run.tdms").sample_rate_hz == pytest.approx(RATE)


@pytest.mark.parametrize("write", [write_5, write_73])
def test_mat_structs_of_several_rates_are_refused(tmp_path: Path, write) -> None:  # type: ignore[no-untyped-def]
    path = tmp_path / "run.mat"
    write(path, {"a": {"x": FORCE, "fs": 100.0}, "b": {"y": FORCE, "dt": 0.005}})
    with pytest.raises(DataError, match=r"'a\.fs' states 100 Hz and 'b\.dt' 200 Hz"):
        read_recording(path)
    write(path, {"a": {"x": FORCE, "fs": RATE}, "b": {"y": FORCE, "dt": 1.0 / RATE}})
    assert read_recording(path).sample_rate_hz == RATE


def test_into_this_projects_own_format(tmp_path: Path) -> None:
    write_5(tmp_path / "run.mat", COLUMNS)
    own = read_recording(tmp_path / "run.mat", MAP)
    again = read_recording(write_recording(own, tmp_path / "run.nc"))
    np.testing.assert_array_equal(again.samples[:, 0:COUNT], own.samples[:, 0:COUNT])
