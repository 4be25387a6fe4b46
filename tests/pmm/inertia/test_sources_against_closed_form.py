"""Periods from light gates, stopwatches and records, against the motions they were made of."""

from pathlib import Path

import numpy as np
import pytest

from analysis.inertia.double_pendulum import mode_periods
from pmm.inertia import bifilar, pendulum

G = 9.81
LINE_M, HALF_SPACING_M = 2.0, 0.5
SWAY_S = 2.0 * np.pi * np.sqrt(LINE_M / G)
YAW_S = 1.17 * SWAY_S
HEAD = """
gravity_m_s2 = 9.81
u_gravity_m_s2 = 0.0001
[[suspensions]]
half_spacing_m = 0.5
u_half_spacing_m = 1e-5
line_m = 2.0
u_line_m = 1e-5
"""


def crossings(values: np.ndarray, time_s: np.ndarray) -> np.ndarray:
    at = np.flatnonzero(np.signbit(values[1:]) != np.signbit(values[:-1]))
    step = values[at] / (values[at] - values[at + 1])
    return np.asarray(time_s[at] + step * (time_s[at + 1] - time_s[at]))


def gate_file(path: Path, sway: float, width: float = 0.02) -> None:
    """Write the edges of one gate that sees yaw with some sway."""
    t = np.arange(0.0, 400.0, 1e-3)
    y = np.exp(-t / 900.0) * np.cos(2.0 * np.pi * t / YAW_S)
    y += sway * np.exp(-t / 300.0) * np.cos(2.0 * np.pi * t / SWAY_S + 1.0)
    edges = np.sort(np.concatenate([crossings(y - side, t) for side in (-width, width)]))
    states = (np.arange(edges.size) + 1) % 2
    rows = [f"{a:.6f},{b}" for a, b in zip(edges, states, strict=True)]
    path.write_text("\n".join(["Time,State", *rows]) + "\n")


@pytest.mark.parametrize(("more", "within"), [("", 1e-3), ("remove_modulation = true", 2e-4)])
def test_one_gate_with_sway(more: str, within: float, tmp_path: Path) -> None:
    gate_file(tmp_path / "gate.csv", 0.02)
    source = f'[suspensions.yaw]\ngates = ["gate.csv"]\ngate_columns = ["State"]\n{more}\n'
    (tmp_path / "job.toml").write_text(HEAD + source)
    outcome = bifilar.run(str(tmp_path / "job.toml"))
    (runs,) = outcome.periods
    assert runs.period.value == pytest.approx(YAW_S, rel=within)
    assert abs(runs.period.value - YAW_S) < 3.0 * runs.period.uncertainty
    assert "single_run" in {flag.code for flag in outcome.flags}


def test_a_known_scatter_holds_for_a_stopwatch(tmp_path: Path) -> None:
    known = "known_scatter_s = 0.05\n"
    source = "[period]\nstopwatch = [{ swings = 50, duration_s = 100.0 }]\n"
    found = []
    for more in (known, ""):
        (tmp_path / "job.toml").write_text(f"gravity_m_s2 = {G}\n{source}{more}")
        found.append(pendulum.run(str(tmp_path / "job.toml")))
    assert [one.periods[0].period.uncertainty for one in found] == pytest.approx([0.05, 0.1 / 50.0])
    (observed,) = found[0].findings
    assert observed.what == "period as observed"  # damped, at its amplitude
    codes = [{flag.code for flag in one.flags} for one in found]
    assert ["single_run" in one for one in codes] == [False, True]


@pytest.mark.slow
def test_both_pitch_modes_of_one_record(tmp_path: Path) -> None:
    gyradius, depth = 1.0, 0.4
    slow_s, fast_s = mode_periods(gyradius, depth, LINE_M, G)
    generator = np.random.default_rng(11)
    for number in (1, 2, 3):
        t = np.arange(0.0, 160.0, 0.05)
        y = 40.0 * np.exp(-t / 300.0) * np.cos(2.0 * np.pi * t / slow_s + number)
        y += 15.0 * np.exp(-t / 200.0) * np.cos(2.0 * np.pi * t / fast_s)
        y += 0.05 * generator.standard_normal(t.size)
        rows = [f"{a:.2f},{b:.4f}" for a, b in zip(t, y, strict=True)]
        (tmp_path / f"{number}.csv").write_text("\n".join(["Time [s],Bow [mm]", *rows]) + "\n")
    source = '[suspensions.pitch]\nboth = { records = ["1.csv", "2.csv", "3.csv"] }\n'
    (tmp_path / "job.toml").write_text(HEAD + source)
    outcome = bifilar.run(str(tmp_path / "job.toml"))
    found = {one.name: one.estimate for one in outcome.findings}
    assert found["k_pitch_m"].value == pytest.approx(gyradius, rel=1e-3)
    assert found["depth_m"].value == pytest.approx(depth, abs=1e-3)
    assert outcome.plane == "vertical"
