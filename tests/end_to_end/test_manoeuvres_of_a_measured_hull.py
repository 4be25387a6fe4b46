"""From a tank's files to turning circles: KVLCC2's published hull, moved by Newton's law.

The model's loads are the table's, of instantaneous velocities; its motion is that of struts in
exact geometry; gauges have noise and zeros. What its own derivatives make of the ship is what the
published ones make.
"""

import json
import math
import tomllib
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from pmm.cli import cli

EXAMPLE = Path(__file__).parents[2] / "examples" / "manoeuvre" / "kvlcc2.toml"
SHIP = tomllib.loads(EXAMPLE.read_text(encoding="utf-8"))
LENGTH_M, DRAUGHT_M = SHIP["ship"]["length_m"], SHIP["ship"]["draught_m"]
MASS_KG, CG_X_M = SHIP["ship"]["mass_kg"], SHIP["ship"]["cg_x_m"]
SPEED_M_S, HALF_M, DENSITY, RATE_HZ = SHIP["speed_m_s"], 1.5, 999.10, 20.0
NOISE_N, ZEROS_N, STEP_S = 0.5, (3.0, -5.0, 2.0), 1e-4
COLUMNS = "t [s],ya [mm],yf [mm],FA [N],FF [N],FX [N]"
HEAD = f"""
name = "KVLCC2 in a tank"
[water]
temperature_deg_c = 15.0
[oscillator]
preset = "horizontal-1963"
half_spacing_m = {HALF_M}
frequency_hz = {{ low = 0.01, high = 2.0 }}
eccentricity_m = {{ low = 0.0, high = 3.0 }}
force_per_strut_n = 20000.0
[model]
mass_kg = {MASS_KG}
inertia_kg_m2 = {SHIP["ship"]["inertia_kg_m2"]}
cg_x_m = {CG_X_M}
[columns]
time = "t [s]"
[columns.channels]
displacement_aft = "ya [mm]"
displacement_fore = "yf [mm]"
force_aft = "FA [N]"
force_fore = "FF [N]"
force_x = "FX [N]"
"""
AREA_M2 = LENGTH_M * DRAUGHT_M
VALUES: Mapping[str, float] = SHIP["hull"]["values"]
ADDED_KG = {
    name: -VALUES[name] * 0.5 * DENSITY * AREA_M2 * LENGTH_M for name in ("X_udot", "Y_vdot")
}
ADDED_KG_M2 = -VALUES["N_rdot"] * 0.5 * DENSITY * AREA_M2 * LENGTH_M**3


def of_hull(u: np.ndarray, v: np.ndarray, r: np.ndarray) -> dict[str, np.ndarray]:
    """Return X, Y and N of the published table, but for its accelerations."""
    speed = np.hypot(u, v)
    moves = {"u": u / speed, "v": v / speed, "r": r * LENGTH_M / speed}
    loads = {axis: np.zeros_like(speed) for axis in "XYN"}
    for name, value in VALUES.items():
        axis, factors = name.split("_")
        if "dot" not in factors:
            parts = [moves[factor] for factor in factors if factor != "0"]
            loads[axis] = loads[axis] + value * np.prod([np.ones_like(speed), *parts], axis=0)
    pressure = 0.5 * DENSITY * AREA_M2 * speed**2
    return {axis: of * pressure * (LENGTH_M if axis == "N" else 1.0) for axis, of in loads.items()}


def at_struts(x: np.ndarray, y: np.ndarray, n: np.ndarray, fore_m: np.ndarray) -> np.ndarray:
    """Return what gauges read that hold a force and a moment: aft, fore, ahead."""
    at_fore = (n + y * HALF_M) / (fore_m + HALF_M)
    return np.array([y - at_fore, at_fore, x])


def oscillating(
    frequency_hz: float, size_m: float, phase_rad: float, drift_rad: float
) -> np.ndarray:
    """Return time, displacements in mm and forces of six periods and a half."""
    time_s = np.arange(0.0, 6.4 / frequency_hz, 1.0 / RATE_HZ)

    def place(at_s: np.ndarray) -> np.ndarray:
        angle = 2.0 * math.pi * frequency_hz * at_s
        aft, fore = size_m * np.sin(angle), size_m * np.sin(angle + phase_rad)
        heading = np.arctan((fore - aft) / 2.0 / HALF_M)
        return np.array(
            [HALF_M * np.cos(heading), aft + HALF_M * np.sin(heading), heading, aft, fore]
        )

    here, after, before = (place(time_s + step) for step in (0.0, STEP_S, -STEP_S))
    rate, second = (after - before) / 2.0 / STEP_S, (after - 2.0 * here + before) / STEP_S**2
    cos, sin = np.cos(here[2]), np.sin(here[2])
    ahead = SPEED_M_S * math.cos(drift_rad) + rate[0]
    across = -SPEED_M_S * math.sin(drift_rad) + rate[1]
    u, v, r = ahead * cos + across * sin, across * cos - ahead * sin, rate[2]
    forward, sideways = second[0] * cos + second[1] * sin, second[1] * cos - second[0] * sin
    loads = of_hull(u, v, r)
    x = MASS_KG * (forward - CG_X_M * r**2) + ADDED_KG["X_udot"] * (forward + v * r) - loads["X"]
    y = MASS_KG * (sideways + CG_X_M * second[2]) - loads["Y"]
    y = y + ADDED_KG["Y_vdot"] * (sideways - u * r)
    inertia = SHIP["ship"]["inertia_kg_m2"] + ADDED_KG_M2
    n = inertia * second[2] + MASS_KG * CG_X_M * sideways - loads["N"]
    gauges = at_struts(x, y, n, 2.0 * HALF_M / cos - HALF_M)
    return np.array([time_s, 1e3 * here[3], 1e3 * here[4], *gauges])


def towed(drift_rad: float | None) -> np.ndarray:
    """Return a record of 40 s at a drift angle; at rest where there is none."""
    time_s, gauges = np.arange(0.0, 40.0, 1.0 / RATE_HZ), np.zeros(3)
    if drift_rad is not None:
        u, v = SPEED_M_S * math.cos(drift_rad), -SPEED_M_S * math.sin(drift_rad)
        loads = of_hull(*(np.array([each]) for each in (u, v, 0.0)))
        negative = (-loads[axis] for axis in "XYN")
        gauges = at_struts(*negative, np.array([HALF_M]))[:, 0]
    still = np.zeros((2, time_s.size))
    return np.array([time_s, *still, *(force + 0.0 * time_s for force in gauges)])


def written(folder: Path) -> Path:
    """Write the tank's files: drift tests, sway, yaw, and yaw with drift at two frequencies."""
    text, number = HEAD, 0

    def add(table: str, name: str, record: np.ndarray, more: str) -> str:
        nonlocal number
        number += 1
        spread = np.array([0.0, 0.02, 0.02, NOISE_N, NOISE_N, NOISE_N])[:, None]
        noise = spread * np.random.default_rng(number).standard_normal(record.shape)
        read = record + noise + np.array([0.0, 0.0, 0.0, *ZEROS_N])[:, None]
        np.savetxt(folder / f"{name}.csv", read.T, "%.5f", ",", header=COLUMNS, comments="")
        return f'\n[[{table}]]\nname = "{name}"\nfile = "{name}.csv"\nnumber = {number}\n{more}'

    zeros = 'zero_before = "z1"\nzero_after = "z2"\n'
    at_speed = f"carriage_speed_m_s = {SPEED_M_S}\n{zeros}"
    text += add("at_rest", "z1", towed(None), 'kind = "zero"\nduration_s = 40.0\n')
    for degrees in (-15, -10, -5, 0, 5, 10, 15):
        kind = "static-drift" if degrees else "straight-tow"
        more = f'kind = "{kind}"\nduration_s = 40.0\ndrift_deg = {degrees}\n{at_speed}'
        text += add("at_rest", f"drift{degrees}", towed(math.radians(degrees)), more)
    for frequency_hz in (0.04, 0.06):
        omega = 2.0 * math.pi * frequency_hz
        turned = 2.0 * math.atan(omega * HALF_M / SPEED_M_S)
        sizes = [math.tan(rate * SPEED_M_S / LENGTH_M / omega) * HALF_M / math.sin(turned / 2.0)
                 for rate in (0.15, 0.3, 0.45)]  # fmt: skip
        runs = [(part * SPEED_M_S / omega, 0.0, 0) for part in (0.05, 0.1, 0.15)]
        runs += [(size, turned, 0) for size in sizes]
        runs += [(sizes[-1], turned, degrees) for degrees in (-8, 8)]
        for size_m, phase_rad, degrees in runs:
            record = oscillating(frequency_hz, size_m, phase_rad, math.radians(degrees))
            more = (
                f"frequency_hz = {frequency_hz}\neccentricity_mm = {1e3 * size_m}\nperiods = 6\n"
                f"strut_phase_rad = {phase_rad}\ndrift_deg = {degrees}\n{at_speed}"
            )
            text += add("runs", f"run{number}", record, more)
    text += add("at_rest", "z2", towed(None), 'kind = "zero"\nduration_s = 40.0\n')
    (folder / "campaign.toml").write_text(text, encoding="utf-8")
    return folder


def told(*arguments: str) -> dict:
    done = CliRunner().invoke(cli, [*arguments, "--json"])
    assert done.exit_code == 0, done.output
    return dict(json.loads(done.stdout))


def circles(document: dict) -> dict[str, float]:
    """Return each quantity of the turning circles and zig-zags."""
    return {
        f"{row['manoeuvre']} {row['name']}": row["value"]
        for row in document["quantities"]
        if not row["manoeuvre"].startswith(("spiral", "straight"))
    }


@pytest.mark.sample(1)
def test_a_measured_hull_turns_as_the_published_one(tmp_path: Path) -> None:
    measured = told("coefficients", str(written(tmp_path)))
    (tmp_path / "found.json").write_text(json.dumps(measured), encoding="utf-8")
    text = EXAMPLE.read_text(encoding="utf-8")
    stated = text[text.index("[hull.values]") : text.index("[propeller]")]
    text = text.replace(stated, "").replace("# coefficients = ", "coefficients = ")
    ship = tmp_path / "ship.toml"
    ship.write_text(text.replace("coefficients.json", "found.json", 1), encoding="utf-8")
    own, published = (told("manoeuvre", str(one), "--trials", "20") for one in (ship, EXAMPLE))
    assert own["doubts"] == []
    expected = circles(published)
    for name, value in circles(own).items():
        assert value == pytest.approx(expected[name], rel=0.03), name
