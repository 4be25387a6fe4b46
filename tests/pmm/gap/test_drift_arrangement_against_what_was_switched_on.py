"""A drift angle that was set in another way than is stated, from the command line: named, or not.

Runs that yaw to 22 degrees, with drifts of 8 degrees to either side and without.
"""

import json
import math
from pathlib import Path

import pytest
from click.testing import CliRunner

from pmm.cli import cli

CAMPAIGN = """
tared = true

[oscillator]
preset = "horizontal-1963"

[model]
mass_kg = 70.0
inertia_kg_m2 = 27.5
cg_x_m = -0.02

[hull]
added_mass = [[62.0, 2.0], [2.0, 18.0]]
damping = [[120.0, -15.0], [40.0, 35.0]]

[surge]
x_u = -1.5
x_uu = -8.0
x_vv = -60.0
x_vr = 45.0
x_rr = -8.0

[acquisition]
displacement_aft = { noise_rms = 2e-5 }
displacement_fore = { noise_rms = 2e-5 }
force_aft = { noise_rms = 0.05 }
force_fore = { noise_rms = 0.05 }
force_x = { noise_rms = 0.05 }

[simulation]
sample_rate_hz = 50.0
"""
RUN = """
[[runs]]
name = "{name}"
frequency_hz = {frequency_hz}
eccentricity_m = {eccentricity_m}
strut_phase_rad = {phase_rad}
carriage_speed_m_s = 1.2
drift_deg = {drift_deg}
periods = 8
"""
KEYS = ("name", "frequency_hz", "eccentricity_m", "phase_rad", "drift_deg")
RUNS = [
    ("yaw-starboard", 0.25, 0.2, math.pi, 8.0),
    ("yaw-port", 0.25, 0.2, math.pi, -8.0),
    ("yaw", 0.25, 0.2, math.pi, 0.0),
    ("small-yaw", 0.35, 0.08, math.pi, 8.0),
    ("sway-starboard", 0.25, 0.15, 0.0, 8.0),
    ("sway-port", 0.35, 0.1, 0.0, -8.0),
    ("sway", 0.3, 0.12, 0.0, 0.0),
    ("mixed", 0.3, 0.15, 1.8, 8.0),
]


# One of each stage, and those that act on runs in drift.
KNOWN = (
    "drift-arrangement,strut-phase-error,carriage-speed,quadratic-drift,damping-error,zero-offset,"
    "gain-error,coulomb-friction,speed-droop,amplifier-lag"
)


def told(*arguments: object) -> str:
    done = CliRunner().invoke(cli, [str(one) for one in arguments])
    assert done.exit_code == 0, done.output
    return done.output


@pytest.mark.slow
@pytest.mark.parametrize("effect", ["", "drift-arrangement:way=1", "drift-arrangement:way=2"])
def test_a_drift_that_was_set_otherwise_is_named(effect: str, tmp_path: Path) -> None:
    path = tmp_path / "campaign.toml"
    path.write_text(CAMPAIGN + "".join(RUN.format(**dict(zip(KEYS, r, strict=True))) for r in RUNS))
    on = ("--effect", effect) if effect else ()
    told("simulate", path, "--output", tmp_path / "rig", *on)
    found = json.loads(told("gap", tmp_path / "rig", "--effects", KNOWN, "--json"))
    if not effect:
        assert found["verdict"] == "none"
        return
    assert found["verdict"] == "effect"
    best = found["ranking"][0]["effects"][0]
    assert best["name"] == "drift-arrangement"
    assert f"way={best['parameters']['way']['value']:g}" in effect
    assert found["class_probability"] > 0.9
