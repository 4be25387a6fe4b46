"""The estimate of a strut's force against the simulator's own forces, on yokes: 1 %."""

import math
from dataclasses import replace

import numpy as np
import pytest

from hardware.description.setpoint import Medium, SetPoint
from pmm.plan.motion_peaks import force_peak_n
from pmm.plan.rig_tables import HullEstimate, Ship
from pmm.plan.run_plan import KnownMass
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from sim.run import simulate
from tests.pmm.plan.plans import rig_file, run


def _estimate(rig: SimulatedRig, point: SetPoint, mass: KnownMass | None = None) -> float:
    body, water = rig.body, rig.water
    file = rig_file(
        rig.oscillator,
        model=Ship(body.mass_kg, body.inertia_kg_m2, body.cg_x_m, body.cg_z_m),
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


def test_a_known_mass_adds_its_own_share() -> None:
    rig = vertical_rig()
    point = SetPoint(0.8, 0.02, medium=Medium.AIR)
    omega2 = (2.0 * math.pi * 0.8) ** 2
    # On the aft strut: all of the mass's force, and nothing on the other one.
    more = _estimate(rig, point, KnownMass(10.0, x_m=-rig.oscillator.half_spacing_m))
    aft = rig.body.mass_kg * (1.0 - rig.body.cg_x_m / rig.oscillator.half_spacing_m) / 2.0 + 10.0
    assert more == pytest.approx(aft * omega2 * 0.02)
