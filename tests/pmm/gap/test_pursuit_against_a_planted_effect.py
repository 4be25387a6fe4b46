"""``pmm gap pursue`` on a simulated rig: it finds what was planted, also after a kill."""

import json
import shutil
from pathlib import Path

import pytest
from click.testing import Result

from pmm.campaign.campaign_file import read_campaign
from tests.pmm.gap.rigs import run, short

NAMES = ("heave-0.50-20", "heave-0.80-20", "heave-1.10-20")
PLANTED = '\n[[effects]]\nname = "coulomb-friction"\nparameters = { friction_n = 0.02 }\n'
ONE_RUN_MADE_ALREADY = """
[rig]
frequency_hz = { low = 0.5, high = 0.5 }
eccentricity_m = { low = 0.02, high = 0.02 }
carriage_speed_m_s = { low = 1.2, high = 1.2 }
special = ["check-weight"]
"""
ONLY = ("--effects", "coulomb-friction,gain-error", "--jobs", "1", "--json")


@pytest.fixture(scope="module")
def start(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the true rig, and a campaign of it that knows nothing of the effect."""
    folder = tmp_path_factory.mktemp("start")
    (folder / "truth.toml").write_text(short(NAMES) + PLANTED)
    done = run("simulate", folder / "truth.toml", "--output", folder / "rig")
    assert done.exit_code == 0, done.output
    (folder / "rig" / "campaign.toml").write_text(short(NAMES))
    return folder


@pytest.fixture
def rig(start: Path, tmp_path: Path) -> Path:
    return shutil.copytree(start / "rig", tmp_path / "rig")


def pursue(rig: Path, start: Path) -> Result:
    truth = start / "truth.toml"
    return run("gap", "pursue", rig, "--approve", "all", "--simulated", truth, *ONLY)


@pytest.fixture(scope="module")
def whole(start: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Result]:
    """Return the folder and the outcome of a pursuit that nobody interrupted."""
    rig = shutil.copytree(start / "rig", tmp_path_factory.mktemp("whole") / "rig")
    return rig, pursue(rig, start)


@pytest.mark.slow
def test_a_pursuit_that_starts_unsure_finds_it(whole: tuple[Path, Result]) -> None:
    rig, done = whole
    assert done.exit_code == 0, done.output
    found = json.loads(done.stdout)
    first, last = found["decisions"][0], found["decisions"][-1]
    assert first["causes"][0]["probability"] < 0.95 < last["causes"][0]["probability"]
    assert (found["ending"], last["causes"][0]["name"]) == (
        "the cause is known", "coulomb-friction",
    )  # fmt: skip
    added = [one.name for one in read_campaign(rig / "campaign.toml").runs[len(NAMES) :]]
    assert last["runs"] == [*first["runs"], *added]
    assert added
    assert all((rig / f"{name}.nc").is_file() for name in added)


@pytest.mark.slow
def test_a_pursuit_killed_after_its_last_plan_goes_on(
    whole: tuple[Path, Result], start: Path, tmp_path: Path
) -> None:
    there, done = whole
    rig = shutil.copytree(there, tmp_path / "rig")
    last = read_campaign(rig / "campaign.toml").runs[-1].name
    rounds = len(list(rig.glob("next-*.toml")))
    (rig / f"campaign.toml.{rounds}").replace(rig / "campaign.toml")
    (rig / f"{last}.nc").unlink()
    resumed = pursue(rig, start)
    assert (rig / "campaign.toml").read_text() == (there / "campaign.toml").read_text()
    assert json.loads(resumed.stdout)["decisions"] == json.loads(done.stdout)["decisions"]


@pytest.mark.slow
def test_a_folder_waits_for_its_recordings(rig: Path, whole: tuple[Path, Result]) -> None:
    made = whole[0]
    shutil.copy(made / "next-1.toml", rig)
    before = (rig / "campaign.toml").read_text()
    waiting = json.loads(run("gap", "pursue", rig, *ONLY).stdout)
    assert waiting["ending"] == "waiting"
    assert all(not one["causes"] for one in waiting["decisions"])  # nothing was diagnosed
    name = read_campaign(made / "campaign.toml").runs[len(NAMES)].name
    (rig / f"{name}.nc").write_bytes(b"half a recording")
    half = json.loads(run("gap", "pursue", rig, *ONLY).stdout)
    assert half["ending"] == "waiting"
    assert name in half["remark"]
    assert (rig / "campaign.toml").read_text() == before


@pytest.mark.slow
def test_nobody_to_ask_is_said_and_nothing_written(rig: Path) -> None:
    found = run("gap", "pursue", rig, *ONLY)
    assert found.exit_code == 1
    assert "nobody answers: Approve of these runs?" in str(found.stderr)
    assert not list(rig.glob("next-*.toml"))


@pytest.mark.slow
def test_a_recording_that_has_vanished_is_named(tmp_path: Path) -> None:
    names = (*NAMES, "pitch-0.80-20")
    (tmp_path / "truth.toml").write_text(short(names) + PLANTED)
    assert run("simulate", tmp_path / "truth.toml", "--output", tmp_path / "rig").exit_code == 0
    (tmp_path / "rig" / "heave-0.80-20.nc").unlink()
    found = json.loads(run("gap", "pursue", tmp_path / "rig", *ONLY, given="n\n").stdout)
    (said,) = [note for note in found["decisions"][-1]["notes"] if "left out" in note]
    assert said.startswith("heave-0.80-20 is left out: ")


@pytest.mark.slow
def test_what_is_not_approved_is_not_planned(rig: Path, start: Path) -> None:
    told = ("gap", "pursue", rig, "--simulated", start / "truth.toml", *ONLY)
    found = json.loads(run(*told, given="n\n").stdout)
    assert found["ending"] == "the operator did not approve"
    assert not list(rig.glob("next-*.toml"))


@pytest.mark.slow
def test_what_would_tell_outside_is_said_when_the_rig_can_do_no_more(rig: Path) -> None:
    (rig / "case.toml").write_text(ONE_RUN_MADE_ALREADY)
    twins = ("--effects", "coulomb-friction,cable", *ONLY[2:])
    found = json.loads(run("gap", "pursue", rig, *twins).stdout)
    assert (found["ending"], found["decisions"][-1]["added"]) == ("nothing left would help", [])
    assert "cable disconnected" in found["remark"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "old", "new", "said"),
    [
        ("other.toml", 'preset = "vertical-1963"', 'preset = "horizontal-1963"', "another oscilla"),
        ("rig/next-first.toml", "", "", "next-1.toml, next-2.toml, ..."),
        ("rig/next-1.toml", "[[runs]]", "[[rums]]", "rums"),
    ],
)
def test_what_cannot_be_pursued_is_refused(
    start: Path, rig: Path, name: str, old: str, new: str, said: str
) -> None:
    (rig.parent / name).write_text((start / "truth.toml").read_text().replace(old, new))
    truth = rig.parent / "other.toml" if name == "other.toml" else start / "truth.toml"
    found = run("gap", "pursue", rig, "--approve", "all", "--simulated", truth, *ONLY)
    assert found.exit_code == 2
    assert said in found.stderr


def test_no_campaign_is_refused(tmp_path: Path) -> None:
    found = run("gap", "pursue", tmp_path, *ONLY)
    assert found.exit_code == 2
    assert "no folder with a campaign.toml" in found.stderr
