"""The estimate of a run's speed ripple against the simulated shaft's own speed."""

import math
from dataclasses import replace

import numpy as np
import pytest

from analysis.speed_loop.loop import ShaftLoop
from hardware.description.body import ShipModel
from hardware.description.errors import ConfigurationError
from hardware.description.motor import Cogging, Guides, Servo
from hardware.description.setpoint import Medium, SetPoint
from pmm.plan.check_table import RIPPLE
from pmm.plan.field_checks import field_findings
from pmm.plan.findings import PlanVerdict
from pmm.plan.rig_tables import HullEstimate
from pmm.plan.shaft_load import shaft_load
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from sim.run import steady_run
from tests.pmm.plan.plans import rig_file, run

_TURN = 640  # samples
_RATE_HZ = 0.8 * _TURN
_MOTORS = {
    "plain": Servo(gear_inertia_kg_m2=3.0),
    "rubbing": Servo(gear_inertia_kg_m2=3.0, guides=Guides(coulomb_n=20.0, viscous_n_s_m=50.0)),
    "cogging": Servo(gear_inertia_kg_m2=3.0, cogging=(Cogging(4, 0.3, 0.4),)),
}


def _file(rig: SimulatedRig, motor: dict[str, object]):
    body, water = rig.body, rig.water
    return rig_file(
        rig.oscillator,
        model=ShipModel(body.mass_kg, body.inertia_kg_m2, body.cg_x_m, body.cg_z_m),
        hull=HullEstimate(water.added_mass, water.damping, water.restoring),
        campaign={"drive": {"motor": motor}} if motor else {},
    )


@pytest.mark.sample(5)
@pytest.mark.parametrize("rig", [vertical_rig(), horizontal_rig()])
@pytest.mark.parametrize("motor", _MOTORS.values(), ids=_MOTORS)
@pytest.mark.parametrize(("medium", "phase_rad"), [(Medium.WATER, 0.0), (Medium.AIR, 2.2)])
def test_ripple_by_order(rig: SimulatedRig, motor: Servo, medium: Medium, phase_rad: float) -> None:
    """Orders 1 to 4, to a tenth of the largest: forces change with the speed they change."""
    point = SetPoint(0.8, 0.02, phase_rad, 0.0, medium)
    chain = replace(rig.ideal(), drive=replace(rig.drive, motor=motor)).chain(point)
    _, signals = chain.run(chain.start(_RATE_HZ, 1), 12 * _TURN)
    speed = signals["shaft_speed"][-_TURN:]
    load = shaft_load(replace(run(), set_point=point), _file(rig, {}), motor)
    assert load is not None
    loop = ShaftLoop(motor, motor.loop, load.added_inertia_kg_m2)
    told = loop.ripple(load.torques_n_m, 2.0 * math.pi * 0.8)[:4]
    turned = 2.0 * np.fft.rfft(speed)[1:5] / _TURN / speed.mean()
    assert np.abs(np.abs(told) - np.abs(turned)).max() < 0.1 * np.abs(turned).max()


@pytest.mark.parametrize("counterbalanced", [0.0, 0.7, 1.0])
def test_counterweights_bear_what_the_shaft_need_not_lift(counterbalanced: float) -> None:
    """The first order of the torque in air is that of the weight alone: ``m g e``."""
    rig = vertical_rig()
    rig = replace(rig, oscillator=replace(rig.oscillator, counterbalanced=counterbalanced))
    point, motor = SetPoint(0.8, 0.02, 0.0, 0.0, Medium.AIR), Servo(gear_inertia_kg_m2=1e5)
    load = shaft_load(replace(run(), set_point=point), _file(rig, {}), motor)
    assert load is not None
    lifted = (1.0 - counterbalanced) * 9.80665 * rig.body.mass_kg * 0.02
    assert abs(load.torques_n_m[0]) == pytest.approx(lifted, abs=1e-9)
    on_servo = replace(rig.ideal(), drive=replace(rig.drive, motor=motor))
    torque = steady_run(on_servo, point).spectra["load_torque"][1]
    assert abs(torque) == pytest.approx(lifted, rel=1e-3, abs=1e-3)


def test_a_share_of_the_weight_is_one() -> None:
    with pytest.raises(ConfigurationError, match=r"counterbalanced = 1\.2 .* between 0 and 1"):
        replace(vertical_rig().oscillator, counterbalanced=1.2)


def test_a_plan_is_told_of_it_where_the_motor_is_stated() -> None:
    """A note below 1 %, a warning above; nothing without a motor, one sentence for a wrong one."""
    rig, point = vertical_rig(), SetPoint(1.5, 0.05, 0.0, 0.0, Medium.AIR)
    one = replace(run(), set_point=point)

    def told(motor: dict[str, object]) -> list[PlanVerdict]:
        found = field_findings(one, _file(rig, motor))
        return [each.verdict for each in found if each.quantity == RIPPLE.quantity]

    assert told({}) == []
    assert told({"constant_n_m_a": 0.8}) == [PlanVerdict.WARN]
    assert told({"constant_n_m_a": 0.8, "gear_inertia_kg_m2": 100.0}) == [PlanVerdict.NOTE]
    with pytest.raises(ConfigurationError, match=r"campaign\.drive\.motor"):
        told({"constant_n_m": 0.8})
