"""A controller that is killed in real time: the drive of the hosted rig stops by itself."""

import json
import os
import signal
import subprocess
import sys
import time
from contextlib import ExitStack
from pathlib import Path

import pytest
from can.interfaces.udp_multicast import UdpMulticastBus

from tests.sim.devices.benches import ROOT, WHOLE, _free_port, multicast_works, toml

CONTROLLER = """
import json, sys, time
from hardware.pacing import RealTime
from hardware.rig import Rig
from hardware.rig_configuration import read_rig
from sim.devices.bench_file import DRIVERS
rig = Rig(read_rig(json.loads(sys.argv[1]), DRIVERS), time.monotonic,
          RealTime(0.01, time.monotonic, time.sleep), lambda _: None)
rig.prepare()
rig.shaft.enable()
rig.run_until(lambda: rig.shaft.enabled, 100, "enable")
rig.shaft.turn(1.0)
rig.run_until(lambda: rig.shaft.at_speed, 300, "speed")
print("turning", flush=True)
while True:
    rig.cycle()
"""


@pytest.mark.skipif(not multicast_works(), reason="multicast does not come through here")
def test_the_drive_stops_quickly_after_its_controller_was_killed(tmp_path: Path) -> None:
    port = _free_port()
    options = {"port": port, "hop_limit": 0}
    bus = {"interface": "udp_multicast", "channel": "239.74.163.2", "options": options}
    bus |= {"allowed_gap_cycles": 50}
    tables = {"bus": bus, "shaft": WHOLE["shaft"]}
    (tmp_path / "simulated.toml").write_text(toml(tables, "rig."))
    host_command = [sys.executable, "-m", "sim.devices", str(tmp_path / "simulated.toml")]
    controller = [sys.executable, "-c", CONTROLLER]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True, "cwd": ROOT}
    with (
        subprocess.Popen([*host_command, "--port", str(port)], **pipes) as host,
        UdpMulticastBus("239.74.163.2", **options) as watcher,
        ExitStack() as started,
    ):
        assert host.stdout.readline()  # it answers from here on
        run = started.enter_context(subprocess.Popen([*controller, json.dumps(tables)], **pipes))
        assert run.stdout.readline() == "turning\n"
        while watcher.recv(0.0) is not None:
            continue
        os.kill(run.pid, signal.SIGKILL)
        killed = time.monotonic()
        emergency = None
        while emergency is None and time.monotonic() < killed + 3.0:
            frame = watcher.recv(0.5)
            if frame is not None and frame.arbitration_id == 0x081:
                emergency = time.monotonic() - killed
        host.communicate("quit\n", timeout=5)
        run.communicate(timeout=5)
    # 300 ms after the last heartbeat, which was up to 100 ms old, and what the host's load adds.
    assert emergency is not None
    assert 0.15 < emergency < 1.0
