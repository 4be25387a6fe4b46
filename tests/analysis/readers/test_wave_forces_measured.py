"""A public record of wave forces on a ship section, as its authors' logger wrote it."""

import csv
import gzip
from pathlib import Path

import numpy as np
import pytest

from analysis.readers import read_recording, write_recording
from analysis.readers.columns_options import parse_options
from hardware.description.channels import Channel

DATA = Path(__file__).parents[4] / "shared" / "data" / "wave_forces"
RUNS = {"2091_1": 15_580, "2111_1": 11_685}

pytestmark = pytest.mark.skipif(
    not DATA.is_dir(), reason="the measured wave forces do not lie beside the project"
)


@pytest.mark.parametrize("name", RUNS)
def test_everything_by_the_headers(name: str) -> None:
    recording = read_recording(DATA / f"{name}.csv.gz")
    assert recording.samples.shape == (12, RUNS[name])
    assert recording.channels[0] == Channel("WM_Position", "m")
    assert recording.channels[7:10] == tuple(
        Channel(key, unit) for key, unit in (("Fy", "N"), ("Fz", "N"), ("Mx", "N m"))
    )
    assert [flag.code for flag in recording.flags] == ["index_column", "time_single_precision"]
    assert recording.sample_rate_hz == pytest.approx(200.0, rel=1e-7)
    assert np.isfinite(recording.samples[:, 0 : recording.sample_count]).all()


@pytest.mark.parametrize("name", RUNS)
def test_mapped_and_kept_as_netcdf(name: str, tmp_path: Path) -> None:
    columns = parse_options(["stroke=WM_Position", "Fy"])
    recording = read_recording(DATA / f"{name}.csv.gz", columns)
    assert recording.channels == (Channel("stroke", "m"), Channel("Fy", "N"))
    stored = read_recording(write_recording(recording, tmp_path / "run.nc"))
    assert np.array_equal(stored.values("Fy"), recording.values("Fy"))
    assert stored.provenance == recording.provenance


@pytest.mark.parametrize("name", RUNS)
def test_numbers_are_those_of_the_standard_library(name: str) -> None:
    with gzip.open(DATA / f"{name}.csv.gz", "rt", newline="") as file:
        rows = list(csv.DictReader(file))
    recording = read_recording(DATA / f"{name}.csv.gz")
    for header, channel in (("WM_Position [m]", "WM_Position"), ("Mz [Nm]", "Mz")):
        expected = [float(row[header]) for row in rows]
        assert recording.values(channel).tolist() == expected
    times = [float(row["Time [s]"]) for row in rows]
    assert recording.time_s() == pytest.approx(times, abs=1e-9)
