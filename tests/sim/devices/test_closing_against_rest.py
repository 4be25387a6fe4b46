"""A rig that closes leaves its drives at rest and without power; a dead bus does not hold it up."""

import pytest

from hardware.cia402 import DriveState
from hardware.errors import BusOffError, DeadReceiveThreadError
from hardware.pacing import FreeRunning
from hardware.rig import Rig
from hardware.rig_configuration import read_rig
from sim.devices.bench_file import DRIVERS
from sim.devices.parts import Scene
from sim.devices.registry import running
from sim.devices.shaft_drive import ShaftDrive
from sim.devices.world import World
from sim.rig import vertical_rig
from tests.hardware.rigs import nobody
from tests.sim.devices.benches import WHOLE, by_word, in_process, ready, turning


def states(world) -> set[DriveState]:
    return {one.state for one in world.nodes.values() if hasattr(one, "state")}


@pytest.mark.slow
def test_a_turning_shaft_is_stopped_along_its_profile_and_all_power_taken_off() -> None:
    with in_process(WHOLE) as (rig, world):
        turning(rig, 0.02, 0.5, 1.0)
        before = rig.number
        rig.close()
        # 1 Hz at 1 Hz/s is 100 cycles of the profile; then the power goes.
        assert 100 <= rig.number - before <= 130
        assert abs(world.plant.speed_rad_s) < 1e-6
        assert states(world) == {DriveState.SWITCH_ON_DISABLED}
        rig.close()
        assert rig.number - before <= 130


def test_an_axis_is_stopped_on_its_way() -> None:
    with in_process(WHOLE) as (rig, world):
        ready(rig)
        rig.eccentricity.move_to(0.05)
        for _ in range(100):
            rig.cycle()
        moving = world.plant.linkage[0]
        rig.close()
        assert states(world) == {DriveState.SWITCH_ON_DISABLED}
        assert moving < world.plant.linkage[0] < moving + 0.001


def test_an_error_in_the_block_stops_the_shaft_too() -> None:
    seen = []

    def fails() -> None:
        with in_process({"shaft": WHOLE["shaft"]}) as (rig, world):
            seen.append(world)
            rig.shaft.enable()
            rig.run_until(lambda: rig.shaft.enabled, 100, "enable")
            rig.shaft.turn(2.0)
            rig.run_until(lambda: rig.shaft.at_speed, 1000, "speed")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fails()
    assert states(seen[0]) == {DriveState.SWITCH_ON_DISABLED}
    assert abs(seen[0].plant.speed_rad_s) < 1e-6


@pytest.mark.slow
def test_a_fault_on_the_way_makes_it_a_quick_stop() -> None:
    with in_process(WHOLE) as (rig, world):
        turning(rig, 0.02, 0.5, 1.0)
        by_word(world)("heartbeat phase")
        before = rig.number
        rig.close()
        assert rig.number - before < 60  # the quick-stop ramp is five times as steep
        shaft = world.nodes["shaft"]
        assert isinstance(shaft, ShaftDrive)
        assert shaft.state is DriveState.SWITCH_ON_DISABLED
        assert abs(world.plant.speed_rad_s) < 1e-6


@pytest.mark.slow
def test_a_fault_that_asks_for_a_profile_stop_leaves_it_at_that() -> None:
    with in_process(WHOLE) as (rig, world):
        turning(rig, 0.02, 0.5, 1.0)
        by_word(world)("broken force_aft")
        before = rig.number
        rig.close()
        assert 100 <= rig.number - before <= 130
        assert states(world) == {DriveState.SWITCH_ON_DISABLED}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "kind"), [("bus-off", BusOffError), ("deaf", DeadReceiveThreadError)]
)
@pytest.mark.parametrize("known", [True, False])
def test_a_lost_bus_does_not_hold_the_closing_up(words: str, kind, known: bool) -> None:
    with in_process(WHOLE) as (rig, world):
        turning(rig, 0.02, 0.5, 1.0)
        by_word(world)(words)
        if known:
            with pytest.raises(kind):
                rig.cycle()
        before = rig.number
        rig.close()
        assert rig.number - before <= (0 if known else 1)


@pytest.mark.slow
def test_a_node_that_says_nothing_any_more_bounds_the_closing() -> None:
    with in_process(WHOLE) as (rig, world):
        turning(rig, 0.02, 0.5, 1.0)
        by_word(world)("silence shaft")
        before = rig.number
        rig.close()
        # Four cycles until it is noticed, 5 s for a rest that nobody sees, five at the end.
        assert rig.number - before <= 4 + 500 + 5
        assert states(world) == {DriveState.SWITCH_ON_DISABLED}


def test_a_rig_that_was_never_prepared_closes_without_a_cycle() -> None:
    tables = {"bus": {"interface": "pmm-simulated", "channel": "looked-at"}, **WHOLE}
    tables["bus"]["receive_thread"] = False
    configuration = read_rig(tables, DRIVERS)
    world = World(configuration, Scene(vertical_rig()))
    with running("looked-at", world):
        rig = Rig(configuration, lambda: world.time_s, FreeRunning(), nobody)
        world.nodes["shaft"]._enter(5)
        rig.close()
        assert rig.number == 0
        assert world.nodes["shaft"].operational  # a look at the bus commands nobody's state
