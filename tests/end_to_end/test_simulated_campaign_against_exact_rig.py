"""The whole way: a campaign is simulated and analysed; the harmonics are those of theory.

The phasors are those of an exact rig with its own equations of motion, apart from the simulator.
"""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result

from hardware.description.oscillator import Plane
from pmm.cli import cli
from tests.exact.hull import Loads, Motion, polynomial
from tests.exact.rig import ExactBody, ExactRig
from tests.exact.run import cycle

SHIPPED = Path(__file__).parents[2] / "examples"
NOISE = "noise_rms = 0.05, resolution = 0.0152587890625, full_scale = 500.0"
DRIFT = ", drift_per_s = 0.004"

Phasor = complex  # S + iC of S sin(theta) + C cos(theta)


def run(*arguments: str | Path) -> Result:
    return CliRunner().invoke(cli, [str(one) for one in arguments], catch_exceptions=False)


TERMS = {
    "Z_wdot": -75.0, "Z_qdot": -3.0, "Z_w": -190.0, "Z_q": -12.0,
    "M_wdot": -3.0, "M_qdot": -22.0, "M_w": -12.0, "M_q": -55.0,
}  # fmt: skip
BODY = ExactBody(70.0, 27.5, -0.02, 0.02, displaced_kg=70.0, buoyancy_x_m=-0.02)


def hull(motion: Motion) -> Loads:
    """Loads of the vertical example's water, restoring included."""
    ahead, down, bow_up = polynomial(TERMS)(motion)
    z, pitch = motion["z"], motion["theta"]
    return ahead, down - 6900.0 * z - 345.0 * pitch, bow_up - 345.0 * z - 2400.0 * pitch


def strut_forces(
    frequency_hz: float, eccentricity_m: float, phase_rad: float, speed_m_s: float
) -> dict[str, list[Phasor]]:
    """Harmonics 1 to 3 of the forces of the struts on the model, by an exact rig."""
    struts = eccentricity_m * np.exp([0.0, 1j * phase_rad])
    rig = ExactRig(
        np.array([[0.0, 0.0], struts]), frequency_hz, speed_m_s, 0.0, Plane.VERTICAL, 0.5,
        body=BODY, hull=hull,
    )  # fmt: skip
    found = cycle(rig, 3, tared=True)[1:]
    return {"force_aft": list(found[:, 0]), "force_fore": list(found[:, 1])}


def analysed(folder: Path, *options: str) -> list[dict[str, Any]]:
    done = run("analyse", folder, "--json", *options)
    assert done.exit_code == 0, done.stderr
    assert done.stderr == ""
    runs: list[dict[str, Any]] = json.loads(done.stdout)["runs"]
    return runs


def expected(rows: dict[str, Any]) -> dict[str, list[Phasor]]:
    kind, frequency = rows["run"].split("-")
    return strut_forces(float(frequency), 0.020, math.pi if kind == "pitch" else 0.0, 1.2)


def channel(rows: dict[str, Any], name: str) -> dict[str, Any]:
    (found,) = (one for one in rows["gates"][0]["channels"] if one["name"] == name)
    return dict(found)


@pytest.mark.slow
def test_without_noise_the_forces_are_those_of_theory(tmp_path: Path) -> None:
    text = (SHIPPED / "vertical" / "campaign.toml").read_text(encoding="utf-8")
    assert text.count(NOISE) == 2
    assert text.count(DRIFT) == 1
    file = tmp_path / "perfect.toml"
    file.write_text(text.replace(NOISE, "").replace(DRIFT, ""), encoding="utf-8")
    assert run("simulate", file, "--output", tmp_path / "runs").exit_code == 0
    runs = analysed(tmp_path / "runs")
    assert len(runs) == 6
    for rows in runs:
        for name, forces in expected(rows).items():
            for one, force in zip(channel(rows, name)["harmonics"], forces, strict=True):
                found = complex(one["in_phase"]["value"], one["quadrature"]["value"])
                assert found == pytest.approx(force, abs=1e-8 * abs(forces[0]))


@pytest.mark.slow
def test_with_noise_theory_lies_within_the_intervals(tmp_path: Path) -> None:
    assert (
        run("simulate", SHIPPED / "vertical" / "campaign.toml", "--output", tmp_path).exit_code == 0
    )
    misses = []
    for rows in analysed(tmp_path):
        for name, (force, *_) in expected(rows).items():
            first = channel(rows, name)["harmonics"][0]
            for part, value in (("in_phase", force.real), ("quadrature", force.imag)):
                miss = abs(first[part]["value"] - value)
                misses.append(miss / first[part]["half_width"])
                assert miss < 0.02  # newtons: 0.05 rms of noise, thousands of samples
    assert len(misses) == 24
    assert sum(miss > 1.0 for miss in misses) <= 4
    assert max(misses) < 3.0


def test_the_drift_that_was_put_in_is_taken_out(tmp_path: Path) -> None:
    arguments = ("simulate", SHIPPED / "vertical" / "campaign.toml", "--run", "heave-0.50")
    assert run(*arguments, "--output", tmp_path).exit_code == 0
    file = tmp_path / "heave-0.50.nc"
    (rows,) = analysed(file)
    assert channel(rows, "force_aft")["drift_per_s"] == pytest.approx(0.004, abs=2e-4)
    (left_in,) = analysed(file, "--no-drift")
    assert channel(left_in, "force_aft")["drift_per_s"] == 0.0


def test_a_wider_level_widens_the_intervals(tmp_path: Path) -> None:
    arguments = ("simulate", SHIPPED / "horizontal" / "campaign.toml", "--run", "sway-0.20")
    assert run(*arguments, "--output", tmp_path).exit_code == 0
    file = tmp_path / "sway-0.20.nc"
    narrow, wide = (
        channel(analysed(file, "--level", level)[0], "force_aft")["mean"]["half_width"]
        for level in ("0.68", "0.99")
    )
    assert wide > 2.0 * narrow


def test_gates_of_one_period_each(tmp_path: Path) -> None:
    arguments = ("simulate", SHIPPED / "horizontal" / "campaign.toml", "--run", "sway-0.20")
    assert run(*arguments, "--output", tmp_path).exit_code == 0
    (rows,) = analysed(tmp_path / "sway-0.20.nc", "--gate", "1", "--harmonics", "2")
    assert [gate["periods"] for gate in rows["gates"]] == [1] * 6
    assert len(rows["gates"][0]["channels"][0]["harmonics"]) == 2
    assert rows["gates"][0]["interval_source"] == "scatter between the periods around the gate"
