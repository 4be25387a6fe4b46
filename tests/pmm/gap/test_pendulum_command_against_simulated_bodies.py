"""``pmm gap pendulum`` on records of simulated bodies: table, document, figures."""

import json
import re
import runpy
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from pmm.cli import cli
from pmm.gap.pendulum_document import SCHEMA
from sim.pendulum.bench import PendulumBench
from sim.pendulum.benches import compound_bench, decay_bench
from sim.pendulum.effects import make_effect
from sim.pendulum.floating import Floating
from sim.pendulum.pivot import Pendulum, RigidPart
from sim.pendulum.record import record

HOUSE = Path(__file__).parents[3]
LOSS = 0.3  # of the amplitude a cycle over its square, 1/rad
AFLOAT = Floating(inertia=100.0, added_inertia=20.0, restoring=800.0)
ON_EDGE = Pendulum((RigidPart(20.0, 0.6, 1.5), RigidPart(70.0, 0.9, 12.0)))
FILE = """
name = "decay"
[measured]
record = "decay.csv"
channel = "{channel}"
[tolerances]
inertia = 1e-3
restoring = 1e-3
"""
FLOATING = """
[floating]
inertia = 100.0
added_inertia = 20.0
restoring = 800.0
"""
PIVOT = """
[[pivot.parts]]
mass_kg = 20.0
lever_m = 0.6
inertia_kg_m2 = 1.5
[[pivot.parts]]
mass_kg = 70.0
lever_m = 0.9
inertia_kg_m2 = 12.0
"""


def recorded(folder: Path, bench: PendulumBench, channel: str, table: str) -> Path:
    """Write a record with drag and a little noise, and the file that names it."""
    damped = bench.with_effects([make_effect("quadratic_drag", loss=LOSS)])
    run = record(damped, duration_s=36.0, sample_rate_hz=25.0, seed=1).dataset
    noise = np.random.default_rng(7).normal(0.0, 1e-4, run.sizes["time"])
    rows = np.column_stack((run["time"].values, run[channel].values + noise))
    header = f"time_s,{channel}"
    np.savetxt(folder / "decay.csv", rows, delimiter=",", header=header, comments="")
    path = folder / "decay.toml"
    path.write_text(FILE.format(channel=channel) + table)
    return path


def run(*arguments: str | Path) -> Result:
    return CliRunner().invoke(cli, ["gap", "pendulum", *map(str, arguments)])


@pytest.mark.slow
def test_drag_on_a_knife_edge_is_named_in_the_document(tmp_path: Path) -> None:
    path = recorded(tmp_path, compound_bench(ON_EDGE, release_rad=0.2), "angle", PIVOT)
    done = run(path, "--most", "1", "--json")
    assert done.exit_code == 0, done.output
    found = json.loads(done.stdout)
    assert found["schema"] == SCHEMA
    assert found["best"] == ["quadratic_drag"]
    loss = found["parameters"]["quadratic_drag"]["loss"]
    assert abs(loss["value"] - LOSS) < max(4.0 * loss["uncertainty"], 0.01 * LOSS)
    assert found["laws"][0]["withheld_u"]
    assert all(one["foretold"][0]["shrinkage"] > 0.9 for one in found["withheld"])


@pytest.mark.slow
def test_drag_of_a_body_afloat_in_the_table_and_the_figure(tmp_path: Path) -> None:
    path = recorded(tmp_path, decay_bench(AFLOAT, release=0.2), "roll", FLOATING)
    done = run(path, "--most", "1", "--plot", tmp_path / "figures")
    assert done.exit_code == 0, done.output
    first = done.stdout.splitlines()[0]
    assert first.startswith("decay: The cause: ")
    assert "what it was not fitted to" in first
    for heading in ("answer", "where", "law of damping", "withheld: small swings", "told apart"):
        assert heading in done.stdout
    (figure,) = (tmp_path / "figures").iterdir()
    assert figure.read_text().count("<svg") == 1


@pytest.mark.slow
def test_the_page_stands_alone(tmp_path: Path) -> None:
    path, page = HOUSE / "examples" / "decay" / "roll.toml", tmp_path / "gap.html"
    done = run(path, "--effects", "quadratic_drag,inertia", "--page", page)
    assert done.exit_code == 0, done.output
    told = page.read_text()
    for title in ("Where", "Which", "Laws of damping", "How far", "Records", "What remains"):
        assert f">{title}</h2>" in told
    assert done.stdout.splitlines()[0].removeprefix("roll: ") in told
    assert told.count("<svg") == 4
    assert not re.findall(r'(?:src|href)="(?!#)', told)
    assert "<script" not in told


def test_the_examples_record_is_what_its_script_makes() -> None:
    folder = HOUSE / "examples" / "decay"
    made = runpy.run_path(str(folder / "make.py"))["rows"]()
    kept = np.loadtxt(folder / "roll.csv", delimiter=",", skiprows=1)
    np.testing.assert_allclose(made, kept, atol=2e-6)


@pytest.mark.slow
def test_a_law_that_is_told_needs_no_further_record() -> None:
    path = HOUSE / "examples" / "decay" / "roll.toml"
    found = json.loads(run(path, "--without", "power_drag", "--most", "1", "--json").stdout)
    assert found["said"][0] == (
        "The cause: quadratic_drag, which predicts 100 % of what it was not fitted to."
    )
    assert not found["next"]


@pytest.mark.slow
def test_what_would_tell_a_law_is_said(tmp_path: Path) -> None:
    path = recorded(tmp_path, decay_bench(AFLOAT, release=0.01), "roll", FLOATING)
    names = "quadratic_drag,viscous_damping,bearing_friction"
    found = json.loads(run(path, "--effects", names, "--most", "1", "--json").stdout)
    assert any("its law cannot be told" in one for one in found["said"])
    first = found["next"][0]
    assert f"would tell it: {first['what']}" in found["said"][-1]
    gains = [one["gain_ln_evidence"] for one in found["next"]]
    assert gains == sorted(gains, reverse=True)


def test_one_simulation_is_to_be_given(tmp_path: Path) -> None:
    path = tmp_path / "decay.toml"
    path.write_text(FILE.format(channel="roll") + FLOATING + PIVOT)
    done = run(path)
    assert done.exit_code == 2
    assert "or [floating], or [pivot]: give exactly one of them" in done.stderr


@pytest.mark.parametrize("example", ["decay/roll", "afloat/heave"])
@pytest.mark.parametrize("verb", [(), ("add",), ("diagnose",)])
def test_a_campaigns_command_names_the_pendulums(verb: tuple[str, ...], example: str) -> None:
    found = CliRunner().invoke(cli, ["gap", *verb, str(HOUSE / f"examples/{example}.toml")])
    assert found.exit_code == 2
    assert "no campaign: see pmm gap pendulum and pmm gap add-pendulum" in " ".join(
        found.output.split()
    )


@pytest.mark.parametrize(
    ("factor", "restoring", "said"),
    [
        (57.29578, "800.0", 'in degrees? Then write the unit in its heading: "roll [deg]"'),
        (1.0, "8.0", "is its inertia or restoring in other units?"),
    ],
)
def test_a_record_that_cannot_be_the_bodys_is_refused(
    tmp_path: Path, factor: float, restoring: str, said: str
) -> None:
    table = FLOATING.replace("800.0", restoring)
    path = recorded(tmp_path, decay_bench(AFLOAT, release=0.2), "roll", table)
    rows = np.loadtxt(tmp_path / "decay.csv", delimiter=",", skiprows=1)
    rows[:, 1] *= factor
    np.savetxt(tmp_path / "decay.csv", rows, delimiter=",", header="time_s,roll", comments="")
    done = run(path)
    assert done.exit_code == 1
    assert said in " ".join(done.stderr.split())


@pytest.mark.parametrize("unit", ["rad/s", "m/s2", "V"])
def test_a_decay_of_what_is_no_displacement_is_refused(tmp_path: Path, unit: str) -> None:
    """A rate gyro's record would be taken for an angle, and sizes come out wrong."""
    path = recorded(tmp_path, decay_bench(AFLOAT, release=0.2), "roll", FLOATING)
    text = (tmp_path / "decay.csv").read_text().replace("time_s,roll", f"time_s,roll [{unit}]")
    (tmp_path / "decay.csv").write_text(text)
    done = run(path)
    assert done.exit_code == 1
    assert f"channel 'roll' is in {unit}; a decay is compared as" in " ".join(done.stderr.split())


@pytest.mark.slow
def test_nothing_is_added_where_the_answer_is_unknown(tmp_path: Path) -> None:
    path = recorded(tmp_path, decay_bench(AFLOAT, release=0.2), "roll", FLOATING)
    before = path.read_text()
    words = ["gap", "add-pendulum", str(path), "--effects", "sensor_drift"]
    done = CliRunner().invoke(cli, words)
    assert done.exit_code == 1
    assert "nothing to add" in " ".join(done.stderr.split())
    assert path.read_text() == before
