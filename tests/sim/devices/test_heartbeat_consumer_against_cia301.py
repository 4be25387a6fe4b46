"""When a node begins to watch a heartbeat and when not any more, after CiA 301, by raw frames."""

import json
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from itertools import count
from pathlib import Path

import can
import pytest

from hardware.rig_configuration import read_rig
from sim.devices.bench_file import DRIVERS
from sim.devices.bus import SimulatedBus
from sim.devices.parts import Scene
from sim.devices.plant import PlantConditions
from sim.devices.registry import running
from sim.devices.world import World
from sim.rig import vertical_rig
from tests.sim.devices.benches import ROOT, WHOLE, Hosted, multicast_works
from tests.sim.devices.test_killed_controller_against_time import CONTROLLER

_NAMES = count()
WATCH_127_FOR_300_MS = "23161001" + "2c017f00"
PAUSE_S = 1.0  # longer than the drive's patience with its controller
EMERGENCY_OF_1, BOOT_OR_BEAT_OF_1 = 0x081, 0x701


class Line:
    """A bus with one simulated drive, by frames alone."""

    def __init__(self, bus: SimulatedBus) -> None:
        self._bus = bus

    def send(self, identifier: int, data: str) -> list[tuple[int, str]]:
        """Send a frame; return what comes back."""
        self._bus.send(
            can.Message(arbitration_id=identifier, data=bytes.fromhex(data), is_extended_id=False)
        )
        found = []
        while (frame := self._bus.recv(0.0)) is not None:
            found.append((frame.arbitration_id, bytes(frame.data).hex()))
        return found

    def pass_s(self, seconds: float) -> list[tuple[int, str]]:
        """Let time pass, which SYNC alone tells at 100 Hz; return what came."""
        return [one for _ in range(round(100 * seconds)) for one in self.send(0x080, "")]


@pytest.fixture
def line() -> Iterator[Line]:
    name = f"line-{next(_NAMES)}"
    bus = {"interface": "pmm-simulated", "channel": name, "receive_thread": False}
    configuration = read_rig({"bus": bus, "shaft": WHOLE["shaft"]}, DRIVERS)
    world = World(configuration, Scene(vertical_rig(), PlantConditions()))
    with running(name, world), SimulatedBus(name) as opened:
        yield Line(opened)


def _lost(frames: list[tuple[int, str]]) -> int:
    """Count emergencies 0x8130 (little end first: 3081)."""
    return sum(at == EMERGENCY_OF_1 and data.startswith("3081") for at, data in frames)


@pytest.mark.parametrize("state", ["8001", "0101"])
def test_monitoring_starts_with_the_first_heartbeat_in_every_state(line: Line, state: str) -> None:
    line.send(0x000, state)  # NMT: pre-operational, operational
    assert line.send(0x601, WATCH_127_FOR_300_MS) == [(0x581, "6016100100000000")]
    assert _lost(line.pass_s(5.0)) == 0
    line.send(0x77F, "05")
    assert _lost(line.pass_s(0.29)) == 0
    assert _lost(line.pass_s(0.1)) == 1
    assert _lost(line.pass_s(5.0)) == 0  # told once


def test_another_nodes_heartbeat_is_not_watched(line: Line) -> None:
    line.send(0x601, WATCH_127_FOR_300_MS)
    line.send(0x77E, "05")
    assert _lost(line.pass_s(2.0)) == 0


@pytest.mark.parametrize("again", ["configured", "reset"])
def test_a_heartbeat_of_before_does_not_count(line: Line, again: str) -> None:
    line.send(0x601, WATCH_127_FOR_300_MS)
    line.send(0x77F, "05")
    if again == "reset":
        assert (BOOT_OR_BEAT_OF_1, "00") in line.send(0x000, "8201")
        assert line.send(0x601, "4016100100000000") == [(0x581, "4316100100000000")]  # forgotten
        assert _lost(line.pass_s(2.0)) == 0
    line.send(0x601, WATCH_127_FOR_300_MS)
    assert _lost(line.pass_s(2.0)) == 0
    line.send(0x77F, "05")
    assert _lost(line.pass_s(2.0)) == 1


def test_a_reset_of_the_communication_leaves_the_drive_as_it_is(line: Line) -> None:
    assert line.send(0x601, "2385600078000000")[0][1].startswith("60")  # 6085 = 120
    line.send(0x000, "8201")
    assert line.send(0x601, "4085600000000000") == [(0x581, "4385600078000000")]


@pytest.fixture(scope="module")
def host(tmp_path_factory) -> Iterator[Hosted]:
    if not multicast_works():
        pytest.skip("multicast does not come through on this machine")
    folder = tmp_path_factory.mktemp("host")
    one = Hosted({"shaft": WHOLE["shaft"]}, folder, "udp_multicast", real_time=True)
    yield one
    one.close()


@pytest.mark.slow
def test_one_controller_after_another_needs_no_reset_of_the_devices(host: Hosted) -> None:
    for number in range(3):
        with host.rig("shaft", reset=number == 0) as rig:
            rig.shaft.enable()
            rig.run_until(lambda: rig.shaft.enabled, 300, "enable")
            for _ in range(60):  # twice what the drive's patience is
                rig.cycle()
            assert not rig.faults
        time.sleep(PAUSE_S)


@pytest.mark.slow
def test_a_controller_after_one_that_was_killed_needs_no_reset(
    host: Hosted, tmp_path: Path
) -> None:
    bus = dict(host.said["bus"])
    table = {
        "interface": bus.pop("interface"),
        "channel": bus.pop("channel"),
        "options": bus,
        "allowed_gap_cycles": 50,
    }
    tables = {"bus": table, "shaft": WHOLE["shaft"]}
    assert host.say("reset") == "done"
    command = [sys.executable, "-c", CONTROLLER, json.dumps(tables)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT) as killed:
        assert killed.stdout.readline() == "turning\n"
        killed.send_signal(signal.SIGKILL)
        killed.communicate(timeout=60)
    time.sleep(PAUSE_S)
    with host.rig("shaft", reset=False) as rig:
        rig.shaft.enable()
        rig.run_until(lambda: rig.shaft.enabled, 300, "enable")
        for _ in range(60):
            rig.cycle()
        assert not rig.faults
