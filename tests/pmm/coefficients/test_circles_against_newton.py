"""Recordings on a circle, made by Newton's law and a hull's known loads, to a campaign's table.

Nothing of the simulator is in them: gauges are the struts' shares of what a cloud of points takes
on its way and of what the water's coefficients give.
"""

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from pmm.cli import cli
from tests.analysis.coefficients.test_steady_turns_against_newton import PUT_IN, U_M_S, body, held

HALF_M, RATE_HZ, DURATION_S, NOISE_N, OFFSET_N = 0.5, 50.0, 8.0, 0.02, 3.0
RESISTANCE_N = 5.0
HEAD = """
name = "round"
[oscillator]
preset = "horizontal-1963"
[model]
mass_kg = {0.mass_kg}
inertia_kg_m2 = {0.inertia_kg_m2}
cg_x_m = {0.cg_x_m}
[columns]
time = "t"
[columns.channels]
force_aft = "aft:N"
force_fore = "fore:N"
force_x = "x:N"
turn_rate = "r:rad/s"
"""
ZERO = """
[[at_rest]]
name = "zero"
kind = "zero"
file = "zero.csv"
duration_s = 8.0
"""
RUN = """
[[at_rest]]
name = "{name}"
kind = "circle"
file = "{name}.csv"
duration_s = 8.0
carriage_speed_m_s = 1.0
turn_rate_rad_s = {asked}
drift_rad = {drift}
zero_before = "zero"
zero_after = "zero"
"""


def written(path: Path, loads: tuple[float, float, float], rate: float, seed: int) -> None:
    """Write the gauges of a force across, a moment and a force ahead, with their offsets."""
    force, moment, ahead = loads
    count = int(DURATION_S * RATE_HZ)
    noise = np.random.default_rng(seed).normal(0.0, NOISE_N, (3, count))
    aft, fore = 0.5 * (force - moment / HALF_M), 0.5 * (force + moment / HALF_M)
    gauges = np.array([[aft], [fore], [ahead]]) + OFFSET_N + noise
    table = np.column_stack([np.arange(count) / RATE_HZ, *gauges, np.full(count, rate)])
    np.savetxt(path, table, delimiter=",", header="t,aft,fore,x,r", comments="")


def campaign(folder: Path, rate_error: float) -> None:
    """Circles of an arm that turns faster than it was asked to, its radius right."""
    text = HEAD.format(body()) + ZERO
    written(folder / "zero.csv", (0.0, 0.0, 0.0), 0.0, 1)
    for k, (radius, drift, side) in enumerate(
        (radius, drift, side) for radius in (4.0, 9.0) for drift in (-0.08, 0.0, 0.1)
        for side in (1.0, -1.0)
    ):  # fmt: skip
        asked = side * U_M_S / radius
        rate = asked * (1.0 + rate_error)
        # The cloud goes round at U_M_S: at another rate its forces are those times the square.
        faster = (1.0 + rate_error) ** 2
        force, moment, ahead = (faster * one for one in held(radius, asked, drift))
        v = -U_M_S * (1.0 + rate_error) * np.sin(drift)
        force -= PUT_IN["Y_v"] * v + PUT_IN["Y_r"] * rate
        moment -= PUT_IN["N_v"] * v + PUT_IN["N_r"] * rate
        written(folder / f"c{k}.csv", (force, moment, ahead + RESISTANCE_N), rate, 10 + k)
        text += RUN.format(name=f"c{k}", asked=asked, drift=drift)
    (folder / "campaign.toml").write_text(text, encoding="utf-8")


def coefficients(folder: Path) -> dict:
    done = CliRunner().invoke(cli, ["coefficients", str(folder), "--json"])
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout)


def test_what_the_hull_was_given_comes_back_whatever_the_arm_did(tmp_path: Path) -> None:
    campaign(tmp_path, rate_error=0.03)
    document = coefficients(tmp_path)
    found = {one["name"]: one for one in document["recommended"]}
    for name, value in PUT_IN.items():
        assert found[name]["value"] == pytest.approx(value, rel=2e-3), name
        assert abs(found[name]["value"] - value) < 3.0 * found[name]["standard_uncertainty"]
    assert found["X_0"]["value"] == pytest.approx(-RESISTANCE_N, abs=0.03)
    circle = next(one for one in document["runs"] if one["name"] == "c0")
    assert circle["duration_s"] == pytest.approx(DURATION_S, abs=0.1)


@pytest.mark.slow
def test_radius_and_rate_have_their_lines_in_the_budget(tmp_path: Path) -> None:
    """By the difference that a slip as large makes, where the rate is read 1 % too large."""
    campaign(tmp_path, rate_error=0.0)
    plain = {one["name"]: one["value"] for one in coefficients(tmp_path)["recommended"]}
    slip = 0.01
    stated = f"[uncertainty]\nturn_rate_relative = {slip}\nturn_radius_m = 0.05\n"
    (tmp_path / "coefficients.toml").write_text(stated, encoding="utf-8")
    document = coefficients(tmp_path)
    lines = {
        one["name"]: {line["source"]: line["contribution"] for line in one["lines"]}
        for one in document["budgets"]
    }
    for file in tmp_path.glob("c*.csv"):
        table = np.loadtxt(file, delimiter=",", skiprows=1)
        table[:, -1] *= 1.0 + slip
        np.savetxt(file, table, delimiter=",", header="t,aft,fore,x,r", comments="")
    moved = {one["name"]: one["value"] for one in coefficients(tmp_path)["recommended"]}
    for name in PUT_IN:
        of_rate = lines[name].get("rate of turn on the circle", 0.0)
        assert of_rate == pytest.approx(abs(moved[name] - plain[name]), rel=0.03), name
    assert lines["Y_v"]["radius of the circle"] > 0.0


def test_a_rate_of_the_other_sign_is_told(tmp_path: Path) -> None:
    campaign(tmp_path, rate_error=0.0)
    path = tmp_path / "campaign.toml"
    path.write_text(path.read_text().replace('"r:rad/s"', '"-r:rad/s"'), encoding="utf-8")
    done = CliRunner().invoke(cli, ["coefficients", str(tmp_path)])
    assert done.exit_code == 1
    assert "correct the sign of the channel turn_rate" in done.output
