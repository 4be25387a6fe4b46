"""Effects of the drive against closed forms, over frequency, amplitude, phase and medium."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hardware.description.arrays import FloatArray
from hardware.description.motor import Cogging, Guides
from hardware.description.setpoint import Medium, SetPoint
from sim import signals
from sim.effects.d1_speed_ripple import SpeedRippleEffect
from sim.effects.d1b_torque_cogging import TorqueCogging
from sim.effects.d2_speed_droop import SpeedDroop
from sim.effects.d3_load_ripple import LoadRipple
from sim.effects.d5_guide_friction import GuideFriction
from sim.effects.d6_frequency_error import SetFrequencyError
from sim.effects.effect import Effect
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from sim.run import steady_run
from tests.sim.effects.against_theory import at_small_angles

PHASES = (0.0, np.pi / 3.0, np.pi)
IN_WATER = [SetPoint(f, a, p) for f in (0.4, 0.9) for a in (0.01, 0.03) for p in PHASES]
AHEAD = [SetPoint(0.7, 0.02, p, 1.2) for p in PHASES]
IN_AIR = [SetPoint(0.7, 0.02, p, 0.0, Medium.AIR) for p in PHASES]
SET_POINTS = IN_WATER + AHEAD + IN_AIR

CASES = [
    # The series ends at the third power of rho/k.
    *((SpeedRippleEffect(0.005, k, phase), 1e-6) for k in (1.0, 2.0, 3.0) for phase in (0.0, 1.0)),
    # First order in the load's inertia over the shaft's, M e^2/(2 J), and in the change of speed.
    (SpeedDroop(2e-4), 1e-3),
    (LoadRipple(200.0), 1e-3),
    (LoadRipple(200.0, 0.5), 1e-3),
    (TorqueCogging(0.1, 1.0, 0.5, 5.0), 1e-6),
    (TorqueCogging(0.1, 3.0, 0.0, 5.0), 1e-6),
    (SetFrequencyError(), 1e-9),
    (SetFrequencyError(-0.02), 1e-9),
]


@pytest.mark.sample(19)
@pytest.mark.parametrize("rig", [vertical_rig(), horizontal_rig()], ids=["vertical", "horizontal"])
@pytest.mark.parametrize(("effect", "tolerance"), CASES)
def test_signature(effect: Effect, tolerance: float, rig: SimulatedRig) -> None:
    assert at_small_angles(effect, rig.ideal(), SET_POINTS) < tolerance


@pytest.mark.slow
@pytest.mark.parametrize("effect", [SpeedDroop(2e-4), LoadRipple(200.0)])
def test_friction_of_the_guides_loads_the_shaft(effect: Effect) -> None:
    rig = vertical_rig().ideal()
    rubbing = replace(rig, drive=replace(rig.drive, guides=Guides(5.0, 10.0)))
    assert at_small_angles(effect, rubbing, SET_POINTS) < 1e-3


def test_guide_friction_shows_in_no_force_but_in_the_torque() -> None:
    set_point = SetPoint(0.7, 0.03, 1.0)
    rig = vertical_rig().ideal()
    effect = GuideFriction(20.0, 30.0)
    rubbing = effect.change(rig, set_point)
    before, after = steady_run(rig, set_point), steady_run(rubbing, set_point)
    assert all(np.array_equal(before.spectra[name], after.spectra[name]) for name in before.spectra)

    loads = []
    for one in (rig, rubbing):
        driven = LoadRipple(500.0).change(one, set_point)
        loads.append(steady_run(driven, set_point).spectra[signals.LOAD_TORQUE.name])
    omega, e, turn = 2.0 * np.pi * 0.7, 0.03, np.exp(2j)
    more = loads[1] - loads[0]
    viscous = 30.0 * omega * e**2 / 2.0
    assert more[0].real == pytest.approx(2.0 * (20.0 * e * 2.0 / np.pi + viscous), rel=1e-3)
    second = (20.0 * e * 4.0 / (3.0 * np.pi) + viscous) * (1.0 + turn)
    assert abs(more[2] - second) < 1e-3 * abs(second)


@pytest.mark.parametrize("order", [1, 2])
def test_cogging_moves_the_shaft_by_the_equation_of_motion(order: int) -> None:
    # th'' = -(T/J) sin(k th + psi), integrated over three turns from the start that repeats.
    torque, inertia, phase, frequency_hz = 0.02, 5.0, 0.4, 0.5
    omega = 2.0 * np.pi * frequency_hz
    effect = TorqueCogging(torque, float(order), phase, inertia)
    rippled = effect.change(vertical_rig().ideal(), SetPoint(frequency_hz, 0.02, 0.0)).drive
    time_s = np.linspace(0.0, 3.0 / frequency_hz, 301)
    there = rippled.commanded(frequency_hz, time_s)

    def motion(_: float, state: FloatArray) -> list[float]:
        return [state[1], -torque / inertia * np.sin(order * state[0] + phase)]

    start = [there.angle[0], there.speed[0]]
    found = solve_ivp(motion, (0.0, time_s[-1]), start, t_eval=time_s, rtol=1e-10, atol=1e-12)
    # To the second order in k X the mean speed differs too, and that adds up over the turns.
    second = (torque / (inertia * order * omega**2)) ** 2
    assert np.abs(found.y[0] - there.angle).max() < second * omega * time_s[-1]


def test_cogging_turns_a_motor_that_the_rig_has() -> None:
    set_point = SetPoint(0.7, 0.02, 0.0)
    driven = LoadRipple(300.0).change(vertical_rig().ideal(), set_point)
    motor = TorqueCogging(1.0, 2.0, 0.1).change(driven, set_point).drive.motor
    assert motor is not None
    assert motor.cogging == (Cogging(2, 1.0, 0.1),)


def test_load_ripple_by_the_textbook_formula() -> None:
    # y_3 = e^3 |Z_1|/(16 J w^2) for one strut's load; in heave both loads add, so J is shared.
    effect = LoadRipple(100.0, 0.001)
    rig, set_point = vertical_rig().ideal(), SetPoint(0.9, 0.03, 0.0)
    state = steady_run(effect.change(rig, set_point), set_point)
    omega = 2.0 * np.pi * 0.9
    force = abs(state.spectra["force_aft"][1]) + abs(state.spectra["force_fore"][1])
    expected = 0.03**2 * force / (16.0 * 100.0 * omega**2)
    assert abs(state.spectra["displacement_aft"][3]) == pytest.approx(expected, rel=2e-3)
    quarter = SetPoint(0.9, 0.03, np.pi / 2.0)
    quiet = steady_run(effect.change(rig, quarter), quarter)
    # At 90 degrees each strut's own load cancels the other's; what is left goes through the model.
    assert abs(quiet.spectra["displacement_aft"][3]) < 0.3 * expected


def test_droop_and_ripple_make_one_motor_in_either_order() -> None:
    rig, set_point = vertical_rig().ideal(), SetPoint(0.7, 0.03)
    droop, ripple = SpeedDroop(0.01), LoadRipple(8.0)
    one = droop.change(ripple.change(rig, set_point), set_point)
    other = ripple.change(droop.change(rig, set_point), set_point)
    first, second = steady_run(one, set_point), steady_run(other, set_point)
    assert first.period.frequency_hz < 0.7
    assert first.period.frequency_hz == pytest.approx(second.period.frequency_hz, rel=1e-9)
    assert np.allclose(first.spectra["force_aft"], second.spectra["force_aft"], rtol=1e-6)


def test_a_motor_that_yields_already_yields_by_the_sum() -> None:
    rig, set_point = vertical_rig().ideal(), SetPoint(0.7, 0.03)
    twice = SpeedDroop(0.02).change(SpeedDroop(0.01).change(rig, set_point), set_point)
    once = SpeedDroop(0.03).change(rig, set_point)
    lost_hz = 0.7 - steady_run(twice, set_point).period.frequency_hz
    assert lost_hz == pytest.approx(0.7 - steady_run(once, set_point).period.frequency_hz, rel=1e-6)
    assert lost_hz > 0.0


def test_belt_ripple_has_no_part_in_the_harmonics() -> None:
    assert np.isnan(
        at_small_angles(SpeedRippleEffect(0.005, 2.5), vertical_rig().ideal(), SET_POINTS[:2])
    )
