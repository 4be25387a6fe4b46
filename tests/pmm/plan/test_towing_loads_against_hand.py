"""What towing asks of the struts before a run, against loads that are written out here."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from hardware.description.body import ShipModel
from hardware.description.kinds import Motion, RunKind
from hardware.description.known_loads import KnownMass
from hardware.description.oscillator import HORIZONTAL_1963, VERTICAL_1963
from hardware.description.setpoint import Medium, SetPoint
from hardware.rig_configuration import RigConfiguration, read_rig
from pmm.plan.checks import check_plan
from pmm.plan.findings import PlanFinding
from pmm.plan.force_estimate import force_peak_n, steady_forces_n
from pmm.plan.limits import limit_findings
from pmm.plan.plan import Plan
from pmm.plan.rig_file import RigFile
from pmm.plan.rig_tables import Gauge, HullEstimate
from pmm.plan.run_plan import RunPlan
from sim.devices.bench_file import DRIVERS
from tests.pmm.plan.plans import rig_file, run

HALF_M, U = 0.5, 1.2
MASS_KG, CG_X_M = 70.0, -0.02
HULL = HullEstimate(((62.0, 2.0), (2.0, 18.0)), ((120.0, -15.0), (40.0, 35.0)))


def horizontal(aft_n: float, fore_n: float, *more: Gauge) -> RigFile:
    gauges = (Gauge("force_aft", aft_n), Gauge("force_fore", fore_n), *more)
    model = ShipModel(MASS_KG, 27.5, CG_X_M, length_m=2.5)
    return rig_file(HORIZONTAL_1963, model=model, hull=HULL, gauges=gauges)


def towed(drift_deg: float = 0.0, turn_rate_rad_s: float = 0.0) -> RunPlan:
    point = SetPoint(
        0.0, 0.0, 0.0, U, drift_rad=math.radians(drift_deg), turn_rate_rad_s=turn_rate_rad_s
    )
    kind = RunKind.CIRCLE if turn_rate_rad_s else RunKind.STATIC_DRIFT
    return RunPlan(name="tow", kind=kind, motion=Motion.NONE, set_point=point, duration_s=5.0)


def at_gauges(one: RunPlan, rig: RigFile) -> list[PlanFinding]:
    return [each for each in limit_findings(one, rig) if each.quantity.startswith("gauge force")]


@pytest.mark.parametrize("drift_deg", [20.0, -20.0])
def test_a_static_drift_is_held_against_the_gauges(drift_deg: float) -> None:
    """Force 120 v and moment 40 v of v = 1.2 sin 20 = 0.4104 m/s: (49.25 + 32.83) / 2 fore."""
    aft, fore = steady_forces_n(towed(drift_deg), horizontal(500.0, 500.0))
    assert (abs(aft), abs(fore)) == (pytest.approx(8.21, abs=5e-3), pytest.approx(41.04, abs=5e-3))
    (one,) = at_gauges(towed(drift_deg), horizontal(20.0, 20.0))
    assert (one.verdict, one.limit) == ("refuse", 20.0)
    assert one.value == pytest.approx(41.04, abs=5e-3)
    assert "force_fore" in one.message
    (near,) = at_gauges(towed(drift_deg), horizontal(20.0, 50.0))
    assert (near.verdict, near.limit) == ("warn", 40.0)
    assert at_gauges(towed(drift_deg), horizontal(20.0, 60.0)) == []


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_circle_asks_the_force_towards_its_centre(side: float) -> None:
    """By Newton m U r towards the centre, at the centre of gravity, and the damping of r."""
    rate = 0.3
    lateral = MASS_KG * U * rate - 15.0 * rate
    moment = CG_X_M * MASS_KG * U * rate + 35.0 * rate
    wanted = [side * (lateral - moment / HALF_M) / 2.0, side * (lateral + moment / HALF_M) / 2.0]
    got = steady_forces_n(towed(0.0, side * rate), horizontal(500.0, 500.0))
    assert got == pytest.approx(wanted)


def test_a_sway_at_drift_has_its_mean_beside_its_first_harmonic() -> None:
    rig = horizontal(500.0, 500.0)
    sway = run(0.1, 0.05, 0.0, U, motion=Motion.SWAY)
    at_drift = replace(sway, set_point=replace(sway.set_point, drift_rad=math.radians(20.0)))
    omega, v = 2.0 * math.pi * 0.1, 2.0 * math.pi * 0.1 * 0.05
    # Fore, of the velocity's amplitude v: inertia in quadrature, damping in phase with it.
    inertia = omega * v * (MASS_KG + 62.0 + (MASS_KG * CG_X_M + 2.0) / HALF_M) / 2.0
    damping = v * (120.0 + 40.0 / HALF_M) / 2.0
    alone = math.hypot(inertia, damping)
    assert force_peak_n(sway, rig) == pytest.approx(alone)
    steady = U * math.sin(math.radians(20.0)) * (120.0 + 40.0 / HALF_M) / 2.0
    assert force_peak_n(at_drift, rig) == pytest.approx(alone + steady)


def test_a_trimmed_tow_of_the_vertical_oscillator() -> None:
    """Bow up the water comes from below: w = U sin(theta), as in docs/conventions.md."""
    hull = HullEstimate(damping=((190.0, 0.0), (12.0, 0.0)))
    rig, trim = rig_file(VERTICAL_1963, hull=hull), math.radians(5.0)
    point = SetPoint(0.0, 0.0, 0.0, U, drift_rad=trim)
    aft, fore = steady_forces_n(replace(towed(), set_point=point), rig)
    w = U * math.sin(trim)
    assert (aft, fore) == pytest.approx(((190.0 + 24.0) * w / 2.0, (190.0 - 24.0) * w / 2.0))


def test_each_strut_is_held_against_its_own_gauge() -> None:
    """Fore 41 N of 50 N and aft 8 N of 20 N are possible, whatever the surge gauge's range is."""
    surge = Gauge("force_x", 5.0)
    assert at_gauges(towed(20.0), horizontal(20.0, 60.0, surge)) == []
    (one,) = at_gauges(towed(20.0), horizontal(5.0, 60.0, surge))
    assert one.value == pytest.approx(8.21, abs=5e-3)
    assert "full scale of force_aft" in one.message


@pytest.mark.parametrize(("table", "field"), [("[hull]", "hull"), ("[model]", "model")])
def test_tows_that_are_not_checked_for_force_are_named(table: str, field: str) -> None:
    nothing: dict[str, Any] = {field: None}
    plan = Plan("a", Path("plan.toml"), Path("rig.toml"), (towed(20.0),), "", "0")
    whole = [one.message for one in check_plan(plan, horizontal(500.0, 500.0))]
    bare = [one.message for one in check_plan(plan, replace(horizontal(20.0, 20.0), **nothing))]
    text = {"hull": "the force of tows is", "model": "forces are"}[field]
    wanted = f"rig.toml has no {table}: {text} not checked"
    assert wanted in bare
    assert not [one for one in whole if "force" in one]


def amplifier(full_scale_n: float) -> RigConfiguration:
    channel = {"name": "force_aft", "object": "9130:1", "scale": 1e-3, "full_scale": full_scale_n}
    bus = {"interface": "virtual", "channel": "nowhere"}
    amplifier = {"driver": "cia404-amplifier", "node": 4, "channels": [channel]}
    return read_rig({"bus": bus, "forces": [amplifier]}, DRIVERS)


@pytest.mark.parametrize("mass_kg", [0.0, 5.0])
def test_an_amplifier_bears_what_the_strut_holds_at_rest(mass_kg: float) -> None:
    """In air aft m g (l - x_G) / 2 l at rest, beside m (l - x_G) / 2 l of the acceleration."""
    point = SetPoint(1.4, 0.02, medium=Medium.AIR)
    known = KnownMass(mass_kg, x_m=-HALF_M) if mass_kg else None
    dry = replace(run(), kind=RunKind.DRY, set_point=point, known_mass=known)
    aft_kg = MASS_KG * (HALF_M - CG_X_M) / (2.0 * HALF_M) + mass_kg
    wanted = aft_kg * (9.80665 + (2.0 * math.pi * 1.4) ** 2 * 0.02)
    model = ShipModel(MASS_KG, 27.5, CG_X_M)
    for times, verdicts in ((0.99, ["refuse"]), (1.01, ["warn"]), (1.3, [])):
        rig = rig_file(model=model, hardware=amplifier(times * wanted), gauges=())
        found = at_gauges(dry, rig)
        assert [one.verdict for one in found] == verdicts
        assert [one.value for one in found] == [pytest.approx(wanted)] * len(verdicts)
    # What [[gauges]] states is of tared readings, and what floats holds itself.
    tared = rig_file(model=model, gauges=(Gauge("force_aft", 0.5 * wanted),))
    assert at_gauges(dry, tared) == []
    wet = replace(run(1.4, 1e-3), kind=RunKind.OSCILLATION)
    floats = rig_file(model=model, hardware=amplifier(0.3 * wanted), gauges=())
    assert at_gauges(wet, floats) == []


def test_a_horizontal_rig_holds_nothing_at_rest() -> None:
    rig = replace(horizontal(20.0, 60.0), hardware=amplifier(20.0))
    assert at_gauges(towed(20.0), rig) == []
