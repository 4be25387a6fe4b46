"""Effects of clearances against flights from side to side and plastic impacts."""

from dataclasses import replace

import numpy as np
import pytest

from hardware.description.errors import ConfigurationError
from hardware.description.setpoint import Medium, SetPoint
from sim.drive.gear import Gear
from sim.effects.agreement import simulated_signature
from sim.effects.d4_gear_backlash import GearBacklash
from sim.effects.effect import Effect
from sim.effects.k6_joint_play import JointPlay
from sim.effects.k6b_free_play import FreePlay
from sim.effects.situation import Situation
from sim.effects.switching import switch_on
from sim.model.water.radiation import Radiation
from sim.rig import SimulatedRig, vertical_rig
from sim.run import steady_run
from tests.sim.effects.against_theory import at_small_angles, small_angles

RIG = vertical_rig().ideal()
HEAVE = SetPoint(1.0, 0.02)
SET_POINTS = [
    HEAVE,
    SetPoint(0.5, 0.02),
    SetPoint(1.0, 0.03, np.pi),
]
IN_AIR = SetPoint(0.7, 0.02, 0.0, 0.0, Medium.AIR)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("effect", "set_points", "tolerance"),
    [
        # Theory has rigid sides. What meets on springs bounces and rings: less of it the stiffer.
        (FreePlay(), [*SET_POINTS, IN_AIR], 0.05),
        (FreePlay(1e-5, stiffness_n_m=5e6), [*SET_POINTS, IN_AIR], 0.015),
        (GearBacklash(), SET_POINTS, 0.13),
        (GearBacklash(stiffness_n_m_rad=1e5), SET_POINTS, 0.08),
    ],
)
def test_signature(effect: Effect, set_points: list[SetPoint], tolerance: float) -> None:
    assert at_small_angles(effect, RIG, set_points) < tolerance


@pytest.mark.parametrize("stiffness_n_m_rad", [1e4, 1e5])
def test_weight_in_air_turns_the_teeth_over(stiffness_n_m_rad: float) -> None:
    """Once a turn, with a load so large that what bounces shows in the highest orders only."""
    rig = small_angles(RIG)
    effect = GearBacklash(stiffness_n_m_rad=stiffness_n_m_rad)
    keys = [(f"displacement_{end}", order) for end in ("aft", "fore") for order in range(6)]
    theory = effect.signature(Situation.of(rig, IN_AIR))
    simulated = simulated_signature(effect, rig, IN_AIR, keys)
    apart = [abs(simulated[key] - theory[key]) for key in keys]
    assert max(apart) < 5e-3 * abs(theory["displacement_aft", 1])


def change(effect: Effect, rig: SimulatedRig, set_point: SetPoint, name: str) -> np.ndarray:
    nominal = steady_run(rig, set_point).spectra[name]
    found: np.ndarray = steady_run(*switch_on((effect,), rig, set_point)).spectra[name] - nominal
    return found


def test_free_play_comes_near_the_describing_function() -> None:
    """4 h/pi at the first order, once the flight takes no time: (h/e)^(1/3) of a period."""
    set_point = SetPoint(0.5, 0.02, 0.0, 0.0, Medium.AIR)
    shares = []
    for half_play_m in (1e-4, 1e-6):
        play = FreePlay(half_play_m)
        theory = play.signature(_situation(set_point))
        without = FreePlay(half_play_m, preload_n=1000.0).signature(_situation(set_point))
        moved = theory["force_aft", 1] - without["force_aft", 1]
        inertia = abs(_situation(set_point).impedance(1).sum(axis=1)[0])
        shares.append(abs(moved) / (inertia * 4.0 * half_play_m / np.pi))
    assert abs(shares[1] - 1.0) < abs(shares[0] - 1.0)
    assert shares[1] == pytest.approx(1.0, abs=0.05)


def _situation(set_point: SetPoint) -> Situation:
    return Situation.of(RIG, set_point)


def test_preload_beyond_the_peak_force_closes_the_joints() -> None:
    stiff = change(FreePlay(1e-4, 1000.0), RIG, HEAVE, "force_aft")
    wide = change(FreePlay(5e-4, 1000.0), RIG, HEAVE, "force_aft")
    open_joint = change(FreePlay(5e-4), RIG, HEAVE, "force_aft")
    assert np.abs(stiff - wide).max() < 1e-9
    assert np.abs(open_joint - wide).max() > 0.5


@pytest.mark.parametrize("set_point", [HEAVE, SetPoint(0.5, 0.02)])
def test_backlash_moves_the_struts_at_first_and_third_order(set_point: SetPoint) -> None:
    """y_3 = e beta/pi of a square wave; a late and round one has somewhat less."""
    found = change(GearBacklash(1e-4), RIG, set_point, "displacement_aft")
    teeth = change(GearBacklash(1e-7), RIG, set_point, "displacement_aft")
    third = abs(found[3] - teeth[3]) / (set_point.eccentricity_m * 1e-4 / np.pi)
    assert 0.6 < third < 1.05


def test_a_load_that_does_not_reverse_keeps_the_teeth_together() -> None:
    """At a strut phase of 60 degrees the mean torque is larger than what varies."""
    held = SetPoint(1.0, 0.02, np.pi / 3.0)
    assert at_small_angles(GearBacklash(), RIG, [held]) < 1e-3
    wide = change(GearBacklash(0.01), RIG, held, "force_aft")
    narrow = change(GearBacklash(1e-4), RIG, held, "force_aft")
    assert np.abs(wide - narrow).max() < 1e-6


@pytest.mark.parametrize("effect", [FreePlay(), GearBacklash()])
def test_time_domain_and_periodic_form_agree(effect: Effect) -> None:
    rig, set_point = switch_on((effect,), RIG, HEAVE)
    chain = rig.chain(set_point)
    _, run = chain.run(chain.start(200.0, 1), 2400)
    turn = np.exp(-1j * np.outer([1, 2, 3], run["shaft_angle"][-800:]))
    found = 2.0 * (turn * run["force_aft"][-800:]).mean(axis=1)
    steady = steady_run(rig, set_point).spectra["force_aft"]
    assert np.abs(found - steady[1:4]).max() < 5e-4 * abs(steady[1])


def test_a_memory_that_fades_slowly_is_settled_beside_a_clearance() -> None:
    """A wave that dies out over 40 s: some 60 periods of 2 s would still show it."""
    slow = Radiation(
        np.zeros((2, 2)), np.diag([-0.025, -4.0]), np.diag([3.0, 20.0]), np.diag([3.0, 20.0])
    )
    slow_rig = replace(RIG, radiation=slow)
    rig, set_point = switch_on((FreePlay(2e-4),), slow_rig, SetPoint(0.5, 0.02, 0.4))
    chain = rig.chain(set_point)
    state, _ = chain.run(chain.start(200.0, 1), 200 * 600)
    _, run = chain.run(state, 1600)
    turn = np.exp(-1j * np.outer([0, 1, 2, 3], run["shaft_angle"]))
    found = (turn * run["force_aft"]).mean(axis=1) * [1.0, 2.0, 2.0, 2.0]
    steady = steady_run(rig, set_point).spectra["force_aft"]
    assert np.abs(found - steady[:4]).max() < 2e-5 * abs(steady[1])


@pytest.mark.slow
@pytest.mark.parametrize(("effect", "fine"), [(GearBacklash(0.003, 0.02, 3e4, 1.0), 20)])
def test_teeth_that_ring_faster_than_the_samples_follow(effect: Effect, fine: int) -> None:
    """Steps between the samples: else what rings fed itself, and was off by a tenth."""
    rig, set_point = switch_on((effect,), RIG, SetPoint(0.5, 0.02))
    chain = rig.chain(set_point)
    _, often = chain.run(chain.start(200.0 * fine, 1), 16 * 200 * fine)
    turned = 2.0 * np.pi * 0.5 * np.arange(8 * 200 * fine) / (200.0 * fine)
    turned += np.mean(often["shaft_angle"][-turned.size :] - turned)
    turn = np.exp(-1j * np.outer([1, 2, 3], turned))
    found = 2.0 * (turn * often["force_aft"][-turned.size :]).mean(axis=1)
    steady = steady_run(rig, set_point).spectra["force_aft"][1:4]
    assert np.abs(found - steady).max() < 1e-5 * abs(steady[0])
    _, seldom = chain.run(chain.start(200.0, 1), 400)
    # Bounces differ from the first one on, but none is larger.
    assert np.abs(seldom["force_aft"]).max() < 1.05 * np.abs(often["force_aft"]).max()


@pytest.mark.parametrize(
    "effect", [FreePlay(), GearBacklash(), GearBacklash(0.003, 0.02, 1e5, 10.0)]
)
def test_blocks_give_the_samples_of_the_whole_run(effect: Effect) -> None:
    rig, set_point = switch_on((effect,), RIG, HEAVE)
    chain = rig.chain(set_point)
    _, whole = chain.run(chain.start(200.0, 1), 300)
    state, parts = chain.start(200.0, 1), []
    for count in (1, 7, 92, 200):
        state, part = chain.run(state, count)
        parts.append(part["force_aft"])
    joined = np.concatenate(parts)
    scale = np.abs(whole["force_aft"]).max()
    np.testing.assert_allclose(joined, whole["force_aft"], rtol=0.0, atol=1e-11 * scale)


def test_teeth_too_stiff_to_be_solved_are_told_from_what_has_no_march() -> None:
    set_point = SetPoint(1.0, 0.03, np.pi)
    hard = replace(RIG, drive=replace(RIG.drive, gear=Gear(0.02, 1e8, 1.0, 0.005)))
    chain = hard.chain(set_point)
    with pytest.raises(ConfigurationError, match=r"stiffness_n_m_rad = 1e\+08 .*make the teeth so"):
        chain.run(chain.start(200.0, 1), 400)
    held, changed = switch_on((GearBacklash(), JointPlay()), RIG, set_point)
    chain = held.chain(changed)
    with pytest.raises(ConfigurationError, match="leave out play that friction holds"):
        chain.run(chain.start(200.0, 1), 400)
