"""Two controllers, one bus with a shaft that turns: processes and raw frames, nothing of ours."""

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import can
import pytest
from can.interfaces.udp_multicast import UdpMulticastBus

from tests.sim.devices.benches import ROOT, WHOLE, Hosted, multicast_works
from tests.sim.devices.test_killed_controller_against_time import CONTROLLER

pytestmark = pytest.mark.skipif(
    not multicast_works(), reason="multicast does not come through on this machine"
)
_PATIENCE_S = 60.0


@pytest.fixture
def host(tmp_path: Path) -> Iterator[Hosted]:
    one = Hosted({"shaft": WHOLE["shaft"]}, tmp_path, "udp_multicast", real_time=True)
    yield one
    one.close()


@contextmanager
def _controller(host: Hosted, locks: Path) -> Iterator[subprocess.Popen[str]]:
    """A controller of the hosted rig; ``locks`` is the machine that it believes to be on."""
    locks.mkdir(exist_ok=True)
    bus = dict(host.said["bus"])
    table = {
        "interface": bus.pop("interface"),
        "channel": bus.pop("channel"),
        "options": bus,
        "allowed_gap_cycles": 50,
    }
    command = [
        sys.executable,
        "-c",
        CONTROLLER,
        json.dumps({"bus": table, "shaft": host.tables["shaft"]}),
    ]
    with subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=ROOT,
        env={**os.environ, "TMPDIR": str(locks)},
    ) as process:
        try:
            yield process
        finally:
            process.kill()
            process.communicate(timeout=_PATIENCE_S)


@contextmanager
def _tool(host: Hosted) -> Iterator[UdpMulticastBus]:
    where = dict(host.said["bus"])
    where.pop("interface")
    with UdpMulticastBus(**where) as bus:
        yield bus


def _send(bus: UdpMulticastBus, at: int, data: str) -> None:
    bus.send(can.Message(arbitration_id=at, data=bytes.fromhex(data), is_extended_id=False))


def _speed(bus: UdpMulticastBus) -> int:
    """Ask the drive for its velocity (606C), in counts a second."""
    end = time.monotonic() + _PATIENCE_S
    while time.monotonic() < end:
        while bus.recv(0.0) is not None:
            continue  # what came meanwhile, and may have filled the socket
        _send(bus, 0x601, "406c600000000000")
        for _ in range(100):
            frame = bus.recv(1.0)
            if frame is None or frame.arbitration_id != 0x581:
                continue
            if bytes(frame.data[:4]) == b"\x43\x6c\x60\x00":
                return int.from_bytes(frame.data[4:8], "little", signed=True)
    raise AssertionError("the drive does not answer")


@pytest.mark.slow
def test_a_second_process_of_this_machine_is_told_who_has_the_bus(
    host: Hosted, tmp_path: Path
) -> None:
    with _controller(host, tmp_path / "here") as first, _tool(host) as tool:
        assert first.stdout.readline() == "turning\n", first.communicate()[1]
        with _controller(host, tmp_path / "here") as second:
            _, said = second.communicate(timeout=_PATIENCE_S)
        assert f"in use by process {first.pid}" in said
        assert _speed(tool) > 0
        first.send_signal(signal.SIGKILL)
        first.wait(timeout=_PATIENCE_S)
        time.sleep(1.0)  # the drive notices, and stops
        with _controller(host, tmp_path / "here") as third:
            assert third.stdout.readline() == "turning\n"


@pytest.mark.slow
def test_a_controller_of_another_machine_hears_the_first_and_does_not_start(
    host: Hosted, tmp_path: Path
) -> None:
    with _controller(host, tmp_path / "here") as first, _tool(host) as tool:
        assert first.stdout.readline() == "turning\n", first.communicate()[1]
        before = _speed(tool)
        with _controller(host, tmp_path / "there") as second:
            _, said = second.communicate(timeout=_PATIENCE_S)
        assert "another controller is on it: heard" in said
        assert "SYNC" in said
        assert _speed(tool) == pytest.approx(before, rel=0.05)
        assert first.poll() is None


def test_a_foreign_command_brings_the_turning_shaft_to_rest(host: Hosted, tmp_path: Path) -> None:
    with _controller(host, tmp_path / "here") as first, _tool(host) as tool:
        assert first.stdout.readline() == "turning\n", first.communicate()[1]
        assert _speed(tool) > 0
        _send(tool, 0x000, "8000")  # pre-operational: no process data reaches the drive any more
        _, said = first.communicate(timeout=_PATIENCE_S)  # ends by the fault, which nobody resets
        assert "another controller sent NMT pre-operational to all nodes" in said
        end = time.monotonic() + _PATIENCE_S
        while (speed := _speed(tool)) != 0 and time.monotonic() < end:
            time.sleep(0.1)
        assert speed == 0
