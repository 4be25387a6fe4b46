"""The coefficients of ``pmm gap`` are those that ``pmm coefficients`` prints for the campaign."""

import json
import math
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.pmm.gap.rigs import run
from tests.sim.manoeuvring import Derivatives, PrimeSystem, from_added_mass_and_damping

EXAMPLES = Path(__file__).parents[3] / "examples"
FEW = ("--effects", "coulomb-friction,gauge-hysteresis,amplifier-lag")
KEPT = ("heave-0.50-20", "pitch-0.50-20", "heave-1.10-20", "pitch-1.10-20")
SPEED_M_S, LENGTH_M, DENSITY_KG_M3 = 1.2, 2.5, 998.8
MORE = """
[[runs]]
name = "sway-0.40"
frequency_hz = 0.4
eccentricity_mm = 60.0
carriage_speed_m_s = 1.2
periods = 6

[[runs]]
name = "yaw-0.40"
frequency_hz = 0.4
eccentricity_mm = 60.0
strut_phase_deg = 180.0
carriage_speed_m_s = 1.2
periods = 6
"""
SHIP = f"[ship]\nlength_m = {LENGTH_M}\n"
SETTINGS = {
    "manoeuvring": "",
    "prime": f'system = "prime"\n{SHIP}',
    "seakeeping": f'form = "seakeeping"\nsystem = "seakeeping"\npoint_ahead_m = -0.3\n{SHIP}',
}
Told = dict[str, dict[str, Any]]


def vertical(_: Path) -> str:
    head, *runs = (EXAMPLES / "gap" / "campaign.toml").read_text().split("[[runs]]")
    return "[[runs]]".join([head, *(one for one in runs if any(name in one for name in KEPT))])


def horizontal(_: Path) -> str:
    return (EXAMPLES / "horizontal" / "campaign.toml").read_text() + MORE


def forgetful(omega: Any) -> Any:
    """Return added mass (kg) and damping (N s/m) of a water that forgets as an oscillator does."""
    memory = 150j * omega / (5.0**2 - omega**2 + 4j * omega)
    return 20.0 + memory.imag / omega, memory.real


def with_memory(folder: Path) -> str:
    omega = np.linspace(0.5, 20.0, 80)
    rows = zip(omega, *forgetful(omega), strict=True)
    head = "omega_rad_s,a33_analytic_kg,b33_analytic_kg_s\n"
    table = folder / "heave.csv"
    table.write_text(head + "".join(f"{w},{a},{b}\n" for w, a, b in rows))
    return vertical(folder).replace("[hull]", f'[radiation]\nfile = "{table}"\n\n[hull]')


PLANS = {one.__name__: one for one in (vertical, horizontal, with_memory)}


@pytest.fixture(scope="module", params=PLANS)
def told(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Told:
    """Both commands' documents, for each of the settings, of a rig that is as it is described."""
    folder = tmp_path_factory.mktemp(request.param)
    (folder / "plan.toml").write_text(PLANS[request.param](folder))
    rig = folder / "rig"
    done = run("simulate", folder / "plan.toml", "--output", rig)
    assert done.exit_code == 0, done.output
    found: Told = {"plan": tomllib.loads((folder / "plan.toml").read_text())}
    for name, text in SETTINGS.items():
        (rig / "coefficients.toml").write_text(text)
        gap, command = run("gap", rig, *FEW, "--json"), run("coefficients", rig, "--json")
        assert gap.exit_code == command.exit_code == 0, gap.output + command.output
        found[name] = {
            "gap": json.loads(gap.stdout),
            "command": json.loads(command.stdout)["coefficients"],
        }
    return found


def at_each(both: dict[str, Any]) -> list[tuple[dict[str, Any], dict[str, Any]]]:
    """Return each of the command's linear values, and the row of the gap that is about it."""
    rows = both["gap"]["coefficients"]
    return [
        (entry, row)
        for entry in both["command"]["table"]
        if entry["method"] == "linear"
        for row in rows
        if row["name"] == entry["name"]
        and row["frequency_hz"] in (None, pytest.approx(entry["frequency_hz"], rel=1e-3))
    ]


@pytest.mark.slow
@pytest.mark.parametrize("settings", SETTINGS)
def test_names_units_form_point_and_system_are_the_commands(told: Told, settings: str) -> None:
    both = told[settings]
    convention, command = both["gap"]["convention"], both["command"]
    for key in ("form", "plane", "normalisation"):
        assert convention[key] == command[key]
    assert convention["point_ahead_m"] == (-0.3 if settings == "seakeeping" else 0.0)
    pairs = at_each(both)
    linear = [one for one in command["table"] if one["method"] == "linear"]
    assert len(pairs) == len(linear) == 16
    assert all(row["unit"] == entry["unit"] for entry, row in pairs)


@pytest.mark.slow
@pytest.mark.parametrize("settings", SETTINGS)
def test_both_find_the_same_and_no_bias_where_nothing_is_missing(told: Told, settings: str) -> None:
    assert told[settings]["gap"]["verdict"] == "none"
    for entry, row in at_each(told[settings]):
        u = math.hypot(row["u_without"], entry["standard_uncertainty"])
        assert abs(row["without"] - entry["value"]) < 2.0 * u, (entry, row)
        assert abs(row["stated"] - entry["value"]) < 3.0 * u, (entry, row)
        assert row["with_effect"] is row["u_with"] is row["bias_u"] is None


@pytest.mark.slow
def test_stated_derivatives_are_those_that_the_simulator_was_given(told: Told) -> None:
    plan, memory = told["plan"], np.zeros((2, 2, 2))
    if "radiation" in plan:
        memory[:, 0, 0] = forgetful(2.0 * math.pi * 0.5)
    put_in = from_added_mass_and_damping(
        plan["hull"]["added_mass"] + memory[0], plan["hull"]["damping"] + memory[1]
    )
    prime = PrimeSystem.prime(LENGTH_M, DENSITY_KG_M3)
    in_si = prime.to_si(derivatives(told, "prime"), SPEED_M_S)
    for found in (derivatives(told, "manoeuvring"), in_si):
        close = 1e-3 if memory.any() else 1e-9  # a memory is fitted to its table
        np.testing.assert_allclose(found.acceleration, put_in.acceleration, close)
        np.testing.assert_allclose(found.velocity, put_in.velocity, close)


def test_settings_without_their_lengths_are_refused_at_once(tmp_path: Path) -> None:
    (tmp_path / "campaign.toml").write_text(vertical(tmp_path))
    (tmp_path / "coefficients.toml").write_text('system = "prime"\n')
    found = run("gap", tmp_path, *FEW)
    assert found.exit_code == 2
    assert "prime needs length_m" in found.stderr


def derivatives(told: Told, settings: str) -> Derivatives:
    """Return what is stated, by its names, at the lowest frequency."""
    rows = reversed(told[settings]["gap"]["coefficients"])
    stated = {one["name"]: one["stated"] for one in rows}
    loads, velocities = ("ZM", "wq") if "Z_w" in stated else ("YN", "vr")

    def matrix(dot: str) -> Any:
        return tuple(tuple(stated[f"{load}_{one}{dot}"] for one in velocities) for load in loads)

    return Derivatives(matrix("dot"), matrix(""))
