"""What a plan's check says of each condition, against the kinematics written out here."""

import math
from dataclasses import replace

import numpy as np
import pytest

from hardware.description.oscillator import HORIZONTAL_1963, VERTICAL_1963
from pmm.plan.condition_checks import condition_findings
from pmm.plan.findings import Finding
from pmm.plan.kinds import Motion, RunKind
from pmm.plan.rig_tables import Tank
from tests.pmm.plan.plans import rig_file, run

G, L, HALF = 9.80665, 2.5, 0.5
TANK = Tank(100.0, 4.0, 0.5, 4.0, depth_m=2.0)


def told(one, rig) -> dict[str, Finding]:  # type: ignore[no-untyped-def]
    return {each.quantity: each for each in condition_findings(one, rig)}


def test_a_yaw_of_a_modern_oscillator() -> None:
    """Opposed struts at 0.1 Hz: tan psi = (e / l) sin w t, so that r = w e / l at the middle."""
    amplitude, speed, omega = 0.2, 1.2, 2.0 * math.pi * 0.1
    one = run(0.1, amplitude, math.pi, speed, motion=Motion.YAW)
    found = told(one, rig_file(HORIZONTAL_1963, tank=TANK))
    slope = amplitude / HALF
    assert found["largest yaw [deg]"].value == pytest.approx(math.degrees(math.atan(slope)))
    assert found["r' = r L / U"].value == pytest.approx(omega * slope * L / speed, rel=1e-4)
    assert found["w sqrt(L / g)"].value == pytest.approx(omega * math.sqrt(L / G))
    assert found["depth Froude number"].value == pytest.approx(speed / math.sqrt(2.0 * G))
    t = np.linspace(0.0, 10.0, 5001)
    s = slope * np.sin(omega * t)
    psi, rate = np.arctan(s), slope * omega * np.cos(omega * t) / (1.0 + s**2)
    aft_rate = -amplitude * omega * np.cos(omega * t)
    along = speed - HALF * np.sin(psi) * rate
    aside = aft_rate + HALF * np.cos(psi) * rate
    u = along * np.cos(psi) + aside * np.sin(psi)
    v = aside * np.cos(psi) - along * np.sin(psi)
    beta = math.degrees(float(np.abs(np.arctan2(v, u)).max()))
    assert found["largest angle to the flow [deg]"].value == pytest.approx(beta, rel=1e-4)
    y = -amplitude * np.sin(omega * t) + HALF * np.sin(psi)
    swung = float((np.abs(y) + L / 2.0 * np.abs(np.sin(psi))).max())
    assert found["reach to the side [m]"].value == pytest.approx(swung, rel=1e-4)
    assert {each.verdict for each in found.values()} == {"note"}


def test_a_model_that_would_strike_the_wall_is_refused() -> None:
    one = run(0.1, 0.2, math.pi, 1.2, motion=Motion.YAW)
    narrow = told(one, rig_file(HORIZONTAL_1963, tank=replace(TANK, width_m=0.8)))
    assert narrow["reach to the side [m]"].verdict == "refuse"
    assert narrow["reach to the side [m]"].limit == 0.4


def test_a_shallow_tank_warns_from_the_critical_speed_on() -> None:
    shallow = rig_file(HORIZONTAL_1963, tank=replace(TANK, depth_m=0.1))
    for speed, verdict in ((0.98, "note"), (1.0, "warn")):
        found = told(run(0.1, 0.1, 0.0, speed, motion=Motion.SWAY), shallow)
        assert found["depth Froude number"].verdict == verdict


def test_static_drift_is_its_own_angle_to_the_flow() -> None:
    still = replace(run(0.0, 0.0, 0.0, 1.2), kind=RunKind.STATIC_DRIFT, drift_rad=0.1)
    found = told(still, rig_file(HORIZONTAL_1963, tank=TANK))
    assert found["largest angle to the flow [deg]"].value == pytest.approx(math.degrees(0.1))
    assert "largest yaw [deg]" not in found


def test_pitch_is_named_so_and_has_no_wall_beside_it() -> None:
    found = told(run(0.5, 0.02, math.pi, 1.0), rig_file(VERTICAL_1963, tank=TANK))
    assert found["largest pitch [deg]"].value == pytest.approx(math.degrees(math.atan(0.04)))
    assert "reach to the side [m]" not in found
    assert "q' = q L / U" in found
