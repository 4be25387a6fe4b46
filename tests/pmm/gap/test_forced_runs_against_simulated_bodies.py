"""``pmm gap pendulum`` on runs under a known force: the example, and what is refused."""

import json
import runpy
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from pmm.cli import cli
from tests.pmm.gap.pendulum_problem import load_problem

FOLDER = Path(__file__).parents[3] / "examples" / "afloat"
BODY = """
name = "waves"
[floating]
inertia = 50.0
added_inertia = 1.0
restoring = 1000.0
"""
RUN = """
[[forced]]
name = "{name}"
force = {{ record = "{name}.csv", channel = "{force}" }}
measured = [{{ record = "{name}.csv", channel = "heave" }}]
"""
WAVES = """
[over_frequency]
frequency_hz = [0.4, 0.8]
added_inertia = [30.0, 10.0]
damping = [40.0, 80.0]
force = [1200.0, 800.0]
force_phase_rad = [0.4, -0.4]
"""


def run(*arguments: str | Path) -> Result:
    return CliRunner().invoke(cli, ["gap", *map(str, arguments)])


@pytest.mark.slow
def test_friction_of_the_examples_guide_is_found_and_added(tmp_path: Path) -> None:
    text = (FOLDER / "heave.toml").read_text().replace('record = "', f'record = "{FOLDER}/')
    path = tmp_path / "heave.toml"
    head, *runs = text.split("[[forced]]")  # three runs and one sensor are enough here
    heave = [one for one in "[[forced]]".join([head, *runs[2:]]).splitlines() if "accel" not in one]
    path.write_text("\n".join(heave))
    names = ("--effects", "bearing_friction,sensor_delay", "--most", "1")
    found = json.loads(run("pendulum", path, *names, "--json").stdout)
    assert found["best"] == ["bearing_friction"]
    zone = found["parameters"]["bearing_friction"]["dead_zone"]["value"]
    made = runpy.run_path(str(FOLDER / "make.py"))
    assert zone == pytest.approx(made["FRICTION_N"] / 1000.0, rel=0.01)
    assert [one["kind"] for one in found["where"]][:2] == ["amplitude", "phase"]
    assert found["withheld"][0]["name"] == "each run"
    assert run("add-pendulum", path, "bearing_friction").exit_code == 0
    problem = load_problem(path)
    assert np.sqrt(np.mean(problem.residual**2)) < 1.5


def test_the_examples_record_is_what_its_script_makes() -> None:
    made = runpy.run_path(str(FOLDER / "make.py"))["rows"](4)
    kept = np.loadtxt(FOLDER / "run-5.csv.gz", delimiter=",", skiprows=1)
    np.testing.assert_allclose(made, kept, atol=6e-4)


def recorded(
    folder: Path, name: str, frequency_hz: float, scale: float = 1.0, late_s: float = 0.0
) -> None:
    """Write a wave and the heave of a body whose impedance and transfer are those of WAVES."""
    share = (frequency_hz - 0.4) / 0.4
    added, damping, size, phase = (
        a + share * (b - a) for a, b in ((30, 10), (40, 80), (1200, 800), (0.4, -0.4))
    )
    omega, time_s = 2.0 * np.pi * frequency_hz, np.arange(0.0, 40.0, 0.05)
    wave = 0.02 * np.exp(1j * (omega * time_s + 0.7))
    heave = wave * size * np.exp(1j * phase)
    heave *= scale * np.exp(-1j * omega * late_s)
    heave = heave / (1000.0 - omega**2 * (50.0 + added) + 1j * omega * damping)
    noise = np.random.default_rng(3).normal(0.0, 1e-6, (2, time_s.size))
    rows = np.column_stack((time_s, wave.real + noise[0], heave.real + noise[1]))
    header = "time_s,wave [m],heave [m]"
    np.savetxt(folder / f"{name}.csv", rows, delimiter=",", header=header, comments="")


def test_waves_are_forces_by_their_transfer_at_the_runs_frequency(tmp_path: Path) -> None:
    path = tmp_path / "waves.toml"
    path.write_text(BODY + WAVES + RUN.format(name="a", force="wave"))
    recorded(tmp_path, "a", 0.55)
    problem = load_problem(path)
    left = problem.observed - problem.nominal
    assert np.abs(left).max() < 1e-3
    assert set(problem.kind) == {0, 1}  # the third harmonic of the force is not known


def test_a_force_that_is_not_steady_in_the_gate_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "waves.toml"
    path.write_text(BODY + WAVES + RUN.format(name="a", force="wave"))
    recorded(tmp_path, "a", 0.55)
    rows = np.loadtxt(tmp_path / "a.csv", delimiter=",", skiprows=1)
    rows[:, 1] *= np.clip(rows[:, 0] / 20.0, 0.2, 1.0)
    header = "time_s,wave [m],heave [m]"
    np.savetxt(tmp_path / "a.csv", rows, delimiter=",", header=header, comments="")
    done = run("pendulum", path)
    assert done.exit_code == 1
    assert "state from_s and to_s where it is steady" in " ".join(done.stderr.split())
    path.write_text(path.read_text() + "from_s = 21.0\n")
    assert set(load_problem(path).kind) == {0, 1}


COMPARED = """
[[effects]]
name = "sensor_delay"
parameters = {{ delay_s = 0.045, channel = "{channel}" }}
[[effects]]
name = "sensor_gain"
parameters = {{ gain_error = 0.02, channel = "{channel}" }}
"""


def test_what_a_comparison_told_of_a_sensor_stands_in_the_simulation(tmp_path: Path) -> None:
    path = tmp_path / "waves.toml"
    recorded(tmp_path, "a", 0.55, scale=1.02, late_s=0.045)
    text = BODY + WAVES + RUN.format(name="a", force="wave")
    path.write_text(text)
    assert np.abs(load_problem(path).residual).max() > 50.0
    path.write_text(text + COMPARED.format(channel="heave"))
    problem = load_problem(path)
    assert np.abs(problem.observed - problem.nominal).max() < 1e-3
    path.write_text(text + COMPARED.format(channel="camera"))
    done = run("pendulum", path)
    assert done.exit_code == 2
    assert "for a channel that no record has (channels: heave)" in " ".join(done.stderr.split())


@pytest.mark.parametrize(
    ("frequency_hz", "table", "scale", "said"),
    [
        (0.9, WAVES, 1.0, "ends at 0.4 and 0.8 Hz, and a run is at 0.9 Hz"),
        (0.6, WAVES, 1e3, "is its inertia, its restoring or the force in other units?"),
        (0.6, WAVES, 57.3, "is its inertia, its restoring or the force in other units?"),
        (0.6, WAVES.replace("force_phase_rad", "# "), 1.0, "force and force_phase_rad go together"),
        (0.6, WAVES.replace("[0.4, 0.8]", "[0.8, 0.4]"), 1.0, "frequency_hz has to rise"),
    ],
)
def test_runs_that_cannot_be_the_bodys_are_refused(
    tmp_path: Path, frequency_hz: float, table: str, scale: float, said: str
) -> None:
    path = tmp_path / "waves.toml"
    path.write_text(BODY + table + RUN.format(name="a", force="wave"))
    recorded(tmp_path, "a", frequency_hz, scale)
    done = run("pendulum", path)
    assert done.exit_code in (1, 2)
    assert said in " ".join(done.stderr.split())
