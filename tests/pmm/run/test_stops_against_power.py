"""Stopped in whatever state: no command takes the power off an axis that still moves."""

from dataclasses import replace

import pytest

from pmm.run.states import Command, State
from tests.pmm.run.harness import TABLES, bench, oscillation
from tests.sim.devices.power_watch import PowerWatch

FAST = {**TABLES, "phase": {**TABLES["phase"], "speed": 0.8, "acceleration": 2.0}}


@pytest.mark.sample(1)
@pytest.mark.parametrize("command", [Command.STOP, Command.QUICK_STOP])
@pytest.mark.parametrize("state", [State.SETTING, State.STARTING, State.ARMED, State.STOPPING])
def test_power_goes_at_rest_only(tmp_path, command: Command, state: State) -> None:
    short = oscillation()
    far = replace(short, set_point=replace(short.set_point, strut_phase_rad=2.5))
    with bench(tmp_path, [far], tables=FAST) as one:
        watch = PowerWatch(one.world)
        one.until(state)
        for _ in range(60):
            one.control.step()
        one.control.request(command)
        one.finish()
        assert one.control.state is State.STOPPED
        for _ in range(3):
            one.control.step()
        assert {seen.part for seen in watch.seen} == {"shaft", "eccentricity", "phase"}
        assert not watch.while_moving
