"""Two lines by records with a gap, and by methods that agree or not."""

import math
from pathlib import Path

import numpy as np
import pytest

from pmm.inertia import bifilar
from pmm.inertia.model_file import model_section
from pmm.report.inertia_record import residual_on_grid

G, LINE_M, HALF_M, GYRADIUS_M = 9.81, 2.0, 0.5, 0.62
SWAY_S = 2.0 * math.pi * math.sqrt(LINE_M / G)
YAW_S = SWAY_S * GYRADIUS_M / HALF_M

HEAD = f"""
gravity_m_s2 = {G}
u_gravity_m_s2 = 0.0005
[model]
mass_kg = 80.0
u_mass_kg = 0.05
cg_x_m = 0.01
u_cg_x_m = 0.001
cg_z_m = 0.02
u_cg_z_m = 0.001
[[suspensions]]
name = "hull"
half_spacing_m = {HALF_M}
u_half_spacing_m = 0.0005
line_m = {LINE_M}
u_line_m = 0.001
"""


def record(folder: Path, number: int) -> str:
    """Write a release in which the sensor was blind for three swings and for one sample."""
    t = np.arange(0.0, 120.0, 0.05)
    period = YAW_S * (1.0 + 1e-5 * number)
    y = 0.1 * np.exp(-0.004 * t) * np.cos(2.0 * np.pi * t / period)
    y += 1e-5 * np.random.default_rng(number).standard_normal(t.size)
    blind = (t > 40.0) & (t < 40.0 + 3.0 * YAW_S)
    rows = [f"{a:.3f},{b:.7f}" for a, b in zip(t[~blind], y[~blind], strict=True)]
    rows[100] = rows[100].partition(",")[0] + ","
    (folder / f"run-{number}.csv").write_text("\n".join(["Time [s],Bow [m]", *rows]) + "\n")
    return f"run-{number}.csv"


def test_a_gap_is_left_out_and_does_not_void_the_model(tmp_path: Path) -> None:
    names = [record(tmp_path, number) for number in (1, 2, 3)]
    path = tmp_path / "job.toml"
    path.write_text(HEAD + f"yaw = {{ records = {names} }}\n".replace("'", '"'))
    outcome = bifilar.run(str(path))
    found = {one.name: one.estimate for one in outcome.findings}
    assert found["k_yaw_m"].value == pytest.approx(GYRADIUS_M, rel=5e-5)
    assert not outcome.said_no
    assert "mass_kg = 80" in model_section(outcome)
    (runs,) = outcome.periods
    rest = residual_on_grid(runs.records[0])
    assert rest.size == runs.records[0].part.series.values.size
    assert np.isnan(rest).sum() == pytest.approx(60.0 * YAW_S, abs=2)  # drawn where it was blind
    gaps = [flag.message for flag in outcome.flags if flag.code == "gaps"]
    assert len(gaps) == 3
    assert "the longest gap is 3 periods (limit 0.5)" in gaps[0]


def beaten(folder: Path, oscillations: float) -> set[str]:
    path = folder / "job.toml"
    yaw = f"yaw = {{ period_s = {YAW_S}, u_period_s = 0.001 }}\n"
    beats = f"beats = {{ oscillations = {oscillations}, beats = 6, counting_error = 0.1 }}\n"
    path.write_text(HEAD + yaw + beats)
    return {flag.code for flag in bifilar.run(str(path)).flags}


def test_methods_that_differ_are_told(tmp_path: Path) -> None:
    # the mean oscillation's frequency over the beats' (half the sum, and the difference)
    per_beat = 0.5 * (1.0 / SWAY_S + 1.0 / YAW_S) / (1.0 / SWAY_S - 1.0 / YAW_S)
    assert "data_disagree" not in beaten(tmp_path, 6.0 * per_beat)
    assert "data_disagree" in beaten(tmp_path, 6.0 * per_beat + 2.0)


@pytest.mark.parametrize("off", [0.0, 0.01])
def test_methods_that_differ_widen_the_chosen_one(tmp_path: Path, off: float) -> None:
    """By hand: period and ratio share yaw period and spacing, and differ by the rest."""
    path = tmp_path / "job.toml"
    yaw = f"yaw = {{ period_s = {YAW_S}, u_period_s = 0.001 }}\n"
    sway = f"sway = {{ period_s = {SWAY_S * (1.0 + off)}, u_period_s = {2e-4 * SWAY_S} }}\n"
    path.write_text('method = "period"\n' + HEAD + yaw + sway)
    outcome = bifilar.run(str(path))
    found = {one.name: one for one in outcome.findings}
    line, gravity = 0.5 * 0.001 / LINE_M, 0.5 * 0.0005 / G
    apart = (off / (1.0 + off)) / math.sqrt(line**2 + gravity**2 + 2e-4**2)
    alone, chosen = found["k_yaw_by_period_m"], found["k_yaw_m"]
    stated = GYRADIUS_M * math.hypot(line, gravity, 0.001 / YAW_S, 0.0005 / HALF_M)
    assert alone.estimate.uncertainty == pytest.approx(stated, rel=1e-6)
    assert chosen.estimate.value == pytest.approx(GYRADIUS_M, rel=1e-9)
    assert chosen.estimate.uncertainty == pytest.approx(max(apart, 1.0) * stated, rel=0.01)
    assert (chosen.assessment is None) == (apart > 1.0)
    told = [flag.message for flag in outcome.flags if flag.code == "data_disagree"]
    assert [message.endswith("and count (beats)") for message in told] == [True] * (apart > 1.0)
