"""``pmm`` in this process, and ``pmm run`` in one of its own: watched, stopped and killed."""

import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from click.testing import CliRunner, Result

from pmm.cli import cli
from tests.sim.devices.benches import ROOT

RIG = (ROOT / "examples" / "manual" / "rig.toml").read_text(encoding="utf-8")
SIMULATED = (ROOT / "examples" / "manual" / "simulated.toml").read_text(encoding="utf-8")
PLAN = """
name = "short"
rig = "rig.toml"
[defaults]
periods = 4
settling_periods = 2
pause_s = 0.5
[[runs]]
motion = "heave"
frequencies_hz = 0.8
amplitudes_mm = 20.0
[[runs]]
motion = "heave"
frequencies_hz = 1.1
amplitudes_mm = 20.0
periods = 150
"""
SHORT, LONG = "heave-f0.8-a20", "heave-f1.1-a20"
# Eccentricity and phase as they are homed, then as they are set for heave and pitch.
READINGS = "0\n0\n20.0\n0.0\n180.0\n"
_PATIENCE_S = 120.0


def written_plan(folder: Path, plan: str = PLAN, rig: str = RIG) -> Path:
    """Write a plan, its rig and what is simulated behind it."""
    (folder / "rig.toml").write_text(rig, encoding="utf-8")
    (folder / "simulated.toml").write_text(SIMULATED, encoding="utf-8")
    path = folder / "plan.toml"
    path.write_text(plan, encoding="utf-8")
    return path


def pmm(*words: str | Path, given: str = "", env: Mapping[str, str] | None = None) -> Result:
    """Run a command to its end, in this process."""
    return CliRunner().invoke(cli, [*map(str, words)], input=given, env=env)


@contextmanager
def full_disk(size_bytes: int) -> Iterator[None]:
    """Let no file of this process grow beyond a size: what is written fails as on a full disk.

    Python before 3.13.1 keeps half of what it compiled, and reads it next time: nothing is compiled
    to files meanwhile.
    """
    before, compiles = resource.getrlimit(resource.RLIMIT_FSIZE), sys.dont_write_bytecode
    sys.dont_write_bytecode = True
    resource.setrlimit(resource.RLIMIT_FSIZE, (size_bytes, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        sys.dont_write_bytecode = compiles


@contextmanager
def recording(
    plan: Path, folder: Path, *more: str, run: str = "*"
) -> Iterator[subprocess.Popen[str]]:
    """A campaign in real time, once a run is being recorded; killed at the end."""
    words = ["run", str(plan), "--output", str(folder), *more, "--real-time"]
    process = subprocess.Popen(
        [sys.executable, "-m", "tests.pmm.run.command", *words],
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        cwd=ROOT,
        env=os.environ,
    )
    assert process.stdin is not None
    process.stdin.write(READINGS)
    process.stdin.flush()
    try:
        _wait_for(folder, run, process)
        yield process
    finally:
        if process.poll() is None:
            os.kill(process.pid, signal.SIGKILL)
        process.communicate(timeout=_PATIENCE_S)


def _wait_for(folder: Path, run: str, process: subprocess.Popen[str]) -> None:
    """Wait until samples of a run are on the disk: what is written after them is."""
    end = time.monotonic() + _PATIENCE_S
    while not any(one.stat().st_size for one in folder.glob(f"{run}/cycles.jsonl")):
        assert process.poll() is None, process.communicate()[1]
        assert time.monotonic() < end, "no run began"
        time.sleep(0.05)
