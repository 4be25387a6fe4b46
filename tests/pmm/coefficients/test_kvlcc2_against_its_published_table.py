"""KVLCC2's published derivatives, at the amplitudes of its own tests, come back as printed.

Once through the simulator, recordings and the command; once through the exact rig's turntable,
which shares no line with either. Yaw goes to 27 degrees, with drift to 16 degrees.
"""

import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.campaign_nonlinear import (
    FIRST_HARMONICS,
    HIGHER_ORDER,
    QUASI,
    STATIC_DRIFT,
    SURGE_FORCES,
)
from analysis.coefficients.cycle_fit import fit_cycles
from analysis.readers import from_dataset, write_recording
from hardware.description.body import Body
from hardware.description.oscillator import Oscillator, Plane, Range
from hardware.description.setpoint import SetPoint
from sim.acquisition.channels import Digitiser
from sim.model.water.force_laws import SurgeForces
from sim.rig import SimulatedRig
from sim.run import simulate
from tests.analysis.coefficients import kvlcc2
from tests.analysis.coefficients.exact_campaigns import cycle_of
from tests.analysis.coefficients.test_nonlinear_against_put_in_values import put_in_prime
from tests.pmm.coefficients.test_command_against_put_in_values import done

OSCILLATOR = Oscillator(
    plane=Plane.HORIZONTAL,
    half_spacing_m=1.0,
    frequency_hz=Range(0.01, 2.0),
    eccentricity_m=Range(0.0, 2.5),
    force_per_strut_n=1e4,
)
HEAD = f"""name = "kvlcc2"
tared = true

[oscillator]
plane = "horizontal"
half_spacing_m = {OSCILLATOR.half_spacing_m}
frequency_hz = {{ low = 0.01, high = 2.0 }}
eccentricity_m = {{ low = 0.0, high = 2.5 }}
force_per_strut_n = 1e4

[model]
mass_kg = {kvlcc2.MASS_KG}
inertia_kg_m2 = {kvlcc2.INERTIA_KG_M2}
cg_x_m = {kvlcc2.CG_X_M}
"""
RUN = """
[[runs]]
name = "{name}"
frequency_hz = {point.frequency_hz}
eccentricity_m = {point.eccentricity_m}
strut_phase_rad = {point.strut_phase_rad}
carriage_speed_m_s = {point.carriage_speed_m_s}
drift_rad = {point.drift_rad}
"""
TOW = """
[[at_rest]]
name = "{name}"
kind = "static-drift"
file = "{name}.nc"
duration_s = 100.0
carriage_speed_m_s = {point.carriage_speed_m_s}
drift_rad = {point.drift_rad}
"""
SETTINGS = f"""system = "mmg"
[ship]
length_m = {kvlcc2.LENGTH_M}
draught_m = {kvlcc2.DRAUGHT_M}
density_kg_m3 = {kvlcc2.DENSITY_KG_M3}
"""


def struts_rig() -> SimulatedRig:
    """The simulator's own: its surge force is quadratic, with neither X_0 nor X_vvvv."""
    along = {
        name.lower(): kvlcc2.in_si(name, kvlcc2.DERIVATIVES[name])
        for name in ("X_vv", "X_vr", "X_rr")
    }
    across = {name: one for name, one in kvlcc2.DERIVATIVES.items() if name[0] in "YN"}
    rig = put_in_prime(across, kvlcc2.SYSTEM.term_factor)
    return replace(
        rig,
        oscillator=OSCILLATOR,
        body=Body(kvlcc2.MASS_KG, kvlcc2.INERTIA_KG_M2, kvlcc2.CG_X_M, 0.0),
        surge=SurgeForces(**along),
        acquisition=replace(rig.acquisition, force_x=Digitiser()),
    )


def set_points() -> Iterator[tuple[str, str, SetPoint]]:
    """Name, table and set-point of each run."""
    speed = kvlcc2.SPEED_M_S
    for drift in (-kvlcc2.DRIFTS_RAD[2], -kvlcc2.DRIFTS_RAD[4], *kvlcc2.DRIFTS_RAD):
        point = SetPoint(kvlcc2.YAW_HZ, 0.0, 0.0, speed, drift_rad=drift)
        yield f"drift{drift:+.2f}", TOW, point
    for amplitude in kvlcc2.SWAY_M:
        yield f"sway-{amplitude}", RUN, SetPoint(kvlcc2.SWAY_HZ, amplitude, 0.0, speed)
    turning = 2.0 * math.pi * kvlcc2.YAW_HZ * OSCILLATOR.half_spacing_m / speed
    phase = 2.0 * math.atan(turning)  # v = 0
    for amplitude in kvlcc2.YAW_M:
        point = SetPoint(kvlcc2.YAW_HZ, amplitude / math.cos(phase / 2.0), phase, speed)
        for drift in kvlcc2.DRIFTS_RAD:
            yield f"yaw-{amplitude}{drift:+.2f}", RUN, replace(point, drift_rad=drift)


@pytest.mark.slow
def test_through_simulator_and_command(tmp_path: Path) -> None:
    rig, text = struts_rig(), HEAD
    for name, table, point in set_points():
        made = simulate(
            rig, point, periods=3, settling_periods=1, sample_rate_hz=10.0, seed=1, name=name
        )
        write_recording(from_dataset(made), tmp_path / f"{name}.nc")
        text += table.format(name=name, point=point)
    (tmp_path / "campaign.toml").write_text(text)
    (tmp_path / "coefficients.toml").write_text(SETTINGS)
    found = done(tmp_path)["coefficients"]
    assert {one["verdict"] for one in found["choices"]} == {"cubic"}
    expected = {**kvlcc2.DERIVATIVES, "X_0": 0.0}
    told: dict[str, set[str]] = {}
    for row in found["table"]:
        if row["method"] in (HIGHER_ORDER, FIRST_HARMONICS, QUASI, STATIC_DRIFT, SURGE_FORCES):
            off = abs(row["value"] - expected.get(row["name"], 0.0))
            assert off < kvlcc2.ROUNDING.get(row["name"], 5e-4), row
            told.setdefault(row["method"], set()).add(row["name"])
    assert told[HIGHER_ORDER] >= {name for name in kvlcc2.PRINTED if name[0] in "YN"}
    assert told[SURGE_FORCES] == {"X_0", "X_vv", "X_vr", "X_rr"}
    assert told[STATIC_DRIFT] >= {"Y_v", "Y_vvv", "N_v", "N_vvv"}


@pytest.fixture(scope="module")
def cycles() -> list[BodyCycle]:
    table = kvlcc2.turntable
    rigs = {f"sway {a}": table(a, kvlcc2.SWAY_HZ, 0.0, yaws=False) for a in kvlcc2.SWAY_M}
    for drift in kvlcc2.DRIFTS_RAD:
        rigs[f"drift {drift}"] = table(0.0, kvlcc2.YAW_HZ, drift, yaws=False)
        for a in kvlcc2.YAW_M:
            rigs[f"yaw {a}, {drift}"] = table(a, kvlcc2.YAW_HZ, drift, yaws=True)
    return [cycle_of(rig, name, 7) for name, rig in rigs.items()]


@pytest.mark.parametrize("load", ["X", "Y", "N"])
def test_by_the_exact_rigs_turntable(cycles: list[BodyCycle], load: str) -> None:
    names = [name for name in kvlcc2.PRINTED if name[0] == load]
    fit = fit_cycles(cycles, names, (0, 1, 2, 3, 4))
    for name in names:
        found = kvlcc2.without_dimensions(name, fit[name])
        assert found == pytest.approx(kvlcc2.DERIVATIVES[name], abs=kvlcc2.ROUNDING[name]), name
