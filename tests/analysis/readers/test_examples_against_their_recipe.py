"""The example recording carries what its script says it was made of."""

import gzip
import runpy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from analysis.readers import read_recording
from analysis.readers.columns_toml import read_column_map

FOLDER = Path(__file__).parents[3] / "examples" / "recordings"


@pytest.fixture(scope="module")
def recipe() -> dict[str, Any]:
    return runpy.run_path(str(FOLDER / "make.py"))


def test_it_is_small() -> None:
    assert (FOLDER / "heave.csv.gz").stat().st_size < 300_000


def test_the_script_writes_it_again(recipe: dict[str, Any], tmp_path: Path) -> None:
    recipe["write"](tmp_path / "heave.csv.gz")
    with gzip.open(tmp_path / "heave.csv.gz") as again, gzip.open(FOLDER / "heave.csv.gz") as kept:
        new, old = (np.loadtxt(file, delimiter=",", skiprows=1) for file in (again, kept))
    assert np.abs(new - old).max() < 0.0015  # the last printed digit


def test_the_map_gives_the_harmonics_of_the_recipe(recipe: dict[str, Any]) -> None:
    columns = read_column_map(FOLDER / "heave.toml")
    recording = read_recording(FOLDER / "heave.csv.gz", columns)
    assert recording.channel_names == ("displacement_aft", "force_aft", "force_fore")
    assert recording.flags == ()
    time_s = recording.time_s()
    angle = 2.0 * np.pi * recipe["FREQUENCY_HZ"] * time_s
    basis = [np.ones_like(time_s), time_s]
    basis += [f(n * angle) for n in (1, 2, 3) for f in (np.sin, np.cos)]
    for name, parts in (("force_aft", "FORCE_AFT"), ("force_fore", "FORCE_FORE")):
        solution = np.linalg.lstsq(np.array(basis).T, recording.values(name), rcond=None)[0]
        found = solution[2::2] + 1j * solution[3::2]
        expected = [a * np.exp(1j * p) for a, p in recipe[parts]]
        # Five standard deviations of the printed noise over 8000 samples.
        assert found == pytest.approx(expected, abs=5.0 * recipe["NOISE_N"] * (2 / 8000) ** 0.5)
