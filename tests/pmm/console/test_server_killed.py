"""The web server dies during a run: the run goes on, and its recording is as good as any."""

import json
import os
import signal
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import psutil
import pytest

from analysis.readers import read_recording
from analysis.resolver.analysis import analyse
from analysis.resolver.settings import ResolverSettings
from benchmarks.console_source import Watcher
from tests.pmm.console.chromium import Console, console, plan, rig_in

PERIODS = 8
WITHIN_S = 60.0
TWO_RUNS = plan("alone", periods=PERIODS).replace("= 1.0", "= [1.0, 1.1]")


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


@pytest.mark.slow
def test_runs_go_on_to_their_end_and_are_recorded_whole(tmp_path: Path) -> None:
    rig, out = rig_in(tmp_path / "rig"), tmp_path / "out"
    folder = out / "alone"
    with console(rig, out, "--speed", "4") as one:
        with Watcher(one.address) as watcher:
            watcher.start(TWO_RUNS)
            watcher.see(lambda frame: bool(frame["run_number"] == 2 and frame["gate"] == "open"))
        _fill(one.pid)  # what the loop says of it finds a terminal that takes nothing
        server = _server(one)
        left = [server, *server.children(recursive=True)]
        os.kill(server.pid, signal.SIGKILL)
        _until((folder / "run-f1.1-a20" / "run.nc").exists, "second recording")
        _until(lambda: not any(_lives(process) for process in left), "end of the server's helpers")
    assert len(left) > 1  # the one that works coefficients out
    assert "the web server has ended; the rig runs on" in one.said
    assert "warning: --host" not in one.said  # of this machine only
    for name in ("run-f1-a20", "run-f1.1-a20"):
        reading = analyse(
            read_recording(folder / name / "run.nc"), settings=ResolverSettings()
        ).readings[0]
        assert reading.periods == PERIODS
        marker = (folder / name / "complete.json").read_text(encoding="utf-8")
        assert json.loads(marker)["outcome"] == "complete"
    assert "run-f1.1-a20" in (folder / "campaign.toml").read_text(encoding="utf-8")


def _fill(pid: int) -> None:
    """Fill the pipe that a process has as its standard error."""
    handle = os.open(f"/proc/{pid}/fd/2", os.O_WRONLY | os.O_NONBLOCK)
    with suppress(BlockingIOError):
        while True:
            os.write(handle, b"\n")
    os.close(handle)


def _lives(process: psutil.Process) -> bool:
    try:
        return bool(process.status() != psutil.STATUS_ZOMBIE)
    except psutil.NoSuchProcess:
        return False
