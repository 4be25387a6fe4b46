"""The web server dies during a run: the run goes on, and its recording is as good as any."""

import os
import signal
import time
from collections.abc import Callable
from pathlib import Path

import psutil

from analysis.readers import read_recording
from analysis.resolver.analyse import Settings, analyse
from benchmarks.console_source import Watcher
from tests.pmm.console.chromium import Console, console, plan, rig_in

PERIODS = 12
WITHIN_S = 60.0


def _server(one: Console) -> psutil.Process:
    """Return the process that listens."""
    port = int(one.address.rstrip("/").rsplit(":", 1)[1])
    loop = psutil.Process(one.pid)
    children = loop.children(recursive=True)
    return next(c for c in children if port in _ports(c))


def _ports(process: psutil.Process) -> set[int]:
    return {one.laddr.port for one in process.net_connections() if one.status == "LISTEN"}


def _until(condition: Callable[[], bool], what: str) -> None:
    end = time.monotonic() + WITHIN_S
    while not condition():
        assert time.monotonic() < end, f"{what} never came"
        time.sleep(0.05)


def test_a_run_goes_on_to_its_end_and_is_recorded_whole(tmp_path: Path) -> None:
    rig, out = rig_in(tmp_path / "rig"), tmp_path / "out"
    folder = out / "alone"
    with console(rig, out, "--speed", "4") as one:
        with Watcher(one.address) as watcher:
            watcher.start(plan("alone", periods=PERIODS))
            watcher.see(lambda frame: frame["gate"] == "open")
        server = _server(one)
        os.kill(server.pid, signal.SIGKILL)
        _until(lambda: not server.is_running() or server.status() == "zombie", "death")
        _until((folder / "campaign.toml").exists, "campaign")
    assert "the web server has ended; the rig runs on" in one.said
    recording = next(folder.glob("run*/run.nc"))
    reading = analyse(read_recording(recording), settings=Settings()).readings[0]
    assert reading.periods == PERIODS
    assert '"complete"' in (recording.parent / "complete.json").read_text(encoding="utf-8")
