"""A carriage behind voltages: counts by hand, in the very frames, and a module left alone."""

import struct
from copy import deepcopy

import pytest

from hardware.analogue_link import AnalogueNumber
from hardware.description.errors import ConfigurationError
from hardware.errors import HardwareError
from hardware.rig_configuration import read_rig
from sim.devices.bench_file import DRIVERS
from sim.devices.faults import inject
from tests.hardware.rigs import bus_table
from tests.sim.devices.benches import in_process
from tests.sim.devices.line_tables import VOLTAGES

# 1.5 m/s at -0.4 m/s per volt and an offset of 0.25 V is -3.5 V, of 10 V over 32767 counts.
COUNTS, ZERO_COUNTS = -11468, 819


def at_speed(rig) -> None:
    rig.carriage.enable()
    rig.run_until(lambda: rig.carriage.enabled, 100, "enable")
    rig.carriage.run_at(1.5)
    rig.run_until(lambda: rig.carriage.at_speed, 800, "speed")


def test_counts_are_those_by_hand() -> None:
    one = AnalogueNumber(object="6411:2", per_volt=-0.4, offset_v=0.25)
    assert one.written(1.5) == (COUNTS & 0xFFFF,)
    assert one.written(0.0) == (ZERO_COUNTS,)
    assert one.value((COUNTS & 0xFFFF,)) == pytest.approx(1.5, abs=2e-4)
    with pytest.raises(ConfigurationError, match=r"is 12\.75 V, beyond 10 V"):
        one.written(-5.0)


def test_the_frames_carry_them_and_a_module_left_alone_goes_to_rest() -> None:
    with in_process({"carriage": VOLTAGES}) as (rig, world):
        sent = {}
        rig.master._observers = (lambda frame: sent.update({frame.arbitration_id: frame.data}),)
        rig.cycle()
        assert bytes(sent[0x209]) == struct.pack("<h", ZERO_COUNTS)
        at_speed(rig)
        assert bytes(sent[0x209]) == struct.pack("<h", COUNTS)
        (read,) = struct.unpack("<h", bytes(sent[0x189]))
        assert read == pytest.approx((1.5 / 0.5 - 0.1) * 3276.7, abs=2.0)
        node = world.nodes["carriage"]
        assert node.values[0x6444, 2] == ZERO_COUNTS
        for _ in range(500):  # nobody sends SYNC or heartbeat any more
            world.live()
        assert world.plant.conditions.carriage_speed_m_s == pytest.approx(0.0, abs=1e-3)


def test_a_module_that_falls_silent_is_told_and_the_carriage_not_said_to_stand() -> None:
    with in_process({"carriage": VOLTAGES}) as (rig, world):
        at_speed(rig)
        inject(world, "silence carriage")
        told = []
        for _ in range(200):
            try:
                rig.cycle()
            except HardwareError as error:
                told.append(type(error).__name__)
        assert told
        assert rig.carriage.moving
        assert rig.faults


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("per_volt", 0.0, "per_volt = 0"),
        ("per_volt", 0.1, "beyond 10 V"),
        ("object", "output 1", "is no object"),
        ("offset", 1.0, "offset"),
    ],
)
def test_voltages_that_cannot_be_are_refused(key, value, said) -> None:
    table = deepcopy(VOLTAGES)
    table["voltages"]["set_speed"][key] = value
    with pytest.raises(ConfigurationError, match=said):
        read_rig({"bus": bus_table("none", "virtual"), "carriage": table}, DRIVERS)
