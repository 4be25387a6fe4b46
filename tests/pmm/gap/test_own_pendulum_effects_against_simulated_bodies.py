"""``pmm gap pendulum --effects``: the page's own effect on the record of a body that has it."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from pmm.cli import cli
from sim.pendulum.benches import decay_bench
from sim.pendulum.effects import make_effect, user_effects
from sim.pendulum.floating import Floating
from sim.pendulum.record import record
from sim.pendulum.resistance import Resistance

HOUSE = Path(__file__).parents[3]
ROLL = HOUSE / "examples" / "decay" / "roll.toml"
(EXAMPLE,) = re.findall(
    r"^```python\n(.*?)^```",
    (HOUSE / "docs" / "gap-pendulums.md").read_text(),
    flags=re.DOTALL | re.MULTILINE,
)
QUINTIC = -3.0
AFLOAT = Floating(100.0, 20.0, 800.0, Resistance(viscous=6.0))
FILE = """
name = "decay"
[measured]
record = "decay.csv"
channel = "roll"
[floating]
inertia = 100.0
added_inertia = 20.0
restoring = 800.0
resistance = { viscous = 6.0 }
"""


def run(*arguments: str | Path) -> Result:
    return CliRunner().invoke(cli, ["gap", "pendulum", *map(str, arguments)])


@pytest.fixture
def own(tmp_path: Path) -> Path:
    path = tmp_path / "quintic.py"
    path.write_text(EXAMPLE)
    return path


@pytest.mark.slow
def test_an_effect_of_ones_own_is_found_with_its_size(own: Path, tmp_path: Path) -> None:
    effect = make_effect("quintic_restoring", user_effects(own), quintic=QUINTIC)
    bench = decay_bench(AFLOAT, release=0.5).with_effects([effect])
    decay = record(bench, duration_s=40.0, sample_rate_hz=25.0, seed=1).dataset
    noise = np.random.default_rng(7).normal(0.0, 1e-4, decay.sizes["time"])
    rows = np.column_stack((decay["time"].values, decay["roll"].values + noise))
    np.savetxt(tmp_path / "decay.csv", rows, delimiter=",", header="time_s,roll", comments="")
    path = tmp_path / "decay.toml"
    path.write_text(FILE)
    names = "nonlinear_restoring,restoring,quadratic_drag"
    done = run(path, "--effects", f"{names},{own}", "--most", "1", "--json")
    assert done.exit_code == 0, done.output
    found = json.loads(done.stdout)
    assert found["best"] == ["quintic_restoring"]
    size = found["parameters"]["quintic_restoring"]["quintic"]
    assert abs(size["value"] - QUINTIC) < max(4.0 * size["uncertainty"], 2e-3 * abs(QUINTIC))
    assert run(path, "--effects", own, "--without", "inertia").exit_code == 0
    assert set(found["causes"]) <= {*names.split(","), "quintic_restoring"}


@pytest.mark.slow
def test_names_alone_restrict_and_what_a_record_cannot_show_is_said() -> None:
    done = run(ROLL, "--effects", "quadratic_drag", "--effects", "inertia,line_twist", "--json")
    assert done.exit_code == 0, done.output
    found = json.loads(done.stdout)
    assert set(found["causes"]) == {"quadratic_drag", "inertia"}
    assert found["notes"] == ["these records cannot show line_twist"]
    assert [law["name"] for law in found["laws"]] == ["quadratic"]
    assert found["said"][0] == (
        "The cause: quadratic_drag, which predicts 100 % of what it was not fitted to."
    )


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--effects", "quadratic_drg"], "'quadratic_drg'; did you mean quadratic_drag"),
        (["--without", "inertja"], "'inertja'; did you mean inertia"),
        (["--effects", "inertia", "--without", "inertia"], "leave no effect to consider"),
        (["--effects", "line_twist"], "these records cannot show line_twist"),
        (["--effects", "nowhere.py"], "nowhere.py: no Python file of effects"),
    ],
)
def test_wrong_requests_are_one_line(options: list[str], said: str) -> None:
    done = run(ROLL, *options)
    assert done.exit_code == 2
    (line,) = done.stderr.strip().splitlines()
    assert said in line


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("_, restoring = small", "_, restoring = 1 / 0, small", "of your own: ZeroDivisionError"),
        ("self.quintic * restoring", "float('nan')", "what it does to record roll is not a number"),
        ('"quintic_restoring"', '"inertia"', "inertia: the catalogue has an effect of that name"),
        ("    name = ", "    label = ", "defines no effect"),
    ],
)
def test_a_fault_in_ones_own_is_said(own: Path, old: str, new: str, said: str) -> None:
    own.write_text(EXAMPLE.replace(old, new))
    done = run(ROLL, "--effects", own)
    assert done.exit_code == 2
    assert said in done.stderr
