"""What a Modbus device or its map can get wrong: one fault each, one sentence, with a remedy."""

import math
import random
import re
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from copy import deepcopy
from typing import Any

import pytest

from hardware.description.errors import ConfigurationError
from hardware.errors import HardwareError, NotReadyError
from hardware.pacing import FreeRunning
from hardware.rig import Rig
from hardware.rig_configuration import read_rig
from sim.devices.bench_file import DRIVERS
from sim.devices.faults import inject
from sim.devices.parts import Scene
from sim.devices.registry import running
from sim.devices.world import World
from sim.rig import vertical_rig
from tests.hardware.rigs import nobody
from tests.sim.devices.modbus_tables import CARRIAGE

NAME = "modbus-faults"
PORT = {"url": f"sim://{NAME}/carriage"}


def other(*path: Any) -> dict[str, Any]:
    """The carriage's table with another value at a place."""
    table = deepcopy({**CARRIAGE, "port": PORT})
    *way, key, value = path
    at = table
    for one in way:
        at = at[one]
    at[key] = value
    return table


@contextmanager
def carriage_of(table: Mapping[str, Any], device: Mapping[str, Any]) -> Iterator[tuple[Rig, World]]:
    """A rig that believes one map, and a device that has another."""
    world = World(read_rig({"carriage": device}, DRIVERS), Scene(vertical_rig()))
    rig_of = read_rig({"carriage": table}, DRIVERS)
    with running(NAME, world), Rig(rig_of, lambda: 0.0, FreeRunning(), nobody) as rig:
        rig.prepare()
        yield rig, world


def faults_of(rig: Rig, cycles: int) -> list[str]:
    """Cycle; return what was raised, in words."""
    found = []
    for _ in range(cycles):
        try:
            rig.cycle()
        except HardwareError as error:
            found.append(f"{type(error).__name__}: {error}")
    return found


@pytest.mark.sample(1)
@pytest.mark.parametrize("framing", ["tcp", "rtu"])
@pytest.mark.parametrize(
    ("words", "kind", "remedy"),
    [
        ("refuse carriage 1", "ModbusError", "1, illegal function; the device has no such table"),
        ("refuse carriage 2", "ModbusError", "2, illegal address; correct address, type or table"),
        ("refuse carriage 3", "ModbusError", "3, illegal value; correct type, scale or unit"),
        ("refuse carriage 4", "ModbusError", "4, device failure; look at its own display"),
        ("refuse carriage 11", "ModbusError", "11, gateway target .*; correct unit_id"),
        ("refuse carriage 77", "ModbusError", "77, unknown to us; look into the device's manual"),
        ("refuse carriage 6", "SilentPortError", "says that it is busy; ask it less often"),
        ("tear carriage", "SilentPortError", "bytes are no whole frame .*; check framing"),
        ("unit carriage 9", "SilentPortError", "unit 9 answers where 1 was asked; correct unit_id"),
        ("silence carriage", "SilentPortError", "check its power, the cable and unit_id"),
        ("stale carriage", "SilentPortError", "its counter stands .* whether its program runs"),
    ],
)
def test_each_fault_is_told_once_with_its_remedy(framing, words, kind, remedy) -> None:
    table = other("port", {**PORT, "framing": framing})
    with carriage_of(table, table) as (rig, world):
        assert faults_of(rig, 50) == []
        inject(world, words)
        (told,) = faults_of(rig, 200)
        assert told.startswith(f"{kind}: carriage: ")
        assert re.search(remedy, told), told


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("path", "kind", "remedy"),
    [
        (("registers", "speed", "words", "low-first"), "SensorInvalidError", "words"),
        (("registers", "speed", "address", 40), "ModbusError", "register 40: exception 2"),
        (("registers", "speed", "table", "holding"), "ModbusError", "register 10: exception 2"),
        (("registers", "set_speed", "words", "high-first"), "TransitionTimeoutError", "words"),
        (("registers", "set_speed", "scale", 1.0), "TransitionTimeoutError", "scale, words"),
        (("registers", "set_speed", "address", 110), "TransitionTimeoutError", "scale, words"),
        (("unit_id", 4), "SilentPortError", "unit 1 answers where 4 was asked"),
        (("settle_s", 0.4), "", ""),
    ],
)
def test_a_wrong_map_is_told_before_a_run_begins(path, kind, remedy) -> None:
    with carriage_of(other(*path), other("port", PORT)) as (rig, _):
        found = faults_of(rig, 150)
        if rig.faults:
            assert kind in found[0]
            assert remedy in found[0]
            return
        rig.carriage.enable()
        found = faults_of(rig, 20)
        rig.carriage.run_at(1.0)
        found += faults_of(rig, 1500)
        assert (kind == "") == (found == [])
        assert all(kind in one and remedy in one for one in found)
        assert rig.carriage.at_speed == (kind == "")


def test_a_speed_that_is_no_number_is_no_speed() -> None:
    table = other("port", PORT)
    with carriage_of(table, table) as (rig, world):
        rig.carriage.enable()
        faults_of(rig, 30)
        rig.carriage.run_at(0.5)
        faults_of(rig, 50)
        device = world.talkers["carriage"]
        device.move = lambda _step_s: device.show(rig.configuration.carriage.settings.registers
                                                  .speed, math.nan)  # fmt: skip
        found = faults_of(rig, 700)
        assert not rig.carriage.at_speed
        assert rig.carriage.moving
        assert found[0].startswith("SensorInvalidError: carriage: reads nan m/s")


@pytest.mark.parametrize("place_m", [math.nan, math.inf, -math.inf])
def test_a_place_that_is_no_number_stops_it_and_does_not_let_it_start(place_m) -> None:
    table = other("registers", "position", {"address": 12, "unit": "m", "type": "float32",
                                            "table": "input"})  # fmt: skip
    table["port"] = PORT
    with carriage_of(table, table) as (rig, world):
        device, position = world.talkers["carriage"], rig.configuration.carriage.settings.registers
        rig.carriage.enable()
        faults_of(rig, 30)
        rig.carriage.run_at(0.5)
        assert faults_of(rig, 300) == []
        move = device.move

        def without_place(step_s: float) -> None:
            move(step_s)
            device.show(position.position, place_m)

        device.move = without_place
        (told,) = faults_of(rig, 300)
        assert told.startswith(f"SensorInvalidError: carriage: reads {place_m:g} m as its place")
        assert rig.carriage.measured_speed_m_s == 0.0
        rig.reset()
        rig.carriage.enable()
        assert len(faults_of(rig, 30)) == 1  # it is told again: nothing has changed
        with pytest.raises(HardwareError, match="reset first"):
            rig.carriage.run_at(0.5)
        with pytest.raises(NotReadyError, match="as its place; look at its sensor"):
            rig.devices[0].run_at(0.5)


def test_without_pymodbus_it_is_said_what_to_install(monkeypatch) -> None:
    monkeypatch.setitem(sys.modules, "pymodbus.framer", None)
    table = other("port", PORT)
    with pytest.raises(ConfigurationError, match=r"pip install planar-motion-mechanism\[modbus\]"):
        carriage_of(table, table).__enter__()


@pytest.mark.parametrize("framing", ["tcp", "rtu"])
def test_no_bytes_end_the_program(framing) -> None:
    """Random bytes among the answers: faults of the device, never of the program."""
    table = other("port", {**PORT, "framing": framing})
    dice = random.Random(1963)  # noqa: S311
    with carriage_of(table, table) as (rig, world):
        cable = world.talkers["carriage"].cable
        for _ in range(300):
            cable.waiting += dice.randbytes(dice.randrange(40))
            if dice.random() < 0.3 and cable.waiting:
                cable.waiting[dice.randrange(len(cable.waiting))] ^= 1 << dice.randrange(8)
            for told in faults_of(rig, dice.randrange(1, 8)):
                assert "ProgramError" not in told, told
                assert told.count("\n") == 0
        cable.waiting.clear()
        faults_of(rig, 50)
        assert rig.carriage.measured_speed_m_s == 0.0


@pytest.mark.parametrize(
    ("path", "told"),
    [
        (("registers", "speed", "address", 70000), "address = 70000; addresses are 0 to 65535"),
        (("registers", "speed", "scale", 0.0), "scale = 0"),
        (("registers", "speed", "type", "int64"), "'int16', 'uint16'"),
        (("registers", "set_speed", "type", "int16"), "does not hold 60000 counts"),
        (("registers", "status", "alarm", 16), "each is 0 to 15"),
        (("registers", "status", "alarm", 0), "stands once"),
        (("registers", "sped", {"address": 1, "unit": "m/s"}), "registers.sped"),
        (("unit_id", 256), "unit_id = 256; it is 0 to 255"),
        (("answer_s", 2.0), "below silent_s"),
        (("track_m", [60.0, 0.0]), "the start has to be below the end"),
        (("return_speed_m_s", 4.0), "return_speed_m_s is above"),
        (("acceleration_m_s2", -1.0), "has to be above 0"),
    ],
)
def test_a_map_that_cannot_be_is_refused_when_it_is_read(path, told) -> None:
    table = other(*path)
    if path[-1] == "int16":
        table["registers"]["set_speed"]["scale"] = 0.05
    with pytest.raises(ConfigurationError, match=told):
        read_rig({"carriage": table}, DRIVERS)
