"""Counted swings of a known amplitude give the gyradius of small ones."""

import json
import math
from pathlib import Path

import pytest
from click.testing import CliRunner

from pmm.cli import cli

GYRADIUS_M, DEPTH_M, GRAVITY = 0.35, 0.5, 9.81


def exact_period_s(amplitude_rad: float) -> float:
    """Of a compound pendulum, by the arithmetic and geometric mean."""
    small = 2.0 * math.pi * math.sqrt((GYRADIUS_M**2 + DEPTH_M**2) / (GRAVITY * DEPTH_M))
    a, b = 1.0, math.cos(0.5 * amplitude_rad)
    for _ in range(6):
        a, b = 0.5 * (a + b), math.sqrt(a * b)
    return small / a


@pytest.mark.parametrize("amplitude_deg", [0.5, 6.0, 15.0])
def test_a_stated_amplitude_is_taken_out(tmp_path: Path, amplitude_deg: float) -> None:
    duration_s = 50.0 * exact_period_s(math.radians(amplitude_deg))
    text = (
        f'gravity_m_s2 = {GRAVITY}\naxis = "pitch"\ndepth_m = {DEPTH_M}\nu_depth_m = 1e-4\n'
        "[model]\nmass_kg = 40.0\n[period]\nreaction_s = 0.01\n"
        f"stopwatch = [{{swings = 50, duration_s = {duration_s:.9f}}}]\n"
    )
    found = {}
    for name, more in (("told", f"amplitude_deg = {amplitude_deg}\n"), ("not", "")):
        path = tmp_path / f"{name}.toml"
        path.write_text(text + more, encoding="utf-8")
        done = CliRunner().invoke(cli, ["inertia", "pendulum", str(path), "--json"])
        assert done.exit_code == 0, done.output
        found[name] = json.loads(done.stdout)
    values = {name: one["results"]["k_pitch_m"]["value"] for name, one in found.items()}
    codes = {name: {flag["code"] for flag in one["flags"]} for name, one in found.items()}
    assert values["told"] == pytest.approx(GYRADIUS_M, rel=2e-6)
    assert values["not"] > values["told"]
    assert ("amplitude_unknown" in codes["told"], "amplitude_unknown" in codes["not"]) == (
        False,
        True,
    )
