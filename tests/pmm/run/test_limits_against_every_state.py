"""Speed and load limits hold in every state, in either sense; a reset needs a shaft that stands."""

import pytest

from hardware.errors import NotReadyError
from pmm.plan.rig_tables import Gauge
from pmm.run.states import Command, State
from sim.devices.faults import inject
from tests.pmm.run.harness import bench, oscillation
from tests.sim.devices.power_watch import REST_SPEEDS, PowerWatch

LONG = {"periods": 30, "max_periods": 30, "pause_before_s": 2.0}
STATES = [
    State.IDLE,
    State.SETTING,
    State.PAUSING,
    State.SETTLING,
    State.GATE_OPEN,
    State.STOPPING,
    State.STOPPED,
]
GAUGES = (Gauge("force_fore", 400.0, safe_load_n=300.0),)


def reach(one, state: State) -> None:
    """Bring run control to a state."""
    if state is State.IDLE:
        for _ in range(20):
            one.control.step()
        return
    one.control.request(Command.START)
    if state in (State.STOPPING, State.STOPPED):
        one.until(State.GATE_OPEN)
        one.control.request(Command.STOP)
    one.until(state)


def steps(one, count: int) -> None:
    for _ in range(count):
        one.control.step()


@pytest.mark.sample(3)
@pytest.mark.parametrize("frequency_hz", [3.0, -3.0])
@pytest.mark.parametrize("state", STATES)
def test_overspeed_either_way_is_a_fault(tmp_path, state: State, frequency_hz: float) -> None:
    with bench(tmp_path, [oscillation(**LONG)], start=False) as one:
        reach(one, state)
        inject(one.world, f"drag shaft {frequency_hz}")
        steps(one, 60)
        assert one.control.state is State.FAULT
        assert "OverspeedError" in [type(fault).__name__ for fault in one.rig.faults]
        assert any("limit 2.1 Hz either way" in str(fault) for fault in one.rig.faults)
        inject(one.world, "free shaft")
        one.finish()


@pytest.mark.slow
@pytest.mark.parametrize("frequency_hz", [3.0, -3.0])
def test_a_drive_that_runs_away_loses_its_power_at_the_deadline(tmp_path, frequency_hz) -> None:
    with bench(tmp_path, [oscillation(**LONG)]) as one:
        watch = PowerWatch(one.world)
        one.until(State.GATE_OPEN)
        steps(one, 100)
        came_s = one.world.time_s
        inject(one.world, f"runaway shaft {frequency_hz}")
        one.finish()
        lost = next(seen for seen in watch.seen if seen.part == "shaft")
        assert 5.0 < lost.time_s - came_s < 6.0
        assert "NotAtRestError" in [type(fault).__name__ for fault in one.rig.faults]
        # It has coasted, and was recorded meanwhile.
        assert abs(one.world.nodes["shaft"].speed) < REST_SPEEDS["shaft"]


@pytest.mark.slow
def test_a_quick_stop_that_a_drive_does_not_obey_takes_its_power_at_the_deadline(tmp_path) -> None:
    with bench(tmp_path, [oscillation(**LONG)]) as one:
        watch = PowerWatch(one.world)
        one.until(State.GATE_OPEN)
        inject(one.world, "runaway shaft 1.0")
        came_s = one.world.time_s
        one.control.request(Command.QUICK_STOP)
        one.finish()
        lost = next(seen for seen in watch.seen if seen.part == "shaft")
        assert lost.time_s - came_s == pytest.approx(5.0, abs=0.05)


@pytest.mark.sample(3)
@pytest.mark.parametrize("state", STATES)
def test_a_load_beyond_the_safe_one_is_a_fault(tmp_path, state: State) -> None:
    runs = [oscillation(**LONG)]
    with bench(tmp_path, runs, gauges=GAUGES, start=False) as one:
        reach(one, state)
        inject(one.world, "push force_fore -480")
        steps(one, 3)
        assert one.control.state is State.FAULT
        found = [str(fault) for fault in one.rig.faults if "safe load, 300 N" in str(fault)]
        assert len(found) == 1


@pytest.mark.slow
@pytest.mark.parametrize("turns_hz", [1.9, 0.6, -0.83])
def test_another_frequency_than_the_runs_ends_the_gate(tmp_path, turns_hz: float) -> None:
    with bench(tmp_path, [oscillation(frequency_hz=0.83, **LONG)]) as one:
        one.until(State.GATE_OPEN)
        steps(one, 150)
        inject(one.world, f"runaway shaft {turns_hz}")
        steps(one, 40)
        assert type(one.control.fault).__name__ == "FrequencyError"
        assert "0.83 Hz" in str(one.control.fault)
        one.finish()
        assert one.control.outcomes[0].outcome == "fault"


@pytest.mark.slow
def test_a_shaft_that_turns_while_it_has_to_stand_is_a_fault(tmp_path) -> None:
    short = oscillation(periods=1, max_periods=1)
    with bench(tmp_path, [short, oscillation("next", **LONG)]) as one:
        one.until(State.DONE)
        one.until(State.PAUSING)
        inject(one.world, "runaway shaft 0.05")
        steps(one, 130)
        assert "nothing told it to" in str(one.control.fault)


@pytest.mark.parametrize("turns_hz", [0.5, -0.05])
@pytest.mark.parametrize("by", ["runaway", "drag"])
def test_a_shaft_that_does_not_come_to_rest_for_homing_is_a_fault(
    tmp_path, by: str, turns_hz: float
) -> None:
    with bench(tmp_path, [oscillation(**LONG)], start=False) as one:
        inject(one.world, f"{by} shaft {turns_hz}")
        steps(one, 20)
        one.control.request(Command.START)
        steps(one, 200)
        assert one.control.state is State.HOMING  # 1 s, and 1.5 ramps from 2 Hz at 2 Hz/s
        steps(one, 70)
        assert one.control.state is State.FAULT
        assert "shaft: moves for 2.5 s" in str(one.control.fault)
        inject(one.world, "free shaft")
        one.finish()


def test_a_shaft_that_coasts_when_a_plan_is_started_is_braked_and_waited_for(tmp_path) -> None:
    with bench(tmp_path, [oscillation(**LONG)], start=False) as one:
        inject(one.world, "drag shaft 1.5")
        steps(one, 20)
        inject(one.world, "free shaft")
        one.control.request(Command.START)
        one.until(State.SETTING)
        assert one.at_rest()


@pytest.mark.slow
def test_a_reset_is_refused_while_the_shaft_turns(tmp_path) -> None:
    with bench(tmp_path, [oscillation(**LONG)]) as one:
        one.until(State.GATE_OPEN)
        inject(one.world, "drag shaft 0.5")
        inject(one.world, "emergency shaft 4210")
        one.finish()
        assert one.control.state is State.FAULT
        with pytest.raises(NotReadyError, match="cannot reset while shaft moves"):
            one.control.request(Command.RESET)
        assert one.control.state is State.FAULT
        assert one.rig.faults
        inject(one.world, "free shaft")
        inject(one.world, "sto shaft")
        for _ in range(400):
            one.control.step()
        inject(one.world, "release shaft")
        one.control.request(Command.RESET)
        assert one.control.state is State.IDLE
        assert not one.rig.faults
