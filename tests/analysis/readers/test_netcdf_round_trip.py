"""What is written as NetCDF, or turned into a dataset, comes back exactly."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from analysis.readers import from_dataset, read_recording, to_dataset, write_recording
from analysis.readers.netcdf import STRETCH_SAMPLES
from analysis.recording import Recording
from hardware.description.channels import Channel
from hardware.description.dataset import SCHEMA
from hardware.description.flags import Flag, Severity
from hardware.description.setpoint import Medium, SetPoint

words = st.text(max_size=20)
finite = st.floats(allow_nan=False, allow_infinity=False, width=64)
measured = st.floats(-1e12, 1e12, width=64)  # beyond it is no measurement
positive = st.floats(min_value=1e-3, max_value=1e6)
names = st.from_regex(r"[A-Za-z_é][A-Za-z0-9_. \[\]é-]{0,8}[A-Za-z0-9é]", fullmatch=True).filter(
    lambda name: name not in ("time", "photocell_edge", "photocell_edge_time")
)
units = st.sampled_from(["N", "N m", "m", "rad", "m/s", "V", "1", "", "bar"])
flags = st.builds(Flag, words, st.sampled_from(Severity), words, st.one_of(st.none(), words))
set_points = st.builds(SetPoint, positive, positive, finite, finite, st.sampled_from(Medium))


@st.composite
def recordings(draw: st.DrawFn) -> Recording:
    keys = draw(st.lists(names, min_size=1, max_size=4, unique=True))
    scales = st.one_of(st.none(), positive)
    count = draw(st.integers(1, 30))
    edges = draw(st.one_of(st.none(), st.lists(finite, max_size=5, unique=True)))
    return Recording(
        name=draw(st.from_regex(r"[A-Za-z0-9_]{1,12}", fullmatch=True)),
        channels=tuple(Channel(key, draw(units), draw(scales)) for key in keys),
        samples=draw(arrays(np.float64, (len(keys), count), elements=measured)),
        sample_rate_hz=draw(positive),
        start_s=draw(st.floats(-1e4, 1e4)),
        photocell_edges_s=None if edges is None else np.array(sorted(edges), dtype=np.float64),
        set_point=draw(st.one_of(st.none(), set_points)),
        provenance=draw(st.dictionaries(words, words, max_size=3)),
        flags=tuple(draw(st.lists(flags, max_size=3))),
    )


def assert_same(found: Recording, expected: Recording) -> None:
    count = expected.sample_count
    assert found.sample_count == count
    bits = [np.ascontiguousarray(r.samples[:, 0:count]).view(np.int64) for r in (found, expected)]
    nan = np.isnan(expected.samples[:, 0:count])
    assert np.array_equal(bits[0][~nan], bits[1][~nan])
    assert np.isnan(found.samples[:, 0:count][nan]).all()
    if expected.photocell_edges_s is None:
        assert found.photocell_edges_s is None
    else:
        assert found.photocell_edges_s is not None
        assert found.photocell_edges_s.tolist() == expected.photocell_edges_s.tolist()
    for key in ("name", "channels", "sample_rate_hz", "start_s", "set_point", "flags"):
        assert getattr(found, key) == getattr(expected, key), key
    assert dict(found.provenance) == dict(expected.provenance)


@pytest.mark.slow
@given(recording=recordings())
def test_a_file_gives_back_what_was_written(
    tmp_path_factory: pytest.TempPathFactory, recording: Recording
) -> None:
    path = tmp_path_factory.mktemp("trip") / "run.nc"
    write_recording(recording, path)
    assert_same(read_recording(path), recording)
    # Written once more from the lazily read samples, it is still the same.
    again = write_recording(read_recording(path), path.with_name("again.nc"))
    assert_same(read_recording(again), recording)


@given(recording=recordings())
def test_a_dataset_gives_back_what_went_in(recording: Recording) -> None:
    assert_same(from_dataset(to_dataset(recording)), recording)


def example(count: int = 200) -> Recording:
    rng = np.random.default_rng(7)
    return Recording(
        name="heave_3",
        channels=(Channel("zeta", "m"), Channel("alpha", "N", 500.0)),
        samples=rng.standard_normal((2, count)),
        sample_rate_hz=200.0,
        start_s=1.5,
        photocell_edges_s=np.array([1.6, 2.1]),
        set_point=SetPoint(0.83, 0.02, strut_phase_rad=0.1, medium=Medium.AIR),
        provenance={"source_file": "a.csv", "sha256": "0" * 64, "reader": "csv"},
        flags=(Flag("gap", Severity.WARNING, "3 samples", "zeta"),),
    )


def test_the_file_is_the_dataset_that_xarray_reads(tmp_path: Path) -> None:
    path = write_recording(example(), tmp_path / "run.nc")
    with xr.open_dataset(path, engine="h5netcdf") as stored:
        expected = to_dataset(example()).assign_attrs(checksums="crc32")
        assert stored.identical(expected)
        assert list(stored.data_vars) == list(expected.data_vars)
        assert stored.attrs["schema"] == SCHEMA
        assert stored["alpha"].attrs == {"units": "N", "full_scale": 500.0}


def test_a_file_that_xarray_wrote_is_read(tmp_path: Path) -> None:
    path = tmp_path / "run.nc"
    to_dataset(example()).to_netcdf(path, engine="h5netcdf")
    assert_same(read_recording(path), example())


def test_single_precision_variables_are_widened(tmp_path: Path) -> None:
    path = tmp_path / "run.nc"
    dataset = to_dataset(example())
    dataset["zeta"] = dataset["zeta"].astype(np.float32)
    dataset.to_netcdf(path, engine="h5netcdf")
    samples = read_recording(path).samples[:, 10:20]
    assert samples.dtype == np.float64
    assert np.array_equal(samples[0], dataset["zeta"].values[10:20].astype(np.float64))


def test_a_recording_longer_than_a_block(tmp_path: Path) -> None:
    count = STRETCH_SAMPLES + 17
    recording = replace(example(), samples=np.random.default_rng(3).standard_normal((2, count)))
    assert_same(read_recording(write_recording(recording, tmp_path / "run.nc")), recording)


def test_many_flags_are_kept(tmp_path: Path) -> None:
    many = tuple(Flag("gap", Severity.NOTE, f"{n} " * 50) for n in range(2000))
    path = write_recording(replace(example(), flags=many), tmp_path / "run.nc")
    assert read_recording(path).flags == many


def test_a_name_given_to_a_dataset_is_taken() -> None:
    assert from_dataset(to_dataset(example()), "other").name == "other"
