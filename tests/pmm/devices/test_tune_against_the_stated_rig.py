"""``pmm devices tune`` on a simulated rig finds the motor that its file states."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from pmm.cli import cli

_VERTICAL = Path(__file__).parents[3] / "examples" / "vertical"
_MOTOR = """
[campaign.drive.motor]
constant_n_m_a = 0.8
gear_inertia_kg_m2 = 0.7
loop = { proportional = 2.0, integral = 10.0 }
"""


@pytest.fixture
def rig(tmp_path: Path) -> Path:
    """The example with a motor of 1.5 kg m2 at the shaft."""
    for name in ("rig.toml", "simulated.toml", "plan.toml"):
        (tmp_path / name).write_text((_VERTICAL / name).read_text(encoding="utf-8"), "utf-8")
    path = tmp_path / "rig.toml"
    path.write_text(path.read_text(encoding="utf-8") + _MOTOR, encoding="utf-8")
    return path


def _tune(*words: object) -> Result:
    return CliRunner().invoke(cli, ["devices", "tune", *map(str, words)])


@pytest.mark.slow
def test_what_is_stated_is_found(rig: Path, tmp_path: Path) -> None:
    plots = tmp_path / "plots"
    told = _tune(rig, "--free-running", "--yes", "--json", "--plot", plots)
    assert told.exit_code == 0, told.output
    data = json.loads(told.stdout)
    found = {one["what"]: one for one in data["found"]}
    inertia, gain = found["inertia at the shaft"], found["proportional gain"]
    assert abs(inertia["value"] - 1.5) < inertia["half_width"] < 0.1
    assert abs(gain["value"] - 2.0) < 2.0 * gain["half_width"] < 0.02
    names = [one["name"] for one in data["settings"]]
    assert names == ["stated", "found", "proposed"]
    assert data["settings"][2]["largest_sensitivity"] == pytest.approx(1.4, abs=0.01)
    assert {one.name for one in plots.glob("*.png")} == {
        "rig-lag.png", "rig-bode.png", "rig-step.png",
    }  # fmt: skip


@pytest.mark.slow
def test_stated_data_alone_move_nothing_and_tell_each_run(rig: Path) -> None:
    told = _tune(rig, "--stated", "--json", "--plan", rig.with_name("plan.toml"))
    assert told.exit_code == 0, told.output
    data = json.loads(told.stdout)
    assert "found" not in data
    assert len(data["ripples"]) > 20
    assert all(0.0 < one["proposed"] < one["stated"] for one in data["ripples"])


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--speeds", "1.0", "0.5", "--yes"), "the second speed has to be above the first"),
        (("--speeds", "0.5", "9.0", "--yes"), "nothing was moved"),
        (("--stated", "--sensitivity", "1.0"), "not in the range x>1.0"),
    ],
)
def test_what_cannot_be_is_one_sentence(rig: Path, words: tuple[str, ...], said: str) -> None:
    told = _tune(rig, "--free-running", *words)
    assert told.exit_code in {1, 2}
    assert said in told.output + str(told.exception)


def test_a_rig_without_its_motor_is_told_what_to_state(rig: Path) -> None:
    rig.write_text((_VERTICAL / "rig.toml").read_text(encoding="utf-8"), encoding="utf-8")
    told = _tune(rig, "--stated")
    assert "[campaign.drive.motor]" in told.output + str(told.exception)
