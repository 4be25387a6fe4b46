"""``pmm run --until cause`` through the protocols, on a rig that truly is another than its file."""

import json
import pickle
import subprocess
import sys
from pathlib import Path
from shutil import copy

import pytest
from click.testing import CliRunner, Result

from hardware.description.errors import ConfigurationError
from pmm.cli import cli
from pmm.design.design_file import read_design
from pmm.gap.causes import CauseGoal
from pmm.gap.rig_pursuit import goal_of
from pmm.plan.plan import read_plan_and_rig

EXAMPLE = Path("examples/vertical")
DESIGN = """
name = "pursued"
rig = "rig.toml"
[defaults]
settling_periods = 1
periods = 4
[zero]
duration_s = 2.0
every = 10
[[runs]]
name = "first"
motion = "heave"
frequencies_hz = [0.8, 1.0, 1.2]
amplitudes_mm = 20.0
[[grid]]
motion = "pitch"
frequencies_hz = [0.8, 1.2]
amplitudes_mm = [10.0, 20.0]
[noise]
force_n = 0.5
[gap]
effects = ["eccentricity-error", "gain-error"]
"""


def written(folder: Path, design: str = DESIGN) -> Path:
    """Write the rig's files, its cranks truly 3 % longer than it counts, and a design."""
    for one in EXAMPLE.glob("*.toml"):
        copy(one, folder)
    text, simulated = ((folder / name).read_text() for name in ("rig.toml", "simulated.toml"))
    assert text.count("counts_per_unit = 1e6") == 1
    (folder / "true.toml").write_text(text.replace("unit = 1e6", "unit = 0.97e6"))
    (folder / "simulated.toml").write_text(simulated.replace('"rig.toml"', '"true.toml"'))
    (folder / "gap.toml").write_text(design)
    return folder / "gap.toml"


def until(design: Path, goal: str, *more: str) -> Result:
    words = ["run", str(design), "--until", goal, "--output", str(design.parent / "c"), *more]
    return CliRunner().invoke(cli, words)


@pytest.mark.slow
def test_what_truly_is_other_is_known_and_the_story_is_told(tmp_path: Path) -> None:
    done = until(written(tmp_path), "cause", "--approve", "all", "--json")
    assert done.exit_code == 0, f"{done.output}{done.exception}"
    told = json.loads(done.stdout)
    assert told["ending"] == "the cause is known"
    first, last = told["decisions"][0], told["decisions"][-1]
    assert (first["runs"], first["causes"]) == ([], [])
    assert last["causes"][0]["name"] == "eccentricity-error"
    assert last["causes"][0]["probability"] > 0.95
    plan, _ = read_plan_and_rig(tmp_path / "c" / "plan.toml")
    assert [plan.runs[0].name, plan.runs[-1].name] == ["zero-01", "zero-02"]
    assert all((tmp_path / "c" / run.name / "run.nc").is_file() for run in plan.runs)
    page = tmp_path / "page.html"
    shown = CliRunner().invoke(cli, ["report", str(tmp_path / "c"), "--output", str(page)])
    assert shown.exit_code == 0, f"{shown.output}{shown.exception}"
    assert "Run after run" in page.read_text()
    assert "eccentricity-error" in page.read_text()


@pytest.mark.slow
def test_the_diagnosis_goes_to_a_process_of_its_own(tmp_path: Path) -> None:
    goal = goal_of(read_design(written(tmp_path)), tmp_path / "c")
    assert isinstance(goal, CauseGoal)
    there = pickle.loads(pickle.dumps(goal.diagnose))  # noqa: S301 (our own)
    with pytest.raises(ConfigurationError, match="no such folder"):
        there()  # nothing was recorded; that is what it says from there


def test_the_loop_itself_loads_no_diagnosis(tmp_path: Path) -> None:
    code = (
        "import sys; from pathlib import Path; from pmm.design.design_file import read_design; "
        "from pmm.gap.rig_pursuit import goal_of; design = Path(sys.argv[1]); "
        "goal_of(read_design(design), design.parent); print(*sys.modules)"
    )
    words = [sys.executable, "-c", code, str(written(tmp_path))]
    loaded = subprocess.run(words, capture_output=True, text=True, check=True).stdout.split()
    assert "pmm.gap.causes" in loaded
    rooms = ("design", "inference", "judge", "locate", "search")
    barred = ("pmm.gap.examination", *(f"analysis.gap.{room}" for room in rooms))
    assert [name for name in loaded if name.startswith(barred)] == []


@pytest.mark.parametrize(
    ("goal", "old", "new", "said"),
    [
        ("targets", "", "", "--until targets one without it"),
        ("cause", "[gap]", "[limits]\ntime_h = 1.0\n[gap]\nbatch = 6", "= 6 should be from 1 to 5"),
        ("cause", "[0.8, 1.0, 1.2]\namplitudes_mm = 20.0", "1.0\namplitudes_mm = 20.0",
         "begins with 1 oscillations"),
        ("cause", '"gain-error"]', '"gain-eror"]', "gain-error"),
    ],
)  # fmt: skip
def test_what_cannot_be_pursued_is_one_sentence(
    tmp_path: Path, goal: str, old: str, new: str, said: str
) -> None:
    done = until(written(tmp_path, DESIGN.replace(old, new)), goal, "--approve", "all")
    assert done.exit_code == 2, f"{done.output}{done.exception}"
    assert said in str(done.exception) + done.output
    assert not (tmp_path / "c" / "plan.toml").exists()
