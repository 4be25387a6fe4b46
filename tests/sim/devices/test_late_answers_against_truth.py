"""Answers that come too late, from devices that do not number them: what is read stays true."""

from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from copy import deepcopy
from typing import Any

import pytest

from hardware.description.errors import ConfigurationError
from hardware.pacing import FreeRunning
from hardware.rig import Rig
from hardware.rig_configuration import read_rig
from sim.devices.bench_file import DRIVERS
from sim.devices.modbus_devices import SimulatedCarriage
from sim.devices.parts import Scene
from sim.devices.registry import running
from sim.devices.world import World
from sim.rig import vertical_rig
from tests.hardware.rigs import nobody
from tests.sim.devices.line_tables import PANEL
from tests.sim.devices.modbus_tables import CARRIAGE

NAME = "late-answers"
SPEED_M_S = 0.5
USUAL = 2  # cycles of 10 ms that an answer takes; the limit, answer_s, is 20
NEXT_WRITE = 60  # cycles until a write in refresh_s, and the quiet line after it


def registers() -> dict[str, Any]:
    """Two readings alike: answers of the same length, in registers that are asked for apart."""
    table = deepcopy({**CARRIAGE, "port": {"framing": "rtu"}})
    floats = {"type": "float32", "table": "input"}
    table["registers"] = {
        "set_speed": CARRIAGE["registers"]["set_speed"],
        "speed": {"address": 10, "unit": "m/s", **floats},
        "position": {"address": 20, "unit": "m", **floats},
    }
    return table


def panel() -> dict[str, Any]:
    """The same in lines of text: both readings are a number alone."""
    table = deepcopy({**PANEL, "port": {}, "track_m": [0.0, 60.0]})
    table["lines"]["speed"] = {"line": "RS", "answer": "{value}", "unit": "m/s"}
    table["lines"]["position"] = {"line": "RP", "answer": "{value}", "unit": "m"}
    return table


class LateCable:
    """Holds back what a device answers, in order; ``once`` says for how many cycles the next."""

    def __init__(self, device: SimulatedCarriage) -> None:
        self.once = 0
        self._device, self._answer, self._cycle = device, device.tick, 0
        self._held: deque[tuple[int, bytes]] = deque()
        device.tick = self.tick

    def tick(self, *given: Any) -> None:
        self._cycle += 1
        self._answer(*given)
        waiting = self._device.cable.waiting
        if waiting:
            last = self._held[-1][0] if self._held else 0
            due, self.once = self._cycle + (self.once or USUAL), 0
            self._held.append((max(due, last + USUAL), bytes(waiting)))
            waiting.clear()
        while self._held and self._held[0][0] <= self._cycle:
            waiting += self._held.popleft()[1]


@contextmanager
def towing(table: dict[str, Any]) -> Iterator[tuple[Rig, SimulatedCarriage, LateCable]]:
    """A carriage that runs at 0.5 m/s."""
    table["port"]["url"] = f"sim://{NAME}/carriage"
    configuration = read_rig({"carriage": table}, DRIVERS)
    world = World(configuration, Scene(vertical_rig()))
    device = world.talkers["carriage"]
    assert isinstance(device, SimulatedCarriage)
    cable = LateCable(device)
    with running(NAME, world), Rig(configuration, lambda: 0.0, FreeRunning(), nobody) as rig:
        rig.prepare()
        rig.run_until(lambda: rig.devices[0].is_answering, 100, "answers")
        rig.carriage.enable()
        rig.run_until(lambda: rig.carriage.enabled, 100, "enabled")
        rig.carriage.run_at(SPEED_M_S)
        rig.run_until(lambda: rig.carriage.at_speed, 1000, "speed")
        yield rig, device, cable


def is_true(rig: Rig, device: SimulatedCarriage, speed_m_s: float = SPEED_M_S) -> bool:
    """Whether speed and place are read right, the place as old as silence allows."""
    behind_m = device.position_m - rig.carriage.position_m
    return abs(rig.carriage.measured_speed_m_s - speed_m_s) < 0.01 and -1e-6 < behind_m < SPEED_M_S


@pytest.mark.parametrize("table", [registers, panel])
@pytest.mark.parametrize("late", [19, 20, 21, 22, 25, 30, 38, 39, 40])
@pytest.mark.parametrize("begins", [0, 3, 6])
def test_one_late_answer_is_none_to_the_next_question(table, late, begins) -> None:
    with towing(table()) as (rig, device, cable):
        for _ in range(begins):
            rig.cycle()
        cable.once = late
        for _ in range(400):
            rig.cycle()
            assert is_true(rig, device)
        assert rig.faults == []


@pytest.mark.parametrize("late", [42, 45, 60])
def test_an_answer_later_than_the_quiet_line_is_seen_by_the_next_write(late) -> None:
    with towing(registers()) as (rig, device, cable):
        cable.once = late
        for _ in range(late + NEXT_WRITE):
            rig.cycle()
        for _ in range(200):
            rig.cycle()
            assert is_true(rig, device)


@pytest.mark.parametrize("table", [registers, panel])
def test_a_reset_with_an_answer_under_way_does_not_take_it_for_another(table) -> None:
    with towing(table()) as (rig, device, cable):
        rig.carriage.stop()
        rig.run_until(lambda: not rig.carriage.moving, 300, "rest")
        cable.once = 12
        for _ in range(5):
            rig.cycle()
        rig.devices[0].reconnect()
        rig.run_until(lambda: rig.devices[0].is_answering, 100, "answers")
        for _ in range(100):
            rig.cycle()
            assert is_true(rig, device, 0.0)


@pytest.mark.parametrize("table", [registers, panel])
def test_a_lost_answer_has_to_be_asked_for_again_before_it_is_silence(table) -> None:
    settings = {**table(), "answer_s": 0.5, "silent_s": 1.0}
    settings["port"]["url"] = "/dev/null"
    with pytest.raises(ConfigurationError, match=r"below silent_s = 1: .* again after 1 s"):
        read_rig({"carriage": settings}, DRIVERS)
