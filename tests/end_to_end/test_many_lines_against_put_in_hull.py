"""Runs of eight lines, simulated and analysed by the commands, against the hull that was put in.

The simulator and the analysis share no equations. Two runs, in sway and in yaw, tell at each line
what takes two runs for each frequency with single sines.
"""

import json
import math

import numpy as np
import pytest
from click.testing import CliRunner

from analysis.response.multisine import multisine
from pmm.cli import cli
from pmm.toml_text import toml_value

BASE_HZ = 0.1
ORDERS = (3, 5, 7, 9, 11, 13, 15, 17)
HULL = {
    "Y_vdot": -62.0, "Y_v": -120.0, "N_vdot": -2.0, "N_v": -40.0,
    "Y_rdot": -2.0, "Y_r": 15.0, "N_rdot": -18.0, "N_r": -35.0,
}  # fmt: skip
HEAD = """
name = "lines"
[oscillator]
preset = "horizontal-1963"
[model]
mass_kg = 70.0
inertia_kg_m2 = 27.5
cg_x_m = -0.02
[hull]
added_mass = [[62.0, 2.0], [2.0, 18.0]]
damping = [[120.0, -15.0], [40.0, 35.0]]
[acquisition]
displacement_aft = { noise_rms = 2e-5 }
displacement_fore = { noise_rms = 2e-5 }
force_aft = { noise_rms = 0.05 }
force_fore = { noise_rms = 0.05 }
[simulation]
sample_rate_hz = 50.0
settling_periods = 1
"""


def run_table(name: str, strut_phase_rad: float) -> str:
    weights = 1.0 / np.array(ORDERS, dtype=float)
    lines = [
        {"order": one.order, "share": one.share, "phase_rad": one.phase_rad,
         "strut_phase_rad": one.strut_phase_rad}
        for one in multisine(ORDERS, weights, (strut_phase_rad,))
    ]  # fmt: skip
    return (
        f'\n[[runs]]\nname = "{name}"\nfrequency_hz = {BASE_HZ}\neccentricity_m = 0.06\n'
        f"periods = 6\nlines = {toml_value(lines)}\n"
    )


@pytest.fixture(scope="module")
def told(tmp_path_factory: pytest.TempPathFactory) -> dict:  # type: ignore[type-arg]
    folder = tmp_path_factory.mktemp("lines")
    file, made = folder / "campaign.toml", folder / "made"
    file.write_text(HEAD + run_table("sway", 0.0) + run_table("yaw", math.pi), encoding="utf-8")
    simulated = CliRunner().invoke(cli, ["simulate", str(file), "--output", str(made)])
    assert simulated.exit_code == 0, simulated.output
    shown = CliRunner().invoke(cli, ["coefficients", str(made), "--json"])
    assert shown.exit_code == 0, shown.output
    found: dict = json.loads(shown.stdout)  # type: ignore[type-arg]
    return found


def test_eight_coefficients_at_eight_frequencies(told: dict) -> None:  # type: ignore[type-arg]
    linear = [one for one in told["coefficients"]["table"] if one["method"] == "linear"]
    assert len(linear) == len(HULL) * len(ORDERS)
    off = []
    for one in linear:
        assert round(one["frequency_hz"] / BASE_HZ) in ORDERS
        off.append((one["value"] - HULL[one["name"]]) / one["half_width"])
    held = np.mean(np.abs(off) < 1.0)
    assert held > 0.85  # 95 % of 64, and three standard deviations
    assert np.abs(off).max() < 2.0


def test_runs_are_named_by_their_lines(told: dict) -> None:  # type: ignore[type-arg]
    names = {name for one in told["coefficients"]["table"] for name in one["runs"]}
    assert {"sway line 3", "yaw line 17"} <= names


def test_settled_runs_show_no_transient(told: dict) -> None:  # type: ignore[type-arg]
    assert '"transient"' not in json.dumps(told)


def test_recordings_fit_their_set_points(told: dict) -> None:  # type: ignore[type-arg]
    assert "set_point_differs" not in json.dumps(told)
