"""A NetCDF file that was changed from outside is said to be: no value is ever altered unseen."""

import json
import re
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr

from analysis.readers import read_recording, to_dataset, write_recording
from analysis.readers.checksums import BLOCK_EDGES, BLOCK_SAMPLES
from analysis.recording import Recording
from hardware.description.channels import Channel
from hardware.description.errors import DataError
from hardware.description.setpoint import SetPoint

COUNT = 3 * BLOCK_SAMPLES + 200
FLIPS = 200
CHANNELS = ("force_aft", "force_fore", "shaft_angle")


def example() -> Recording:
    rng = np.random.default_rng(20)
    return Recording(
        name="heave_3",
        channels=(
            Channel("force_aft", "N", 500.0),
            Channel("force_fore", "N", 500.0),
            Channel("shaft_angle", "rad"),
        ),
        samples=rng.normal(size=(3, COUNT)),
        sample_rate_hz=100.0,
        start_s=12.0,
        photocell_edges_s=12.0 + np.arange(1.0, 41.0) * 0.83,
        set_point=SetPoint(0.83, 0.02),
        provenance={"plan": "{}"},
    )


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return write_recording(example(), tmp_path / "run.nc")


def values(recording: Recording) -> np.ndarray:
    return recording.samples[:, 0 : recording.sample_count]


def said(recording: Recording) -> str:
    return " | ".join(flag.message for flag in recording.flags if flag.damaged)


def flip(path: Path, at: int, bit: int) -> None:
    data = bytearray(path.read_bytes())
    data[at] ^= 1 << bit
    path.write_bytes(data)


def place_of(path: Path, name: str, sample: int) -> int:
    """Return where in the file a sample lies."""
    data = path.read_bytes()
    wanted = np.float64(values(read_recording(path))[CHANNELS.index(name), sample]).tobytes()
    assert data.count(wanted) == 1
    return data.index(wanted)


def test_an_unharmed_file_is_silent(path: Path) -> None:
    assert read_recording(path).flags == ()


@pytest.mark.slow
def test_a_flipped_bit_anywhere_is_refused_said_or_harmless(path: Path) -> None:
    whole, before, expected = path.read_bytes(), read_recording(path), values(read_recording(path))
    rng, silent = np.random.default_rng(23), 0
    for at, bit in rng.integers((0, 0), (len(whole), 8), (FLIPS, 2)):
        flip(path, int(at), int(bit))
        try:
            after = read_recording(path)
            found = values(after)
        except DataError:
            continue
        finally:
            path.write_bytes(whole)
        missing = np.isnan(found)
        assert np.array_equal(found[~missing], expected[~missing])
        if said(after):
            continue
        silent += 1
        assert not missing.any()
        assert (after.channels, after.set_point) == (before.channels, before.set_point)
        assert (after.provenance, after.name) == (before.provenance, before.name)
        assert (after.start_s, after.sample_rate_hz) == (before.start_s, before.sample_rate_hz)
        assert np.array_equal(after.photocell_edges_s, before.photocell_edges_s)
    assert silent < FLIPS / 4


def test_a_flipped_bit_of_a_sample_costs_its_block_alone(path: Path) -> None:
    before = values(read_recording(path))
    sample = BLOCK_SAMPLES + 17
    flip(path, place_of(path, "force_fore", sample) + 6, 3)
    recording = read_recording(path)
    after = values(recording)
    lost = np.zeros_like(before, bool)
    lost[1, BLOCK_SAMPLES : 2 * BLOCK_SAMPLES] = True
    assert np.isnan(after[lost]).all()
    assert np.array_equal(after[~lost], before[~lost])
    (flag,) = recording.flags
    assert flag.damaged
    assert flag.channel == "force_fore"
    assert flag.message.startswith("force_fore: samples 1024 to 2047 (22.240 s to 32.470 s) are")


def test_any_stretch_of_a_damaged_file_is_that_of_the_whole(path: Path) -> None:
    flip(path, place_of(path, "force_aft", 5), 1)
    flip(path, place_of(path, "force_aft", COUNT - 5), 1)
    recording = read_recording(path)
    whole = values(recording)
    for rows, when in (
        (slice(None), slice(900, 1100)),
        ([2, 0], slice(0, COUNT, 7)),
        ([0], slice(3000, COUNT)),
        (slice(0, 1), slice(10, 20)),
    ):
        assert np.array_equal(recording.samples[rows, when], whole[rows, when], equal_nan=True)


def edit(change: Callable[[h5py.File], None]) -> Callable[[Path], None]:
    def done(path: Path) -> None:
        with h5py.File(path, "r+") as file:
            change(file)

    return done


def value(name: str, at: int) -> Callable[[Path], None]:
    def change(file: h5py.File) -> None:
        file[name][at] = file[name][at] + 1e-9

    return edit(change)


def drop(name: str) -> Callable[[Path], None]:
    def change(file: h5py.File) -> None:
        del file[name]

    return edit(change)


def attribute(of: str, key: str, text: object) -> Callable[[Path], None]:
    return edit(lambda file: file[of].attrs.modify(key, text))


def through_xarray(path: Path) -> None:
    dataset = xr.load_dataset(path, engine="h5netcdf")
    dataset["force_aft"] *= 2.0
    dataset.to_netcdf(path, engine="h5netcdf")


EDITS = {
    "value": (value("force_aft", 3000), r"force_aft: samples 2048 to 3071 "),
    "last": (value("force_aft", COUNT - 1), rf"samples 3072 to {COUNT - 1} "),
    "time": (value("time", 5), r"times of samples 0 to 1023 .* even grid"),
    "pulse": (value("photocell_edge_time", 17), r"photocell pulses 17 to 32 .* left out"),
    "unit": (attribute("force_aft", "units", "V"), r"attribute 'units' of force_aft"),
    "scale": (attribute("force_aft", "full_scale", 5.0), r"attribute 'full_scale' of force_aft"),
    "name": (attribute("/", "run_name", "heave_4"), r"attribute 'run_name' is"),
    "point": (
        attribute("/", "set_point", '{"frequency_hz": 0.84, "eccentricity_m": 0.02}'),
        r"attribute 'set_point' is",
    ),
    "more": (attribute("/", "comment", "mine"), r"attribute 'comment' is"),
    "sums": (drop("checksums"), r"its checksums are lost"),
    "channel": (drop("force_fore"), r"the channel force_fore was written and is not there"),
    "xarray": (through_xarray, r"its checksums are lost"),
}


@pytest.mark.parametrize(("change", "sentence"), EDITS.values(), ids=EDITS.keys())
def test_an_edit_is_said(path: Path, change: Callable[[Path], None], sentence: str) -> None:
    change(path)
    assert re.search(sentence, said(read_recording(path)))


def test_damaged_times_leave_the_grid(path: Path) -> None:
    before = values(read_recording(path))
    value("time", 5)(path)
    after = read_recording(path)
    assert after.start_s == pytest.approx(12.0, abs=1e-12)
    assert np.array_equal(values(after), before)


def test_a_damaged_pulse_costs_its_block_alone(path: Path) -> None:
    before = read_recording(path).photocell_edges_s
    assert before is not None
    value("photocell_edge_time", 17)(path)
    after = read_recording(path).photocell_edges_s
    assert np.array_equal(after, np.delete(before, np.s_[BLOCK_EDGES : 2 * BLOCK_EDGES]))


def test_another_length_than_was_written_is_refused(path: Path) -> None:
    with h5py.File(path, "r+") as file:
        counts = json.loads(file["checksums"].attrs["counts"]) | {"force_aft": COUNT + 1}
        file["checksums"].attrs["counts"] = json.dumps(counts)
    with pytest.raises(DataError, match=f"has {COUNT} values, {COUNT + 1} were written"):
        read_recording(path)


def test_what_is_kept_of_a_damaged_file_is_whole_and_says_so(path: Path, tmp_path: Path) -> None:
    value("force_aft", 3000)(path)
    salvaged = read_recording(write_recording(read_recording(path), tmp_path / "salvaged.nc"))
    assert "force_aft: samples 2048 to 3071" in said(salvaged)
    assert np.array_equal(values(salvaged), values(read_recording(path)), equal_nan=True)


def test_a_file_of_another_program_is_read(tmp_path: Path) -> None:
    to_dataset(example()).to_netcdf(tmp_path / "foreign.nc", engine="h5netcdf")
    assert not said(read_recording(tmp_path / "foreign.nc"))
