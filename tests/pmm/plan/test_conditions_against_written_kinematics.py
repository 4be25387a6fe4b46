"""What a plan's check says of each condition, against the kinematics written out here."""

import math
from dataclasses import replace

import numpy as np
import pytest

from hardware.description.body import ShipModel
from hardware.description.kinds import Motion, RunKind
from hardware.description.lines import Line
from hardware.description.oscillator import HORIZONTAL_1963, VERTICAL_1963
from hardware.description.setpoint import SetPoint
from pmm.plan.condition_checks import condition_findings
from pmm.plan.findings import PlanFinding, largest_stated
from pmm.plan.rig_tables import TankTable
from tests.pmm.plan.plans import rig_file, run

G, L, HALF = 9.80665, 2.5, 0.5
SHIP = ShipModel(70.0, 27.5, length_m=L)
TANK = TankTable(100.0, 4.0, 0.5, 4.0, depth_m=2.0)


def told(one, rig) -> dict[str, PlanFinding]:  # type: ignore[no-untyped-def]
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
    assert all(each.source and each.is_stated for each in found.values())


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
    point = SetPoint(0.0, 0.0, 0.0, 1.2, drift_rad=0.1)
    still = run(kind=RunKind.STATIC_DRIFT, set_point=point)
    found = told(still, rig_file(HORIZONTAL_1963, tank=TANK))
    assert found["largest angle to the flow [deg]"].value == pytest.approx(math.degrees(0.1))
    assert "largest yaw [deg]" not in found


def test_pitch_is_named_so_and_has_no_wall_beside_it() -> None:
    found = told(run(0.5, 0.02, math.pi, 1.0), rig_file(VERTICAL_1963, tank=TANK))
    assert found["largest pitch [deg]"].value == pytest.approx(math.degrees(math.atan(0.04)))
    assert "reach to the side [m]" not in found
    assert "q' = q L / U" in found


def test_the_beam_comes_on_top_of_the_reach_to_the_side() -> None:
    one = run(0.1, 0.2, 0.0, 1.2, motion=Motion.SWAY)
    reach = {
        beam: told(one, rig_file(HORIZONTAL_1963, tank=TANK, model=replace(SHIP, beam_m=beam)))
        for beam in (None, 0.4)
    }
    bare, whole = (reach[one]["reach to the side [m]"].value for one in (None, 0.4))
    assert (bare, whole) == (pytest.approx(0.2), pytest.approx(0.2 + 0.4 / 2.0))


def test_blockage_warns_where_loads_grow_by_two_percent() -> None:
    """Continuity: U W h = U' (W h - B T), so loads with U'^2 grow by (1 - m)^-2 - 1."""
    one = run(0.1, 0.1, 0.0, 1.0, motion=Motion.SWAY)
    for draught, verdict in ((0.199, "note"), (0.201, "warn")):
        ship = replace(SHIP, beam_m=0.4, draught_m=draught)
        found = told(one, rig_file(HORIZONTAL_1963, tank=TANK, model=ship))["blockage B T / (W h)"]
        section = 4.0 * 2.0
        faster = section / (section - 0.4 * draught)
        assert (found.value, found.verdict) == (pytest.approx(1.0 - 1.0 / faster), verdict)
        assert (faster**2 - 1.0 > 0.0203) == (verdict == "warn")
    still = told(run(0.8), rig_file(tank=TANK, model=replace(SHIP, beam_m=0.4, draught_m=0.2)))
    assert "blockage B T / (W h)" not in still
    assert still["depth over draught h / T"].value == pytest.approx(10.0)


def test_a_model_that_would_strike_the_bottom_is_refused() -> None:
    """Opposed struts pitch it about its middle, which swings aft of the pivot by little."""
    ship = replace(SHIP, draught_m=0.2)
    slope = math.atan(0.05 / HALF)
    down = 0.2 + L / 2.0 * math.sin(slope) + 0.05 - HALF * math.sin(slope)
    for depth, verdict in ((down + 1e-3, "note"), (down - 1e-3, "refuse")):
        tank = replace(TANK, depth_m=depth)
        found = told(run(0.5, 0.05, math.pi, 1.0), rig_file(tank=tank, model=ship))
        assert found["reach down [m]"].value == pytest.approx(down, rel=1e-4)
        assert found["reach down [m]"].verdict == verdict


@pytest.mark.parametrize(
    ("motion", "reduced", "verdict"),
    [
        (Motion.SWAY, 1.9, "note"),
        (Motion.SWAY, 2.1, "warn"),
        (Motion.YAW, 2.9, "note"),
        (Motion.YAW, 3.1, "warn"),
        (Motion.PHASE, 3.1, "note"),
    ],
)
def test_reduced_frequency_of_each_motion(motion: Motion, reduced: float, verdict: str) -> None:
    one = run(reduced / (2.0 * math.pi * L), speed_m_s=1.0, motion=motion)
    found = told(one, rig_file(HORIZONTAL_1963))["w' = w L / U"]
    assert (found.value, found.verdict) == (pytest.approx(reduced), verdict)


@pytest.mark.parametrize(
    ("tau", "heave", "sway"),
    [
        (0.19, "note", "note"),
        (0.21, "warn", "warn"),
        (0.29, "warn", "warn"),
        (0.31, "note", "warn"),
    ],
)
def test_heave_keeps_off_a_quarter_and_sway_below_it(tau: float, heave: str, sway: str) -> None:
    one = run(tau * G / (2.0 * math.pi * 1.2), speed_m_s=1.2)
    for oscillator, motion, quantity, verdict in (
        (VERTICAL_1963, Motion.HEAVE, "w U / g (keep off 1/4)", heave),
        (HORIZONTAL_1963, Motion.SWAY, "w U / g", sway),
    ):
        found = told(replace(one, motion=motion), rig_file(oscillator))[quantity]
        assert (found.value, found.verdict) == (pytest.approx(tau), verdict)


def test_echoes_of_the_walls_are_said_below_the_ittc_table() -> None:
    """Table 1 of 7.5-02-07-02.1: 0.378 where the tank is as broad as the model is long."""
    as_long = replace(TANK, width_m=L)
    for tau, said in ((0.37, True), (0.39, False)):
        one = run(tau * G / (2.0 * math.pi * 1.2), speed_m_s=1.2)
        found = told(one, rig_file(tank=as_long))
        assert ("w U / g for the walls' echoes" in found) is said
    assert "w U / g for the walls' echoes" not in told(
        one, rig_file(tank=replace(TANK, width_m=9 * L))
    )


def test_of_many_runs_each_number_is_stated_at_its_largest_and_warnings_stay_apart() -> None:
    rig = rig_file(HORIZONTAL_1963, tank=TANK)
    runs = [
        run(f, a, 0.0, 1.0, motion=Motion.SWAY, name=f"{f}-{a}")
        for f, a in ((0.1, 0.05), (0.05, 0.2), (0.2, 0.1))  # w' = 3.14 of the last one warns
    ]
    found = [each for one in runs for each in condition_findings(one, rig)]
    stated = {each.quantity: (each.run, each.value) for each in largest_stated(found)}
    assert stated["reach to the side [m]"] == ("0.05-0.2", pytest.approx(0.2))
    assert stated["w' = w L / U"] == ("0.1-0.05", pytest.approx(0.2 * math.pi * L))
    assert stated["w sqrt(L / g)"][0] == "0.2-0.1"
    assert list(stated) == sorted(stated)


def test_of_many_lines_the_worst_counts_and_not_their_base() -> None:
    """Sway at 0.5 and 0.8 Hz, 0.8 m/s: w = 5.03 and 3.14 rad/s; the base of 0.05 Hz is at rest."""
    lines = (Line(10, 0.6), Line(16, 0.4))
    point = SetPoint(0.05, 0.02, 0.0, 0.8, lines=lines)
    found = told(run(set_point=point, motion=Motion.SWAY), rig_file(HORIZONTAL_1963, tank=TANK))
    highest = 2.0 * math.pi * 0.8
    for quantity, value, verdict in (
        ("w' = w L / U", highest * L / 0.8, "warn"),
        ("w U / g", highest * 0.8 / G, "warn"),
        ("w sqrt(L / g)", highest * math.sqrt(L / G), "note"),
    ):
        assert (found[quantity].value, found[quantity].verdict) == (pytest.approx(value), verdict)
    # Heave: the line that is nearest to 1/4 counts, at 1.2 m/s that of 0.35 Hz, tau = 0.269.
    heave = SetPoint(0.05, 0.02, 0.0, 1.2, lines=(Line(7, 0.6), Line(16, 0.4)))
    tau = told(run(set_point=heave), rig_file(tank=TANK))["w U / g (keep off 1/4)"]
    assert (tau.value, tau.verdict) == (pytest.approx(0.7 * math.pi * 1.2 / G), "warn")
