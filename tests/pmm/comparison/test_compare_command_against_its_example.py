"""``pmm compare`` on ``examples/comparison``, whose truth its recipe states; and bad requests."""

import gzip
import json
import runpy
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from pmm.cli import cli

FOLDER = Path(__file__).parents[3] / "examples" / "comparison"
CAMERA, IMU = FOLDER / "camera.csv.gz", FOLDER / "imu.csv.gz"
WAVES = FOLDER.parents[2] / "shared" / "data" / "wave_forces" / "2091_1.csv.gz"


def pmm(*words: str | Path) -> Result:
    return CliRunner().invoke(cli, ["compare", *map(str, words)])


def test_the_files_are_those_of_their_recipe(tmp_path: Path) -> None:
    runpy.run_path(str(FOLDER / "make.py"))["write"](tmp_path)
    for path in (CAMERA, IMU):
        made = gzip.decompress((tmp_path / path.name).read_bytes())
        assert made == gzip.decompress(path.read_bytes())


def test_what_they_were_made_of_comes_out() -> None:
    recipe = runpy.run_path(str(FOLDER / "make.py"))
    found = json.loads(pmm(CAMERA, IMU, "--derivative", 2, "--json").stdout)
    assert found["schema"] == "pmm-comparison-1"
    lag_s = recipe["LAG_S"] + recipe["RATE"] * (found["mid_s"] - recipe["MIDDLE_S"])
    true = {"gain": recipe["GAIN"], "lag": lag_s, "clock_rate": recipe["RATE"]}
    for key, value in true.items():
        assert abs(found[key]["value"] - value) < 1.5 * found[key]["half_width"], key
    assert found["lag"]["half_width"] < 1e-3
    assert (found["gain"]["unit"], found["lag_modulo_s"]) == ("1", None)
    assert len(found["over_time"]) > 3


@pytest.mark.slow
def test_the_table_says_it_with_units(tmp_path: Path) -> None:
    said = pmm(CAMERA, IMU, "--derivative", 2, "--plot", tmp_path / "plots")
    assert said.exit_code == 0, said.stderr
    for word in ("gain", "1.02", "lag", "ms", "clock rate", "ppm", "derivative 2"):
        assert word in said.stdout
    assert "WARNING" not in said.stdout
    assert {path.suffix for path in (tmp_path / "plots").iterdir()} == {".svg", ".png"}


@pytest.mark.parametrize(
    ("words", "status", "said"),
    [
        ((f"{CAMERA}:heve", IMU), 1, "did you mean heave"),
        ((CAMERA, ":heave"), 2, "one channel"),
        ((":heave", IMU), 2, "name the file"),
        ((CAMERA, IMU, "--derivative", "9"), 2, "derivative 9"),
        (("nowhere.csv:a", IMU), 2, "no such file"),
        ((FOLDER.parent / "recordings" / "heave.csv.gz", ":F1"), 2, "name one behind a colon"),
        (
            (CAMERA, IMU, "--sample-rate", 1, "--sample-rate", 1, "--sample-rate", 1),
            2,
            "one or two",
        ),
    ],
)
def test_bad_requests_get_a_sentence(words: tuple[object, ...], status: int, said: str) -> None:
    done = pmm(*map(str, words))
    assert done.exit_code == status
    assert said in done.stderr.replace("\n", " ")
    assert "Traceback" not in done.stderr


@pytest.mark.slow
@pytest.mark.skipif(
    not WAVES.exists(), reason="the measured wave forces are not beside the project"
)
def test_two_outputs_of_one_measured_cell_move_together() -> None:
    """A fixed section's side force and moment: one gain, the arm, and no lag, at any time."""
    arms = []
    for start, end in ((38, 52), (52, 66)):
        done = pmm(f"{WAVES}:Fy", ":Mx", "--from", start, "--to", end, "--json")
        found = json.loads(done.stdout)
        assert found["gain"]["unit"] == "N m per N"
        assert abs(found["lag"]["value"]) < 2e-3
        assert abs(found["clock_rate"]["value"]) < 3.0 * found["clock_rate"]["half_width"]
        arms.append(found["gain"]["value"])
    assert arms[0] == pytest.approx(arms[1], rel=0.01)
