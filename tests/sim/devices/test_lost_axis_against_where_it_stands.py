"""An axis over Modbus that was lost on its way: it stays where it stands until it is sent again."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from copy import deepcopy
from typing import Any

import pytest

from hardware.errors import HardwareError
from hardware.pacing import FreeRunning
from hardware.rig import Rig
from hardware.rig_configuration import read_rig
from sim.devices.bench_file import DRIVERS
from sim.devices.modbus_devices import SimulatedAngle
from sim.devices.parts import Scene
from sim.devices.registry import running
from sim.devices.world import World
from sim.rig import vertical_rig
from tests.hardware.rigs import nobody
from tests.sim.devices.modbus_tables import DRIFT

NAME = "lost-axis"
COUNT_RAD = 1.75e-4  # of the registers, 0.01 degrees: so far off a place can be told
SPEED_RAD_S = 0.05
# A device whose way is in its register goes on from the first question until it is told to stay:
# a question that reads where it is, and one that tells it, at 100 Hz.
HEARD_RAD = 4 * 0.01 * SPEED_RAD_S
ON_THE_WAY_RAD = (0.02, 0.28)


def table_of(framing: str, *left_out: str) -> dict[str, Any]:
    table = deepcopy(
        {**DRIFT, "port": {"url": f"sim://{NAME}/drift", "framing": framing}, "speed": SPEED_RAD_S}
    )
    for key in left_out:
        del table["registers"][key]
    return table


@contextmanager
def under_way(table: Mapping[str, Any]) -> Iterator[tuple[Rig, SimulatedAngle]]:
    """An axis that has been sent to 0.3 rad and is on its way there."""
    configuration = read_rig({"drift": table}, DRIVERS)
    world = World(configuration, Scene(vertical_rig()))
    device = world.talkers["drift"]
    with running(NAME, world), Rig(configuration, lambda: 0.0, FreeRunning(), nobody) as rig:
        rig.prepare()
        cycle(rig, 60)
        axis = rig.angles["drift"]
        axis.enable()
        cycle(rig, 60)
        axis.home()
        axis.move_to(0.3)
        cycle(rig, 50)
        assert isinstance(device, SimulatedAngle)
        assert ON_THE_WAY_RAD[0] < device.angle_rad < ON_THE_WAY_RAD[1]
        yield rig, device


def cycle(rig: Rig, cycles: int) -> None:
    for _ in range(cycles):
        with suppress(HardwareError):
            rig.cycle()


def lose(device: SimulatedAngle, lost: str) -> None:
    """Lose the link to a device, or its port; nothing of both brings it back."""
    device.mute, device.cable.plugged = lost == "link", lost != "plug"


def reset(rig: Rig) -> None:
    """Reset as an operator does who is told to wait until it stands."""
    for _ in range(5):
        try:
            rig.reset()
        except HardwareError:
            cycle(rig, 100)
        else:
            return
    raise AssertionError(rig.faults)


@pytest.mark.sample(8)
@pytest.mark.parametrize("framing", ["tcp", "rtu"])
@pytest.mark.parametrize("left_out", [(), ("command",), ("command", "status"), ("status",)])
@pytest.mark.parametrize("lost", ["link", "plug"])
@pytest.mark.parametrize("command", ["", "stop", "quick_stop", "disable"])
def test_nothing_moves_it_but_a_command(framing, left_out, lost, command) -> None:
    with under_way(table_of(framing, *left_out)) as (rig, device):
        lose(device, lost)
        cycle(rig, 150)  # the device stands by itself after a second
        if command:
            getattr(rig.angles["drift"], command)()
        cycle(rig, 150)
        stood_before_rad = device.angle_rad
        assert ON_THE_WAY_RAD[0] < stood_before_rad < ON_THE_WAY_RAD[1]
        lose(device, "")
        cycle(rig, 300)
        assert device.angle_rad == pytest.approx(stood_before_rad, abs=HEARD_RAD)
        reset(rig)
        cycle(rig, 100)
        stood_rad = device.angle_rad
        assert stood_rad == pytest.approx(stood_before_rad, abs=HEARD_RAD)
        rig.angles["drift"].enable()
        cycle(rig, 200)
        assert device.angle_rad == pytest.approx(stood_rad, abs=COUNT_RAD)
        rig.angles["drift"].move_to(0.1)
        cycle(rig, 300)
        assert device.angle_rad == pytest.approx(0.1, abs=COUNT_RAD)
        assert rig.angles["drift"].settled
        assert rig.faults == []


@pytest.mark.parametrize("left_out", [(), ("command",)])
def test_stopped_in_a_short_silence_it_does_not_go_back(left_out) -> None:
    with under_way(table_of("tcp", *left_out)) as (rig, device):
        lose(device, "link")
        cycle(rig, 50)  # it goes on, unheard, for 25 mrad
        rig.angles["drift"].stop()
        lose(device, "")
        before_rad = device.angle_rad
        for _ in range(200):
            cycle(rig, 1)
            assert (
                before_rad - COUNT_RAD <= device.angle_rad <= before_rad + 25 * SPEED_RAD_S * 0.01
            )
        assert rig.faults == []


@pytest.mark.parametrize("command", ["stop", "quick_stop", "disable", "reset_fault", "reconnect"])
def test_turned_by_hand_without_power_it_stays_when_it_is_enabled(command) -> None:
    with under_way(table_of("tcp")) as (rig, device):
        getattr(rig.angles["drift"], command)()
        cycle(rig, 50)
        rig.angles["drift"].disable()
        cycle(rig, 50)
        device.angle_rad = 0.25
        cycle(rig, 100)
        rig.angles["drift"].enable()
        for _ in range(200):
            cycle(rig, 1)
            assert device.angle_rad == pytest.approx(0.25, abs=COUNT_RAD)
        assert rig.angles["drift"].enabled


@pytest.mark.parametrize("left_out", [(), ("command",)])
def test_in_a_persons_hand_it_is_told_nothing_old(left_out) -> None:
    with under_way(table_of("tcp", *left_out)) as (rig, device):
        device.local = True
        cycle(rig, 50)
        device.angle_rad = 0.2
        cycle(rig, 50)
        device.local = False
        cycle(rig, 200)
        assert not rig.angles["drift"].enabled
        if not left_out:  # without power nothing moves it; else it is held once it is heard
            assert device.angle_rad == 0.2
        assert device.angle_rad == pytest.approx(0.2, abs=0.02)
        reset(rig)
        rig.angles["drift"].enable()
        stood_rad = device.angle_rad
        cycle(rig, 200)
        assert device.angle_rad == pytest.approx(stood_rad, abs=COUNT_RAD)
