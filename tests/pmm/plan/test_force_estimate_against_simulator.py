"""The estimate of a strut's force against the simulator's own forces, on yokes: 1 %.

And how far it is to be trusted, against what each part is by hand.
"""

import math
from dataclasses import replace
from datetime import date

import numpy as np
import pytest

from hardware.description.body import ShipModel
from hardware.description.known_loads import KnownMass
from hardware.description.oscillator import VERTICAL_1963
from hardware.description.setpoint import Medium, SetPoint
from pmm.campaign.calibration import Calibration
from pmm.plan.force_estimate import FAR, expected_readings, force_peak_n
from pmm.plan.rig_tables import HullEstimate
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from sim.run import simulate
from tests.pmm.plan.plans import rig_file, run


def _estimate(rig: SimulatedRig, point: SetPoint, mass: KnownMass | None = None) -> float:
    body, water = rig.body, rig.water
    file = rig_file(
        rig.oscillator,
        model=ShipModel(body.mass_kg, body.inertia_kg_m2, body.cg_x_m, body.cg_z_m),
        hull=HullEstimate(water.added_mass, water.damping, water.restoring),
    )
    one = replace(run(known_mass=mass), set_point=point)
    estimate = force_peak_n(one, file)
    assert estimate is not None
    return estimate


@pytest.mark.parametrize("rig", [vertical_rig(), horizontal_rig()])
@pytest.mark.parametrize("medium", list(Medium))
@pytest.mark.parametrize(("phase_rad", "speed_m_s"), [(0.0, 0.0), (math.pi, 0.0), (2.2, 1.2)])
def test_a_run_s_largest_force(
    rig: SimulatedRig, medium: Medium, phase_rad: float, speed_m_s: float
) -> None:
    point = SetPoint(0.8, 0.02, phase_rad, speed_m_s, medium)
    data = simulate(rig.ideal(), point, periods=3, settling_periods=3, sample_rate_hz=500.0, seed=1)
    forces = np.stack([data[name].to_numpy() for name in ("force_aft", "force_fore")])
    assert _estimate(rig, point) == pytest.approx(np.abs(forces).max(), rel=0.01)


@pytest.mark.parametrize(("drift_deg", "turn_rate_rad_s"), [(20.0, 0.0), (-10.0, 0.0), (0.0, 0.2)])
def test_a_slow_sway_at_drift_or_on_a_circle(drift_deg: float, turn_rate_rad_s: float) -> None:
    """The mean and the first harmonic together; on a circle the simulator's turn is exact."""
    rig, drift = horizontal_rig(), math.radians(drift_deg)
    point = SetPoint(0.1, 0.05, 0.0, 1.2, drift_rad=drift, turn_rate_rad_s=turn_rate_rad_s)
    data = simulate(rig.ideal(), point, periods=2, settling_periods=2, sample_rate_hz=100.0, seed=1)
    forces = np.stack([data[name].to_numpy() for name in ("force_aft", "force_fore")])
    assert _estimate(rig, point) == pytest.approx(np.abs(forces).max(), rel=0.01)


def test_a_known_mass_adds_its_own_share() -> None:
    rig = vertical_rig()
    point = SetPoint(0.8, 0.02, medium=Medium.AIR)
    omega2 = (2.0 * math.pi * 0.8) ** 2
    # On the aft strut: all of the mass's force, and nothing on the other one.
    more = _estimate(rig, point, KnownMass(10.0, x_m=-rig.oscillator.half_spacing_m))
    aft = rig.body.mass_kg * (1.0 - rig.body.cg_x_m / rig.oscillator.half_spacing_m) / 2.0 + 10.0
    assert more == pytest.approx(aft * omega2 * 0.02)


@pytest.mark.parametrize("displaced_kg", [None, 75.0])
def test_a_model_below_the_surface_is_borne_at_its_centre_of_buoyancy(
    displaced_kg: float | None,
) -> None:
    """Slow pitch: of the forces nothing but weight and buoyancy is left."""
    centre = -0.05 if displaced_kg else 0.0
    model = ShipModel(78.0, 14.0, 0.0, 0.02, displaced_kg, 0.0, centre)
    half = VERTICAL_1963.half_spacing_m
    slow = replace(run(), set_point=SetPoint(1e-5, 0.02, math.pi))
    moment = 9.80665 * (78.0 * 0.02 - (displaced_kg or 0.0) * centre) * 0.02 / half
    peak = force_peak_n(slow, rig_file(model=model, hull=HullEstimate()))
    assert peak == pytest.approx(moment / (2.0 * half), rel=1e-6)


def _half(mass_kg: float, hz: float, e: float) -> float:
    """The force of each strut in heave, from the mass alone."""
    return mass_kg * (2.0 * math.pi * hz) ** 2 * e / 2.0


AIR = replace(run(), set_point=SetPoint(0.8, 0.02, medium=Medium.AIR))
BARE = {"model": ShipModel(70.0, 27.5), "hull": HullEstimate()}


def test_in_air_a_gauge_is_expected_to_read_half_the_mass() -> None:
    one = expected_readings(AIR, rig_file(**BARE))["force_fore"]
    wanted = _half(70.0, 0.8, 0.02)
    assert one.amplitude_n == pytest.approx(wanted)
    # Heave alone: the mass to 2 %, the gauge and the amplitude to 2 %.
    assert one.standard_uncertainty_n == pytest.approx(math.hypot(0.02, 0.02) * wanted)
    assert not one.is_far(wanted * (1.0 + 0.99 * FAR * math.hypot(0.02, 0.02)))
    assert one.is_far(_half(35.0, 0.8, 0.02))


def test_in_water_hull_and_restoring_widen_it_and_do_not_cancel() -> None:
    """Where inertia and restoring cancel, the force is small and its uncertainty is not."""
    omega2 = (2.0 * math.pi * 0.8) ** 2
    hull = HullEstimate(((75.0, 0.0), (0.0, 22.0)), restoring=((145.0 * omega2, 0.0), (0.0, 0.0)))
    one = expected_readings(
        replace(run(), set_point=SetPoint(0.8, 0.02)),
        rig_file(model=ShipModel(70.0, 27.5), hull=hull),
    )["force_aft"]
    assert one.amplitude_n == pytest.approx(0.0, abs=1e-9)
    parts = (0.02 * 70.0, 0.2 * 75.0, 0.05 * 145.0)
    wanted = math.hypot(*parts) * omega2 * 0.02 / 2.0
    assert one.standard_uncertainty_n == pytest.approx(wanted)


def test_a_calibration_makes_readings_of_forces() -> None:
    none = np.zeros((2, 2))
    matrix = np.array([[2.0, 0.5], [0.0, -1.0]])
    day = date(2026, 1, 1)
    known = Calibration(("force_fore", "force_aft"), matrix, none, none[0], none[0], day, day)
    found = expected_readings(AIR, rig_file(**BARE, calibration=known))
    wanted = _half(70.0, 0.8, 0.02)
    assert found["force_fore"].amplitude_n == pytest.approx(2.5 * wanted)
    assert found["force_aft"].amplitude_n == pytest.approx(wanted)


@pytest.mark.parametrize(
    "changes", [{"model": None}, {"hull": None}, {"campaign": {"radiation": {"file": "a.csv"}}}]
)
def test_nothing_is_expected_of_what_the_file_does_not_tell(changes: dict[str, object]) -> None:
    assert expected_readings(run(), rig_file(**changes)) == {}
