"""Every example is run by its commands, and gives what it was made of."""

import json
import math
import shutil
import tomllib
from pathlib import Path

import pytest
from click.testing import CliRunner

from pmm.cli import cli

EXAMPLES = Path(__file__).parents[2] / "examples"
ELSEWHERE = {
    "driver-text-amplifier": "tests/hardware/test_example_driver_against_contract.py",
    "afloat": "tests/pmm/gap/test_forced_runs_against_simulated_bodies.py",
    "comparison": "tests/pmm/comparison/test_compare_command_against_its_example.py",
    "decay": "tests/pmm/gap/test_pendulum_command_against_simulated_bodies.py",
    "foreign": "tests/examples/test_foreign_campaign_against_what_it_was_made_of.py",
    "gap": "tests/pmm/gap/test_gap_command_against_its_page.py",
    "lines": "tests/end_to_end/test_many_lines_against_put_in_hull.py",
    "manoeuvre": "tests/pmm/manoeuvre/test_command_against_known_derivatives.py",
    "manual": "tests/pmm/plan/test_commands_against_examples.py",
    "roll": "tests/pmm/coefficients/test_heel_against_its_example.py",
    "steering": "tests/pmm/steering/test_command_against_its_example.py",
    "recordings": "tests/analysis/readers/test_examples_against_their_recipe.py",
}
HERE = ("attitude", "horizontal", "inertia", "paths", "vertical")
INERTIA = {
    "axes": "bifilar",
    "ballast": "ballast",
    "combine": "combine",
    "gates": "pendulum",
    "guided": "bifilar",
    "hull": "bifilar",
    "incline": "incline",
    "pendulum": "pendulum",
    "plan": "plan",
    "swing": "swing",
    "torsion": "pendulum",
}


def test_no_example_is_forgotten() -> None:
    folders = {path.name for path in EXAMPLES.iterdir() if path.is_dir()}
    assert folders == {*ELSEWHERE, *HERE}
    assert {path.stem for path in (EXAMPLES / "inertia").glob("*.toml")} == set(INERTIA)
    for name, test in ELSEWHERE.items():
        text = (EXAMPLES.parent / test).read_text(encoding="utf-8")
        assert name in text or name == "recordings"


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("plane", "damping", "put_in"), [("vertical", "Z_w", -190.0), ("horizontal", "Y_v", -120.0)]
)
def test_a_campaign_gives_the_damping_that_was_put_in(
    tmp_path: Path, plane: str, damping: str, put_in: float
) -> None:
    campaign = EXAMPLES / plane / "campaign.toml"
    out = str(tmp_path / "out")
    made = CliRunner().invoke(cli, ["simulate", str(campaign), "--output", out])
    assert made.exit_code == 0, made.stderr
    analysed = json.loads(CliRunner().invoke(cli, ["analyse", out, "--json"]).stdout)
    assert analysed["failed"] == analysed["campaigns"] == []
    found = CliRunner().invoke(cli, ["coefficients", out, "--json"])
    rows = json.loads(found.stdout)["coefficients"]["table"]
    values = [row["value"] for row in rows if (row["name"], row["method"]) == (damping, "linear")]
    assert values
    assert values == pytest.approx([put_in] * len(values), rel=5e-3)


@pytest.mark.slow
def test_the_model_sinks_and_trims_as_the_example_says(tmp_path: Path) -> None:
    campaign, out = EXAMPLES / "attitude" / "campaign.toml", str(tmp_path / "squat")
    made = CliRunner().invoke(cli, ["simulate", str(campaign), "--output", out])
    assert made.exit_code == 0, made.stderr
    ran = CliRunner().invoke(cli, ["coefficients", out, "--json"])
    rows = {row["run"]: row for row in json.loads(ran.stdout)["attitude"]}
    put_in = tomllib.loads(campaign.read_text(encoding="utf-8"))["squat"]
    drift = math.radians(8.0)
    for run, along, across in (
        ("tow-0.8", 0.8, 0.0),
        ("tow-1.2", 1.2, 0.0),
        ("drift-1.2-8", 1.2 * math.cos(drift), 1.2 * math.sin(drift)),
        ("sway-0.25", 1.2, 0.2 * 2.0 * math.pi * 0.25 / math.sqrt(2.0)),
    ):
        for key, letter in (("sinkage", "z"), ("trim", "theta")):
            expected = put_in[f"{letter}_uu"] * along**2 + put_in[f"{letter}_vv"] * across**2
            one = rows[run][key]
            assert abs(one["mean"] - expected) < 4.0 * one["mean_u"], (run, key)
            assert one["mean_u"] < 2e-5
    second = put_in["z_vv"] * (0.2 * 2.0 * math.pi * 0.25) ** 2 / 2.0
    assert rows["sway-0.25"]["sinkage"]["amplitude"][1] == pytest.approx(second, rel=0.02)
    assert len(rows) == 5


@pytest.mark.slow
def test_led_struts_give_what_was_put_in_and_tell_how_they_followed(tmp_path: Path) -> None:
    own = EXAMPLES / "paths"
    for name in ("rig.toml", "simulated.toml"):
        shutil.copy(own / name, tmp_path)
    text = (own / "plan.toml").read_text(encoding="utf-8")
    quick = text.replace("\nperiods = 3", "\nperiods = 1").replace("[0.05, 0.1]", "[0.4]")
    plan, out = tmp_path / "plan.toml", str(tmp_path / "out")
    plan.write_text(quick, encoding="utf-8")
    only = [word for one in ("sway", "yaw") for word in ("--only", f"{one}-f0.4-a150")]
    made = CliRunner().invoke(cli, ["run", str(plan), "--output", out, *only])
    assert made.exit_code == 0, made.stderr
    found = json.loads(CliRunner().invoke(cli, ["coefficients", out, "--json"]).stdout)
    values = {row["name"]: row["value"] for row in found["recommended"]}
    damping = tomllib.loads((own / "rig.toml").read_text())["hull"]["damping"]
    assert values["Y_v"] == pytest.approx(-damping[0][0], rel=5e-3)
    assert len(found["following"]) == 4
    for row in found["following"]:
        # docs/paths.md: 3 millionths and 0.0006 degrees at 0.2 Hz; both grow with its third power.
        assert abs(row["amplitude_relative"]) < 8.0 * 6e-6
        assert abs(row["phase_rad"]) < 8.0 * 2e-5
        assert 0.0 < row["rms"] < row["peak"] < 1e-4
    shares = {line["source"] for one in found["budgets"] for line in one["lines"]}
    assert {"amplitude", "phase setting"} <= shares


@pytest.mark.sample(2)
@pytest.mark.parametrize("name", INERTIA)
def test_an_inertia_file_gives_its_numbers(name: str) -> None:
    path = EXAMPLES / "inertia" / f"{name}.toml"
    done = CliRunner().invoke(cli, ["inertia", INERTIA[name], str(path), "--json"])
    assert done.exit_code == 0, done.stderr
    document = json.loads(done.stdout)
    assert document["results"] or document["placements"]


def test_the_light_gates_give_the_period_of_the_recipe() -> None:
    path = EXAMPLES / "inertia" / "gates.toml"
    done = CliRunner().invoke(cli, ["inertia", "pendulum", str(path), "--json"])
    (found,) = json.loads(done.stdout)["periods"]
    assert [run for runs in found["runs_s"] for run in runs] == pytest.approx(
        [1.5252] * 3, rel=1e-5
    )
