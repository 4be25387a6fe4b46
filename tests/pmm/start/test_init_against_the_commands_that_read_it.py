"""What ``pmm init`` writes passes the commands it is for, and nothing is written over."""

import gzip
import json
import tomllib
from importlib.metadata import entry_points
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from pmm.cli import cli
from pmm.start.questions import JOBS
from pmm.steering.settings import read_steering_settings

PATHS = pytest.param(
    "paths",
    marks=pytest.mark.skipif(
        not entry_points(group="pmm.drivers", name="path-struts"),
        reason="the package is installed as it was before this driver; install it anew",
    ),
)
EXAMPLES = Path(__file__).parents[3] / "examples"


def pmm(*words: object, typed: str | None = None) -> Result:
    return CliRunner().invoke(cli, [str(one) for one in words], input=typed)


def read_text(path: Path) -> list[str]:
    with gzip.open(path, "rt", encoding="utf-8") as file:
        return file.read().splitlines()


@pytest.mark.sample(5)
@pytest.mark.parametrize("plane", ["vertical", "horizontal"])
@pytest.mark.parametrize("axes", ["driven", "by-hand", PATHS])
@pytest.mark.parametrize("interface", ["pmm-simulated", "socketcan"])
def test_a_rig_passes_the_check_of_its_plan(
    tmp_path: Path, plane: str, axes: str, interface: str
) -> None:
    options = ("--plane", plane, "--axes", axes, "--interface", interface)
    made = pmm("init", "rig", "--yes", "--output", tmp_path, *options)
    assert made.exit_code == 0, made.stderr
    checked = pmm("plan", "check", tmp_path / "plan.toml")
    assert checked.exit_code == 0, checked.stdout + checked.stderr
    assert "the rig can run it" in checked.stdout
    assert (tmp_path / "simulated.toml").exists() == (interface == "pmm-simulated")


@pytest.mark.parametrize(
    ("plane", "clearance"),
    [("vertical", "reach down [m]"), ("horizontal", "reach to the side [m]")],
)
def test_a_new_rig_is_checked_for_blockage_and_clearance(
    tmp_path: Path, plane: str, clearance: str
) -> None:
    """Blockage is B T / (W h) of the answers; nothing of model or tank is left unchecked."""
    told = {"beam-m": 0.5, "draught-m": 0.2, "tank-width-m": 5.0, "tank-depth-m": 3.0}
    options = [word for name, value in told.items() for word in (f"--{name}", value)]
    pmm("init", "rig", "--yes", "--output", tmp_path, "--plane", plane, *options)
    checked = pmm("plan", "check", tmp_path / "plan.toml", "--json")
    found: dict[str, list[dict[str, object]]] = {}
    for one in json.loads(checked.stdout)["findings"]:
        found.setdefault(one["quantity"], []).append(one)
    (blockage,) = {one["value"] for one in found["blockage B T / (W h)"]}
    assert blockage == pytest.approx(0.5 * 0.2 / (5.0 * 3.0))
    (depth,) = {one["value"] for one in found["depth over draught h / T"]}
    assert depth == pytest.approx(3.0 / 0.2)
    assert clearance in found
    unchecked = " ".join(str(one["message"]) for one in found.get("not checked", []))
    assert "model" not in unchecked
    assert "tank" not in unchecked


@pytest.mark.slow
def test_a_simulated_rig_runs(tmp_path: Path) -> None:
    pmm("init", "rig", "--yes", "--output", tmp_path)
    done = pmm("run", tmp_path / "plan.toml", "--output", tmp_path / "runs",
               "--only", "heave-f0.83-a20")  # fmt: skip
    assert done.exit_code == 0, done.stderr
    analysed = pmm("analyse", tmp_path / "runs", "--json")
    (found,) = json.loads(analysed.stdout)["runs"]
    assert found["reference_frequency_hz"] == pytest.approx(0.83, rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("plane", ["vertical", "horizontal"])
def test_a_campaign_is_simulated_and_analysed(tmp_path: Path, plane: str) -> None:
    pmm("init", "campaign", "--yes", "--output", tmp_path, "--plane", plane)
    made = pmm("simulate", tmp_path / "campaign.toml", "--output", tmp_path / "out")
    assert made.exit_code == 0, made.stderr
    document = json.loads(pmm("analyse", tmp_path / "out", "--json").stdout)
    assert len(document["runs"]) == 6
    assert document["campaigns"] == []


@pytest.mark.slow
def test_recordings_become_a_campaign_with_their_set_points(tmp_path: Path) -> None:
    recordings = sorted((EXAMPLES / "foreign").glob("*.csv.gz"))
    model = ("--mass-kg", 70, "--inertia-kg-m2", 27.5)
    made = pmm("init", "campaign", "--yes", "--output", tmp_path, *model, *recordings)
    assert made.exit_code == 0, made.stderr
    document = json.loads(pmm("analyse", tmp_path, "--json").stdout)
    assert document["failed"] == []
    found = {Path(run["file"]).name.split(".")[0]: run["flags"] for run in document["runs"]}
    assert set(found) == {f"{kind}_{f}" for kind in ("tauchen", "nicken")
                          for f in ("060", "090", "120")}  # fmt: skip
    differs = [flag for flags in found.values() for flag in flags
               if flag["code"] == "set_point_differs"]  # fmt: skip
    assert differs == []
    (campaign,) = document["campaigns"]
    assert {flag["channel"] for flag in campaign["flags"]} == {"force_aft", "force_fore"}


def test_a_recording_with_units_in_its_headers_needs_no_question(tmp_path: Path) -> None:
    pmm("init", "campaign", "--yes", "--output", tmp_path, EXAMPLES / "recordings/heave.csv.gz")
    text = (tmp_path / "campaign.toml").read_text(encoding="utf-8")
    assert 'displacement_aft = "Strut A"' in text
    assert 'force_fore = "F2"' in text
    assert "frequency_hz = 0.83" in text
    assert pmm("analyse", tmp_path).exit_code == 0


def test_what_nobody_stated_is_no_number_to_reckon_with(tmp_path: Path) -> None:
    """Forces alone tell no amplitude, and no recording tells a model."""
    text = read_text(EXAMPLES / "recordings/heave.csv.gz")
    kept = [0, *(k for k, name in enumerate(text[0].split(",")) if name.startswith("F"))]
    lines = [",".join(line.split(",")[k] for k in kept) for line in text]
    (tmp_path / "forces.csv").write_text("\n".join(lines), encoding="utf-8")
    made = pmm("init", "campaign", "--yes", "--output", tmp_path, tmp_path / "forces.csv")
    assert made.exit_code == 0, made.stderr
    for name in ("plane", "half_spacing_m", "mass_kg", "inertia_kg_m2"):
        assert f"nobody stated {name}" in made.stderr
    document = tomllib.loads((tmp_path / "campaign.toml").read_text(encoding="utf-8"))
    assert "model" not in document
    assert "eccentricity_mm" not in document["runs"][0]
    refused = pmm("coefficients", tmp_path)
    assert refused.exit_code == 2
    assert "eccentricity_m is missing" in refused.stderr


@pytest.mark.parametrize("job", ["swing", "bifilar"])
def test_an_inertia_file_gives_a_number(tmp_path: Path, job: str) -> None:
    assert pmm("init", job, "--yes", "--output", tmp_path).exit_code == 0
    found = pmm("inertia", job, tmp_path / f"{job}.toml", "--json")
    assert found.exit_code == 0, found.stderr
    assert json.loads(found.stdout)["results"]


def test_propeller_and_rudder_are_those_of_the_answers(tmp_path: Path) -> None:
    told = {"length-m": 3.0, "diameter-m": 0.1, "rudder-area-m2": 0.01, "rudder-height-m": 0.15}
    options = [word for name, value in told.items() for word in (f"--{name}", value)]
    made = pmm("init", "steering", "--yes", "--output", tmp_path, *options)
    assert made.exit_code == 0, made.stderr
    read = read_steering_settings(tmp_path / "steering.toml")
    assert (read.length_m, read.propeller.diameter_m) == (3.0, 0.1)
    aspect = 0.15**2 / 0.01
    fujii = 6.13 * aspect / (aspect + 2.25)
    found = (read.rudder.area_m2, read.rudder.height_m, read.rudder.slope, read.rudder.x_m)
    assert found == pytest.approx((0.01, 0.15, fujii, -1.5), rel=1e-3)


@pytest.mark.slow
def test_a_ship_turns(tmp_path: Path) -> None:
    assert pmm("init", "ship", "--yes", "--output", tmp_path).exit_code == 0
    found = pmm("manoeuvre", tmp_path / "ship.toml", "--trials", "0", "--json")
    assert found.exit_code == 0, found.stderr
    rows = json.loads(found.stdout)["quantities"]
    advance = next(one for one in rows if one["name"] == "advance")
    assert 1.0 < advance["value"] < 6.0


@pytest.mark.slow
def test_records_of_a_swing_are_named_from_the_file(tmp_path: Path) -> None:
    records = sorted((EXAMPLES / "inertia").glob("swing-*.csv.gz"))
    made = pmm("init", "swing", "--yes", "--output", tmp_path, *records)
    assert made.exit_code == 0, made.stderr
    found = json.loads(pmm("inertia", "swing", tmp_path / "swing.toml", "--json").stdout)
    assert found["results"]["tare_period_s"]["value"] == pytest.approx(7.2869, abs=0.01)


def test_questions_are_asked_and_answered(tmp_path: Path) -> None:
    typed = "\n".join(["basin", "horizontal", *[""] * (len(JOBS["rig"]) - 2)]) + "\n"
    made = pmm("init", "rig", "--output", tmp_path, typed=typed)
    assert made.exit_code == 0, made.stderr
    text = (tmp_path / "rig.toml").read_text(encoding="utf-8")
    assert 'name = "basin"' in text
    assert "horizontal-1963" in text
    assert all(question.text in made.stderr for question in JOBS["rig"])


@pytest.mark.parametrize("job", ["rig", "campaign", "swing", "bifilar", "ship"])
def test_nothing_is_written_over_without_force(tmp_path: Path, job: str) -> None:
    pmm("init", job, "--yes", "--output", tmp_path)
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    again = pmm("init", job, "--yes", "--output", tmp_path, "--name", "other")
    assert again.exit_code == 2
    assert "--force" in again.stderr
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before
    assert pmm("init", job, "--yes", "--output", tmp_path, "--name", "other",
               "--force").exit_code == 0  # fmt: skip
    assert any(path.read_bytes() != old for path, old in before.items())


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("rig", "--mass-kg", "-3"), "--mass-kg -3: should be above 0"),
        (("rig", "--axes", "sideways"), "by-hand"),
        (("campaign", "not-there.csv"), "not-there.csv: no such recording"),
        (("rgi",), "did you mean 'rig'?"),
    ],
)
def test_what_cannot_be_is_refused_and_nothing_written(
    tmp_path: Path, words: tuple[str, ...], said: str
) -> None:
    refused = pmm("init", words[0], "--yes", "--output", tmp_path, *words[1:])
    assert refused.exit_code == 2
    assert said in refused.stderr
    assert list(tmp_path.iterdir()) == []
