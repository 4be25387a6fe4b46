"""``pmm gap add-pendulum``: a cause is named, added to the file, and then there is no gap."""

import json
import shutil
import tomllib
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from pmm.cli import cli
from sim.pendulum.benches import bifilar_bench
from sim.pendulum.effects import make_effect
from sim.pendulum.effects.base import PendulumEffect
from sim.pendulum.record import record
from sim.pendulum.suspension import Suspension
from tests.pmm.gap.pendulum_problem import load_problem

HOUSE = Path(__file__).parents[3]
DECAY = HOUSE / "examples" / "decay"
LOSS = 0.3  # what the example's record has


FEW = ("--effects", "quadratic_drag,cubic_damping,inertia,sensor_gain", "--most", "1")


def run(job: str, *arguments: str | Path) -> Result:
    return CliRunner().invoke(cli, ["gap", job, *map(str, arguments)])


@pytest.fixture
def roll(tmp_path: Path) -> Path:
    for name in ("roll.toml", "roll.csv"):
        shutil.copy(DECAY / name, tmp_path)
    return tmp_path / "roll.toml"


@pytest.mark.slow
def test_the_cause_is_named_added_and_gone(roll: Path) -> None:
    before = run("pendulum", roll, *FEW)
    assert before.stdout.startswith("roll: The cause: ")
    assert "quadratic_drag: loss = " in before.stdout
    assert f"gap add-pendulum {roll} --most 1 --effects quadratic_drag" in before.stdout
    done = run("add-pendulum", roll, *FEW)
    assert done.exit_code == 0, done.output
    kept = roll.with_name("roll.toml.1").read_text()
    assert kept == (DECAY / "roll.toml").read_text()
    assert roll.read_text().startswith(kept)
    (added,) = tomllib.loads(roll.read_text())["effects"]
    assert added["name"] == "quadratic_drag"
    assert added["parameters"] == {"loss": pytest.approx(LOSS, rel=2e-3)}
    after = run("pendulum", roll, *FEW)
    assert after.stdout.startswith("roll: No gap: ")
    assert "NOTE    the simulation has quadratic_drag on" in after.stdout
    again = run("add-pendulum", roll, *FEW)
    assert again.exit_code == 1
    assert "No gap: " in again.stderr
    assert "nothing to add" in again.stderr
    twice = run("add-pendulum", roll, "quadratic_drag")
    assert twice.exit_code == 2
    assert "quadratic_drag is in [[effects]] already" in twice.stderr


@pytest.mark.slow
def test_a_named_cause_is_fitted_and_added(roll: Path) -> None:
    done = run("add-pendulum", roll, "viscous_damping", "quadratic_drag", "--json")
    assert done.exit_code == 0, done.output
    found = json.loads(done.stdout)
    assert [one["name"] for one in found["effects"]] == ["viscous_damping", "quadratic_drag"]
    assert tomllib.loads(roll.read_text())["effects"] == found["effects"]
    assert Path(found["kept"]).read_text() == (DECAY / "roll.toml").read_text()


@pytest.mark.parametrize(
    ("options", "status", "said"),
    [
        (["quadratic_drg"], 2, "'quadratic_drg'; did you mean quadratic_drag"),
        (["line_twist"], 1, "these records cannot show line_twist"),
        (["--effects", "sensor_gain"], 1, "nothing to add"),
    ],
)
def test_nothing_is_written_where_there_is_nothing(
    roll: Path, options: list[str], status: int, said: str
) -> None:
    done = run("add-pendulum", roll, *options)
    assert done.exit_code == status, done.output
    assert said in done.stderr
    assert [one.name for one in roll.parent.iterdir() if "toml" in one.name] == ["roll.toml"]


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ('name = "quadratic_drg"', "did you mean quadratic_drag"),
        ('name = "quadratic_drag"\nparameters = { los = 1.0 }', "no parameter 'los'"),
        ('name = "quadratic_drag"\nparameters = { loss = "much" }', "loss = 'much' is no number"),
        ('name = "quadratic_drag"\nparameters = { loss = 99.0 }', "plausible range"),
        ('nam = "quadratic_drag"', "name"),
    ],
)
def test_errors_of_an_effect_in_the_file_are_said(roll: Path, table: str, said: str) -> None:
    roll.write_text(f"{roll.read_text()}\n[[effects]]\n{table}\n")
    done = run("pendulum", roll)
    assert done.exit_code == 2
    assert said in done.stderr


PLACES = ((0.2, 0.6), (0.3, 0.8), (0.5, 0.5), (0.5, 1.2))
EXCESS_M = 0.014


def suspended(folder: Path, *effects: PendulumEffect) -> Path:
    """Write the gates' edges of one rod on several suspensions, and the file that names them."""
    k, tables = 0.34, ['name = "rod"\ngyradius_m = 0.34\ngravity_m_s2 = 9.81\nswings = 40\n']
    jitter = make_effect("gate_jitter", jitter_rms_s=1e-4)
    for seed, (half, line) in enumerate(PLACES):
        body = Suspension(1.0, line, half, 0.03, k, k, 0.03, linear=True, gravity_m_s2=9.81)
        bench = bifilar_bench(body, yaw_rad=0.1).with_effects([*effects, jitter])
        run = record(bench, duration_s=150.0, sample_rate_hz=100.0, seed=seed)
        run.write_gates(folder / f"{seed}.csv")
        tables.append(
            f'[[suspensions]]\nname = "{seed}"\ngates = "{seed}.csv"\n'
            f"half_spacing_m = {half}\nline_m = {line}\n"
        )
    tables.append("[tolerances]\ninertia = 0.02\nline_excess = 3e-4\nspacing = 1e-4\n")
    path = folder / "rod.toml"
    path.write_text("".join(tables))
    return path


ASKED = ("--effects", "line_excess,clamp_mass,spacing,line_twist", "--most", "2")


@pytest.mark.slow
def test_longer_lines_of_a_rod_are_named_added_and_gone(tmp_path: Path) -> None:
    damped = make_effect("viscous_damping", damping_ratio=1e-3, coordinate="yaw")
    path = suspended(tmp_path, make_effect("line_excess", excess_m=EXCESS_M), damped)
    done = run("add-pendulum", path, *ASKED)
    assert done.exit_code == 0, done.output
    (added,) = tomllib.loads(path.read_text())["effects"]
    assert added["name"] == "line_excess"
    assert added["parameters"]["excess_m"] == pytest.approx(EXCESS_M, rel=0.1)
    assert run("pendulum", path, *ASKED).stdout.startswith(f"{path.stem}: No gap: ")


@pytest.mark.slow
def test_an_effect_in_the_file_is_the_body_stated_so(tmp_path: Path) -> None:
    path = suspended(tmp_path)
    stated = path.read_text()
    path.write_text(
        f'{stated}\n[[effects]]\nname = "line_excess"\nparameters = {{ excess_m = 0.02 }}\n'
    )
    told = load_problem(path)
    for half, line in PLACES:
        here = f"half_spacing_m = {half}\nline_m = "
        stated = stated.replace(f"{here}{line}\n", f"{here}{line + 0.02}\n")
    path.write_text(stated)
    np.testing.assert_allclose(told.nominal, load_problem(path).nominal, atol=1e-6)
