"""``pmm run`` on a hosted rig, killed or hung: the drives stop by themselves, in real time."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import can
import pytest
from can.interfaces.udp_multicast import UdpMulticastBus

from pmm.recorder.recording import read_run
from tests.pmm.run.processes import PLAN, RIG
from tests.sim.devices.benches import ROOT, _free_port, multicast_works

GROUP = "239.74.163.2"
READINGS = "20.0\n0.0\n20.0\n0.0\n"


@pytest.mark.sample(1)
@pytest.mark.skipif(not multicast_works(), reason="multicast does not come through here")
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGSTOP])
def test_a_lost_controller_is_stopped_for(tmp_path: Path, number: signal.Signals) -> None:
    port = _free_port()
    here = RIG[RIG.index('interface = "pmm-simulated"') : RIG.index("receive_thread")]
    there = f'interface = "udp_multicast"\nchannel = "{GROUP}"\nallowed_gap_cycles = 50\n'
    there += f"options = {{ port = {port}, hop_limit = 0 }}\n"
    (tmp_path / "rig.toml").write_text(RIG.replace(here, there), encoding="utf-8")
    (tmp_path / "simulated.toml").write_text(
        'rig = "rig.toml"\neccentricity_m = 0.02\n', encoding="utf-8"
    )
    (tmp_path / "plan.toml").write_text(PLAN.replace("periods = 4", "periods = 40"), "utf-8")
    folder = tmp_path / "campaign"
    pipes = {"stdin": subprocess.PIPE, "stderr": subprocess.DEVNULL, "text": True, "cwd": ROOT}
    host_words = ["sim.devices", str(tmp_path / "simulated.toml"), "--port", str(port)]
    run_words = ["tests.pmm.run.command", "run", str(tmp_path / "plan.toml"), "--output"]
    with (
        subprocess.Popen(
            [sys.executable, "-m", *host_words], stdout=subprocess.PIPE, **pipes
        ) as host,
        UdpMulticastBus(GROUP, port=port, hop_limit=0) as watcher,
    ):
        assert host.stdout.readline()
        with subprocess.Popen(
            [sys.executable, "-m", *run_words, str(folder)], stdout=subprocess.DEVNULL, **pipes
        ) as run:
            try:
                run.stdin.write(READINGS)
                run.stdin.flush()
                _wait_for_gate(folder, run)
                stopped_s = _time_to_emergency(watcher, run, number)
                speed = _speed_at_rest(watcher)
            finally:
                run.kill()
        host.communicate("quit\n", timeout=5)
    # 300 ms after the last heartbeat, which was up to 100 ms old, and what the host's load adds.
    assert stopped_s is not None
    assert 0.15 < stopped_s < 1.0
    assert speed == 0, "the shaft stands, and nobody told it to"
    (recorded,) = folder.glob("*/samples.arrows")
    assert read_run(recorded.parent).samples is not None


def _time_to_emergency(
    watcher: UdpMulticastBus, run: subprocess.Popen[str], number: signal.Signals
) -> float | None:
    """Return how long after the signal the shaft's drive said that it stops."""
    while watcher.recv(0.0) is not None:
        continue
    os.kill(run.pid, number)
    lost_s = time.monotonic()
    while time.monotonic() < lost_s + 3.0:
        frame = watcher.recv(0.5)
        if frame is not None and frame.arbitration_id == 0x081:
            return time.monotonic() - lost_s
    return None


def _speed_at_rest(watcher: UdpMulticastBus) -> int | None:
    """Ask the shaft's drive for its speed (606C) until it stands; return what it says last."""
    speed = None
    ask = can.Message(
        arbitration_id=0x601, data=[0x40, 0x6C, 0x60, 0, 0, 0, 0, 0], is_extended_id=False
    )
    until_s = time.monotonic() + 5.0
    while speed != 0 and time.monotonic() < until_s:
        watcher.send(ask)
        frame = watcher.recv(0.2)
        while frame is not None and frame.arbitration_id != 0x581:
            frame = watcher.recv(0.2)
        if frame is not None and bytes(frame.data[:4]) == bytes([0x43, 0x6C, 0x60, 0]):
            speed = int.from_bytes(frame.data[4:8], "little", signed=True)
    return speed


def _wait_for_gate(folder: Path, run: subprocess.Popen[str]) -> None:
    for _ in range(600):
        events = list(folder.glob("*/events.jsonl"))
        if events and "gate open" in events[0].read_text(encoding="utf-8"):
            return
        assert run.poll() is None
        time.sleep(0.1)
    raise AssertionError("the gate never opened")
