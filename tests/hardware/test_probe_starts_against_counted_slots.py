"""A shaft that starts anywhere: the probe's pulses against the slots that its double passed."""

import numpy as np
import pytest

from hardware.errors import HardwareError
from tests.hardware.rigs import COUNTS_PER_TURN, SHAFT, on_bus, slotted, two_drives

TABLES = {"shaft": SHAFT, "photocell": {"driver": "touch-probe"}}
STARTS = 40


def build(network):
    drives = two_drives(network)
    slotted(drives["shaft"])
    return drives


def turn(rig, cycles: int) -> list[str]:
    """Run cycles; return what was alarmed."""
    alarms = []
    for _ in range(cycles):
        try:
            rig.cycle()
        except HardwareError as error:
            alarms.append(str(error))
    return alarms


@pytest.mark.slow
def test_no_start_without_a_fault_is_alarmed_and_no_pulse_is_lost() -> None:
    generator = np.random.default_rng(23)
    with on_bus(TABLES, build) as (rig, drives):
        shaft, alarms, found = drives["shaft"], [], []
        shaft.position = generator.random() * COUNTS_PER_TURN
        begin = shaft.position // COUNTS_PER_TURN
        turn(rig, 3)
        for _ in range(STARTS):
            rig.shaft.enable()
            alarms += turn(rig, 10)
            frequency_hz = float(generator.uniform(0.5, 2.0))
            rig.shaft.turn(frequency_hz)
            alarms += turn(rig, 4)
            if generator.random() < 0.8:  # the others end before they are at speed
                rig.photocell.expect(frequency_hz)
            alarms += turn(rig, int(generator.integers(130)))
            rig.photocell.expect(None)
            alarms += turn(rig, int(generator.integers(30)))
            rig.shaft.stop()
            alarms += turn(rig, 4)
            rig.shaft.disable()
            alarms += turn(rig, 3)
            found += rig.photocell.take()
        assert alarms == []
        slots = int(shaft.position // COUNTS_PER_TURN - begin)
        assert len(found) == slots > STARTS // 2
        assert np.diff([one.number for one in found]).tolist() == [1] * (slots - 1)
        assert np.diff([one.shaft_angle_rad for one in found]) / (2 * np.pi) == pytest.approx(1.0)


def test_a_pulse_too_many_is_still_seen_at_once_while_the_shaft_turns() -> None:
    with on_bus(TABLES, build) as (rig, drives):
        rig.shaft.enable()
        turn(rig, 10)
        rig.shaft.turn(1.0)
        alarms = turn(rig, 230)
        assert alarms == []
        shaft = drives["shaft"]
        shaft.photocell = lambda before, after: after  # an edge in every SYNC
        alarms = turn(rig, 2)
        assert len(alarms) == 2
        assert "pulses within" in alarms[0]
