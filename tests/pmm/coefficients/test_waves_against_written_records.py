"""Runs in waves whose gauges and probe this file writes, without the simulator, to their table.

The waves' frequency of encounter comes from bisection of the dispersion relation; the oscillation's
loads are those of a hull with known added mass and damping, the waves' those of known transfers.
"""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from hardware.description.waves import encounter_hz, wave_number
from pmm.cli import cli

GRAVITY, DEPTH_M, SPEED_M_S = 9.80665, 1.2, 0.9
MASS_KG, INERTIA, HALF_M = 70.0, 27.5, 0.5
ADDED, DAMPING = 62.0, 120.0
SHAFT_HZ, E_M, WAVE_HZ, WAVE_M = 0.21, 0.10, 0.55, 0.02
FIRST, LEAD = (300.0, -90.0, 55.0), (0.7, -1.1, 2.0)  # N/m, N m/m, N/m: across, about, ahead
MEAN, SECOND, SECOND_LEAD = (-2000.0, 400.0, -3000.0), (1500.0, 700.0, 900.0), 0.4
RATE_HZ, PERIODS, NOISE_N = 40.0, 14, 0.05
HEAD = f"""
name = "in waves"
tared = true
[oscillator]
preset = "horizontal-1963"
[model]
mass_kg = {MASS_KG}
inertia_kg_m2 = {INERTIA}
[water]
temperature_deg_c = 18.0
depth_m = {DEPTH_M}
[columns]
time = "t"
[columns.channels]
displacement_aft = "ya:m"
displacement_fore = "yf:m"
force_aft = "a:N"
force_fore = "f:N"
force_x = "x:N"
wave_probe = "w:m"
carriage_speed = "u:m/s"
[reference]
channel = "displacement_aft"
"""
RUN = """
[[runs]]
name = "{0}"
file = "{0}.csv"
motion = "sway"
frequency_hz = 0.21
eccentricity_mm = 100.0
carriage_speed_m_s = 0.9
periods = 12
"""
WAVES = "wave_frequency_hz = 0.55\nwave_amplitude_mm = 20.0\nwave_heading_deg = 180.0\n"


def bisected(depth_m: float) -> float:
    """Wave number by halving an interval, another way than Newton's."""
    low, high = 1e-6, 1e3
    omega = 2.0 * math.pi * WAVE_HZ
    for _ in range(200):
        middle = 0.5 * (low + high)
        if GRAVITY * middle * math.tanh(middle * depth_m) < omega**2:
            low = middle
        else:
            high = middle
    return low


@pytest.mark.parametrize("depth_m", [0.2, DEPTH_M, 30.0])
def test_wave_numbers_are_those_of_bisection_and_deep_water_is_their_limit(depth_m) -> None:
    assert wave_number(WAVE_HZ, depth_m) == pytest.approx(bisected(depth_m), rel=1e-10)
    assert wave_number(WAVE_HZ, 1e4) == pytest.approx(wave_number(WAVE_HZ, None), rel=1e-10)
    met = WAVE_HZ + bisected(depth_m) * SPEED_M_S / (2.0 * math.pi)
    assert encounter_hz(WAVE_HZ, SPEED_M_S, math.pi, depth_m) == pytest.approx(met, rel=1e-10)
    assert encounter_hz(WAVE_HZ, SPEED_M_S, 0.5 * math.pi, depth_m) == pytest.approx(WAVE_HZ)


def written(path: Path, wave_m: float, seed: int, met_hz: float, probe_sign: float = 1.0) -> None:
    """Write a sway oscillation with waves of an amplitude, 0 for calm water."""
    time = np.arange(0.0, (PERIODS + 2) / SHAFT_HZ, 1.0 / RATE_HZ)
    omega = 2.0 * math.pi * SHAFT_HZ
    y, v, a = (E_M * omega**n * np.sin(omega * time + 0.5 * n * math.pi) for n in range(3))
    phase = 2.0 * math.pi * met_hz * time + 0.3
    loads = np.stack([-ADDED * a - DAMPING * v, 0.0 * v, np.full_like(v, -5.0)])
    loads[0] += 4.0 * wave_m / WAVE_M * np.cos(omega * time + phase)  # at the sum
    for k in range(3):
        first = FIRST[k] * wave_m * np.cos(phase + LEAD[k])
        second = SECOND[k] * np.cos(2.0 * phase + SECOND_LEAD)
        loads[k] += first + wave_m**2 * (MEAN[k] + second)
    held = np.stack([MASS_KG * a, 0.0 * a, 0.0 * a]) - loads
    fore = 0.5 * (held[0] + held[1] / HALF_M)
    gauges = np.stack([held[0] - fore, fore, held[2]])
    gauges += NOISE_N * np.random.default_rng(seed).standard_normal(gauges.shape)
    probe = probe_sign * wave_m * np.cos(phase) + 1e-4 * np.sin(3.3 * time)
    columns = np.column_stack((time, y, y, *gauges, probe, np.full_like(time, SPEED_M_S)))
    np.savetxt(path, columns, "%.7g", ",", header="t,ya,yf,a,f,x,w,u", comments="")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    met_hz = WAVE_HZ + bisected(DEPTH_M) * SPEED_M_S / (2.0 * math.pi)
    written(tmp_path / "calm.csv", 0.0, 1, met_hz)
    written(tmp_path / "waves.csv", WAVE_M, 2, met_hz)
    text = HEAD + RUN.format("calm") + RUN.format("waves") + WAVES
    (tmp_path / "campaign.toml").write_text(text, encoding="utf-8")
    return tmp_path


def coefficients(folder: Path, *more: str, status: int = 0) -> dict:
    done = CliRunner().invoke(cli, ["coefficients", str(folder), "--json", *more])
    assert done.exit_code == status, done.output
    return json.loads(done.stdout)


def test_the_oscillation_keeps_its_coefficients_in_waves(folder: Path) -> None:
    found = coefficients(folder, "--leave-out", "calm")
    told = {one["name"]: one for one in found["recommended"]}
    for name, value in (("Y_vdot", -ADDED), ("Y_v", -DAMPING)):
        off = abs(told[name]["value"] - value)
        assert off < max(3.0 * told[name]["standard_uncertainty"], 2e-3 * abs(value)), name


def test_loads_of_the_waves_come_back_by_the_probe(folder: Path) -> None:
    rows = {(one["load"], one["line"]): one for one in coefficients(folder)["waves"]}
    for k, load in enumerate(("force", "moment", "surge")):
        first, twice, mean = (rows[load, line] for line in ("e", "2 e", "mean"))
        for row, value in ((first, FIRST[k]), (twice, SECOND[k])):
            assert row["value"] == pytest.approx(abs(value), abs=4.0 * row["value_u"])
            assert row["value_u"] < 0.05 * abs(value)
        lead = LEAD[k] + (math.pi if FIRST[k] < 0.0 else 0.0)
        assert math.remainder(first["lead_rad"] - lead, 2.0 * math.pi) == pytest.approx(
            0.0, abs=0.01
        )
        assert twice["lead_rad"] == pytest.approx(SECOND_LEAD, abs=0.2)
        assert mean["value"] == pytest.approx(MEAN[k], abs=4.0 * mean["value_u"])
    assert rows["force", "e + f"]["value"] == pytest.approx(4.0 / WAVE_M, rel=0.02)
    assert first["encounter_hz"] == pytest.approx(first["expected_hz"], rel=1e-4)
    assert first["amplitude_m"] == pytest.approx(WAVE_M, rel=1e-3)


def test_a_dropout_costs_nothing_and_half_a_record_is_refused(folder: Path) -> None:
    path = folder / "waves.csv"
    lines = path.read_text(encoding="utf-8").splitlines()
    for missing, status in ((40, 0), (1500, 1)):
        torn = [
            line.rsplit(",", 2)[0] + ",nan," + line.rsplit(",", 2)[2] if 900 < k < 900 + missing
            else line
            for k, line in enumerate(lines)
        ]  # fmt: skip
        path.write_text("\n".join(torn) + "\n", encoding="utf-8")
        document = coefficients(folder, status=status)
        if status:
            assert "% are needed to tell the waves" in document["failed"][0]["message"]
        else:
            row = next(one for one in document["waves"] if one["load"] == "force")
            assert row["value"] == pytest.approx(FIRST[0], abs=4.0 * row["value_u"])


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("wave_frequency_hz = 0.55", "wave_frequency_hz = 1.4", "the probe shows no wave within"),
        ('wave_probe = "w:m"\n', "", "has no channel wave_probe"),
    ],
)
def test_waves_that_are_not_there_are_told(folder: Path, old, new, told) -> None:
    path = folder / "campaign.toml"
    path.write_text(path.read_text().replace(old, new), encoding="utf-8")
    (failed,) = coefficients(folder, status=1)["failed"]
    assert failed["name"] == "waves"
    assert told in failed["message"]


def test_waves_on_a_harmonic_of_the_shaft_are_refused(folder: Path) -> None:
    written(folder / "waves.csv", WAVE_M, 2, 4.0 * SHAFT_HZ)
    path = folder / "campaign.toml"
    path.write_text(path.read_text().replace("0.55", "0.63"), encoding="utf-8")
    (failed,) = coefficients(folder, status=1)["failed"]
    assert "cannot be told from harmonic 4 of the shaft" in failed["message"]


def test_a_probe_in_another_unit_is_told(folder: Path) -> None:
    def flagged() -> bool:
        flags = [flag for run in coefficients(folder)["runs"] for flag in run["flags"]]
        return "wave_differs" in {flag["code"] for flag in flags}

    assert not flagged()
    path = folder / "waves.csv"
    head, *rows = path.read_text(encoding="utf-8").splitlines()
    values = np.array([[float(cell) for cell in row.split(",")] for row in rows])
    values[:, head.split(",").index("w")] *= 0.1  # centimetres for millimetres
    np.savetxt(path, values, "%.7g", ",", header=head, comments="")
    assert flagged()
