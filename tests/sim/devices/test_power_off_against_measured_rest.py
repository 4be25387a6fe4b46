"""Power is taken off an axis that rests by its encoder, on a plant that coasts without torque."""

from contextlib import suppress

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hardware.cia402 import DriveState
from hardware.errors import DriveFaultError, DriveStateError, HardwareError, NotAtRestError
from sim.devices.faults import inject
from sim.devices.plant import SHAFT_FRICTION
from sim.devices.profile import SpeedProfile
from tests.sim.devices.benches import WHOLE, in_process, ready, turning
from tests.sim.devices.power_watch import PowerWatch

SHAFT_ONLY = {"shaft": WHOLE["shaft"]}


@pytest.fixture
def turned():
    """A shaft at 1 Hz, its world, and a watch on the control words."""
    with in_process(SHAFT_ONLY) as (rig, world):
        rig.shaft.enable()
        rig.run_until(lambda: rig.shaft.enabled, 50, "enable")
        rig.shaft.turn(1.0)
        rig.run_until(lambda: rig.shaft.at_speed, 1000, "speed")
        yield rig, world, PowerWatch(world)


def cycles(rig, count: int) -> None:
    for _ in range(count):
        with suppress(HardwareError):
            rig.cycle()


def cycle_until_it_raises(rig) -> None:
    for _ in range(10):
        rig.cycle()


@pytest.mark.parametrize("speed_rad_s", [6.0, -6.0, 0.01])
def test_a_shaft_without_torque_coasts_as_its_equation_of_motion_says(speed_rad_s: float) -> None:
    coasting = SpeedProfile(0.0, 1.0, speed_rad_s, speed_rad_s).without_torque(2.0, SHAFT_FRICTION)
    one, end_s = SHAFT_FRICTION, 0.9 * coasting.ramp_s

    def slowed(_t: float, y: list[float]) -> list[float]:
        return [y[1], -y[1] / one.time_constant_s - np.sign(y[1]) * one.deceleration]

    start = [1.0 + 2.0 * speed_rad_s, speed_rad_s]
    true = solve_ivp(slowed, (0.0, end_s), start, rtol=1e-10, atol=1e-12).y[:, -1]
    assert coasting.angle_and_speed(2.0 + end_s) == pytest.approx(tuple(true), rel=1e-6, abs=1e-8)
    assert coasting.angle_and_speed(2.0 + coasting.ramp_s + 1.0)[1] == 0.0


def test_a_turning_shaft_that_is_disabled_brakes_first_and_loses_its_power_at_rest(turned) -> None:
    rig, world, watch = turned
    rig.shaft.disable()
    cycles(rig, 3)
    assert world.nodes["shaft"].state is DriveState.QUICK_STOP_ACTIVE
    cycles(rig, 40)  # 1 Hz at 5 Hz/s is 20
    assert world.nodes["shaft"].state is DriveState.SWITCH_ON_DISABLED
    assert len(watch.seen) == 1
    assert not watch.while_moving
    assert not rig.faults


@pytest.mark.parametrize("command", ["enable", "reset_fault", "disable"])
def test_what_follows_a_quick_stop_at_once_waits_for_rest(turned, command: str) -> None:
    rig, world, watch = turned
    rig.shaft.quick_stop()
    cycles(rig, 3)
    getattr(rig.shaft, command)()
    cycles(rig, 60)
    assert watch.seen
    assert not watch.while_moving
    assert world.nodes["shaft"].torque is (command == "enable")
    assert not rig.faults


def test_a_drive_that_does_not_brake_loses_its_power_at_the_deadline_with_an_alarm(turned) -> None:
    rig, world, watch = turned
    inject(world, "runaway shaft 0.5")
    rig.shaft.disable()
    cycles(rig, 500)
    assert not watch.seen
    with pytest.raises(NotAtRestError, match="not at rest 500 cycles after its quick stop"):
        cycle_until_it_raises(rig)
    cycles(rig, 3)
    assert [one.speed for one in watch.seen] == [pytest.approx(0.5, rel=0.01)]
    assert rig.shaft.moving  # it coasts, and that is seen
    cycles(rig, 300)
    assert not rig.shaft.moving
    assert [type(one) for one in rig.faults] == [NotAtRestError]


@pytest.mark.parametrize(
    ("words", "kind"), [("sto shaft", DriveStateError), ("mains", DriveFaultError)]
)
def test_a_shaft_that_coasts_is_seen_to_move_until_it_rests(turned, words: str, kind) -> None:
    rig, world, watch = turned
    inject(world, words)
    cycles(rig, 3)
    assert any(isinstance(one, kind) for one in rig.faults)
    unseen = 0
    while world.plant.speed_rad_s:
        unseen += abs(world.nodes["shaft"].speed) > 0.01 and not rig.shaft.moving
        cycles(rig, 1)
    assert not unseen
    cycles(rig, 5)
    assert not rig.shaft.moving
    assert not watch.seen


def test_a_stale_position_counts_as_moving(turned) -> None:
    rig, world, _ = turned
    rig.shaft.stop()
    rig.run_until(lambda: not rig.shaft.moving, 300, "rest")
    inject(world, "silence shaft")
    cycles(rig, 10)
    assert rig.shaft.moving


def test_an_axis_is_moving_until_its_encoder_says_otherwise() -> None:
    with in_process(WHOLE) as (rig, world):
        ready(rig)
        watch = PowerWatch(world)
        rig.phase.move_to(3.0)
        cycles(rig, 100)
        rig.phase.stop()
        cycles(rig, 2)
        assert abs(world.nodes["phase"].speed) > 0.1
        assert rig.phase.moving
        rig.phase.disable()
        cycles(rig, 60)
        assert not rig.phase.moving
        assert watch.seen
        assert not watch.while_moving


@pytest.mark.slow
def test_whatever_is_asked_first_closing_takes_no_power_off_a_turning_shaft() -> None:
    with in_process(WHOLE) as (rig, world):
        turning(rig, 0.02, 0.5, 2.0)
        watch = PowerWatch(world)
        rig.quick_stop()
        rig.cycle()
        rig.close()
        assert {one.part for one in watch.seen} == {"shaft", "eccentricity", "phase"}
        assert not watch.while_moving
