"""A model that is free to roll in every run: simulated, recorded, and told by the command.

The oracle is the linear answer of the roll to sway and yaw, worked out on complex numbers here: at
each frequency the model is one that has no heel, with other derivatives.
"""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from hardware.description.errors import ConfigurationError
from hardware.description.setpoint import Medium, SetPoint
from pmm.campaign.campaign_file import read_campaign
from pmm.cli import cli
from sim.periodic import steady_state
from sim.solve.period import Period

SPEED_M_S, HERTZ, HALF_M, GRAVITY = 1.2, 0.15, 0.8, 9.80665
MASS, YAW, ROLL, GM_M = 170.0, 120.0, 4.6, 0.02  # kg, kg m2, kg m2, m
ADDED = np.array([[150.0, 26.0], [26.0, 110.0]])
DAMPING = np.array([[85.0, -60.0], [100.0, 200.0]])
HEEL = {"Y_uuphi": -12.0, "N_uuphi": -9.0, "K_uuphi": -0.45, "K_v": 7.8, "K_r": -5.7, "K_p": -3.0,
        "K_vdot": 6.0, "K_pdot": -0.9, "N_p": 2.0}  # fmt: skip
DRIFTS_DEG = (-4.0, -2.0, 0.0, 2.0, 4.0)
MOTIONS = {"sway": (60.0, 0.0), "yaw": (60.0, 64.28), "mixed": (80.0, 30.0)}
RUN = 'zero_before = "rest"\ncarriage_speed_m_s = 1.2\n'
FILE = f"""\
name = "free"
[oscillator]
preset = "horizontal-1963"
half_spacing_m = {HALF_M}
[model]
mass_kg = {MASS}
inertia_kg_m2 = {YAW}
[heel]
held = "free"
inertia_kg_m2 = {ROLL}
gm_m = {GM_M}
[hull]
added_mass = {ADDED.tolist()}
damping = {DAMPING.tolist()}
[heel_loads]
{"".join(f"{name} = {value}" + chr(10) for name, value in HEEL.items())}
[acquisition]
displacement_aft = {{ noise_rms = 1e-5 }}
displacement_fore = {{ noise_rms = 1e-5 }}
force_aft = {{ noise_rms = 0.01 }}
force_fore = {{ noise_rms = 0.01 }}
heel_angle = {{ noise_rms = 1e-5, offset = 0.01 }}
[simulation]
sample_rate_hz = 20.0
[[at_rest]]
name = "rest"
file = "rest.nc"
kind = "zero"
duration_s = 30.0
number = 1
""" + "".join(
    f'[[at_rest]]\nname = "tow{drift:g}"\nfile = "tow{drift:g}.nc"\n{RUN}drift_deg = {drift}\n'
    f'number = {k}\nduration_s = 30.0\nkind = "{"static-drift" if drift else "straight-tow"}"\n'
    for k, drift in enumerate(DRIFTS_DEG, 2)
) + "".join(
    f'[[runs]]\nname = "{name}"\nfrequency_hz = {HERTZ}\neccentricity_mm = {size}\n'
    f"strut_phase_deg = {phase}\nperiods = 6\nnumber = {k}\n{RUN}"
    for k, (name, (size, phase)) in enumerate(MOTIONS.items(), 7)
)  # fmt: skip


def heel_by(hertz: float) -> np.ndarray:
    """Heel per v and per r, rad s/m and s, of one frequency."""
    rate = 2j * math.pi * hertz
    drives = np.array([HEEL["K_v"] + rate * HEEL["K_vdot"], HEEL["K_r"]])
    rights = MASS * GRAVITY * GM_M - HEEL["K_uuphi"] * SPEED_M_S**2
    inertia = ROLL - HEEL["K_pdot"]
    return np.asarray(drives / (rights - rate * HEEL["K_p"] + rate**2 * inertia))


def derivatives(hertz: float) -> np.ndarray:
    """Load per v and r of the model that heels, rows Y and N: in phase and by the rate."""
    rate = 2j * math.pi * hertz
    by_heel = np.array([HEEL["Y_uuphi"], HEEL["N_uuphi"]]) * SPEED_M_S**2
    by_heel = by_heel + rate * np.array([0.0, HEEL["N_p"]])
    return np.asarray(-DAMPING - rate * ADDED + np.outer(by_heel, heel_by(hertz)))


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    place = tmp_path_factory.mktemp("free")
    (place / "made.toml").write_text(FILE, encoding="utf-8")
    for command in (
        ["simulate", str(place / "made.toml"), "--output", str(place / "free")],
        ["coefficients", str(place / "free"), "--json"],
    ):
        ran = CliRunner().invoke(cli, command)
        assert ran.exit_code == 0, ran.output
    return dict(json.loads(ran.stdout))


@pytest.mark.slow
def test_each_run_heels_as_its_motion_asks(found: dict[str, Any]) -> None:
    rows = {row["run"]: row for row in found["heel"]}
    assert {row["held"] for row in rows.values()} == {"free"}
    for drift in DRIFTS_DEG:
        v = -SPEED_M_S * math.sin(math.radians(drift))
        heel = rows[f"tow{drift:g}"]["heel"]["mean"]
        assert heel == pytest.approx(float(heel_by(0.0)[0].real) * v, rel=0.01, abs=2e-5)
    assert abs(rows["tow4"]["heel"]["mean"]) > math.radians(1.0)


def test_the_derivatives_are_those_of_a_ship_that_heels(found: dict[str, Any]) -> None:
    for hertz, method in ((0.0, "static drift"), (HERTZ, "")):
        told, rate = derivatives(hertz), 2.0 * math.pi * hertz
        for row, load in enumerate("YN"):
            for column, motion in enumerate("vr" if hertz else "v"):
                names = {f"{load}_{motion}": told[row, column].real}
                if hertz:
                    names[f"{load}_{motion}dot"] = told[row, column].imag / rate
                for name, value in names.items():
                    ones = [
                        one
                        for one in found["coefficients"]["table"]
                        if one["name"] == name
                        and one["frequency_hz"] == pytest.approx(hertz)
                        and method in one["method"]
                        and one["method"] != "quasi-steady"
                    ]
                    assert ones, name
                    for one in ones:
                        allowed = 2.0 * one["half_width"] + 0.01 * abs(value)
                        assert one["value"] == pytest.approx(value, abs=allowed), one


def test_heel_changes_them(found: dict[str, Any]) -> None:
    """What the oracle says is far from the upright model, or the tests above could not fail."""
    upright = -DAMPING - 2j * math.pi * HERTZ * ADDED
    assert np.abs(derivatives(HERTZ) / upright - 1.0)[:, 0].min() > 0.03
    (row,) = [one for one in found["recommended"] if one["name"] == "N_v"]
    assert abs(row["value"] + DAMPING[1, 0]) > 5.0 * row["half_width"]


@pytest.mark.slow
def test_a_model_that_nothing_rights_is_refused(tmp_path: Path) -> None:
    """In air, its centre of gravity on the roll axis; below it, it hangs and swings."""
    (tmp_path / "made.toml").write_text(FILE, encoding="utf-8")
    rig = read_campaign(tmp_path / "made.toml").rig()
    hanging = replace(rig, body=replace(rig.body, cg_z_m=0.02))
    in_air = SetPoint(HERTZ, 0.06, 0.0, medium=Medium.AIR)
    with pytest.raises(ConfigurationError, match="free to roll, and nothing rights it: it takes a"):
        rig.chain(in_air)
    state = steady_state(hanging.chain(in_air), Period(HERTZ, 8, 64))
    assert np.isfinite(state.spectra["heel_angle"]).all()
