"""``pmm run`` at a terminal that is stopped, full or gone: the recording is whole all the same."""

import json
import os
import pty
import select
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import pytest

from pmm.cli.terminal import LINES, Terminal
from pmm.recorder.campaign_owner import LOCK
from tests.pmm.run.processes import READINGS, written_plan
from tests.sim.devices.benches import ROOT

PLAN = """
name = "short"
rig = "rig.toml"
[defaults]
periods = {}
settling_periods = 1
[[runs]]
motion = "heave"
frequencies_hz = 1.1
amplitudes_mm = 20.0
"""
RUN = "heave-f1.1-a20"
STOP, GO_ON = b"\x13", b"\x11"  # Ctrl-S, Ctrl-Q
_PATIENCE_S = 120.0
linux = pytest.mark.skipif(sys.platform != "linux", reason="pipes and terminals as Linux has them")


@contextmanager
def running(tmp_path: Path, periods: int, **streams: Any) -> Iterator[subprocess.Popen[bytes]]:
    """A campaign in real time, killed at the end."""
    plan = written_plan(tmp_path, PLAN.format(periods))
    words = ["run", str(plan), "--output", str(tmp_path / "out")]
    process = subprocess.Popen(
        [sys.executable, "-m", "tests.pmm.run.command", *words, "--real-time"],
        stdin=subprocess.PIPE,
        cwd=ROOT,
        start_new_session=True,
        **streams,
    )
    assert process.stdin is not None
    process.stdin.write(READINGS.encode())
    process.stdin.flush()
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def until(process: subprocess.Popen[bytes], come: Callable[[], Any]) -> None:
    end = time.monotonic() + _PATIENCE_S
    while not come():
        assert process.poll() is None, "it has ended"
        assert time.monotonic() < end, "it never came"
        time.sleep(0.02)


def cycles(out: Path) -> int:
    """How many cycles are on the disk."""
    lines = (out / RUN / "cycles.jsonl").read_text(encoding="utf-8").splitlines()
    return int(json.loads(lines[-1])[0])


def recorded(out: Path) -> bool:
    """Whether samples are on the disk."""
    return any(one.stat().st_size for one in out.glob("*/cycles.jsonl"))


def left(out: Path) -> bool:
    """Whether the run is closed, the rig left and the folder given free."""
    return (out / RUN / "complete.json").exists() and not (out / LOCK).stat().st_size


def marker(out: Path) -> dict[str, Any]:
    found = json.loads((out / RUN / "complete.json").read_text(encoding="utf-8"))
    assert isinstance(found, dict)
    return found


def drained(reading: int) -> str:
    """Return all that comes until its writers are gone."""
    with os.fdopen(reading, "rb") as file:
        return file.read().decode()


@pytest.mark.slow
@linux
def test_with_a_pipe_that_nobody_reads_the_run_is_made_with_every_sync(tmp_path: Path) -> None:
    out = tmp_path / "out"
    ours, theirs = os.pipe()
    with running(tmp_path, 2, stdout=subprocess.DEVNULL, stderr=theirs) as process:
        os.close(theirs)
        until(process, lambda: recorded(out))
        blocked = _filled(ours)
        until(process, lambda: left(out))
        os.close(blocked)
        said = drained(ours)
        assert process.wait(_PATIENCE_S) == 0
    found = marker(out)
    assert (found["outcome"], found["missing"]) == ("complete", 0)
    assert f"{RUN}: complete" in said


def _filled(reading: int) -> int:
    """Fill a pipe from our side too; return the end by which it was filled."""
    writing = os.open(f"/proc/self/fd/{reading}", os.O_WRONLY | os.O_NONBLOCK)
    with suppress(BlockingIOError):
        while True:
            os.write(writing, b"\n")
    return writing


@pytest.mark.slow
@linux
def test_at_a_stopped_terminal_ctrl_c_is_obeyed_and_the_rig_left(tmp_path: Path) -> None:
    out = tmp_path / "out"
    master, slave = pty.openpty()
    environment = {**os.environ, "TERM": "xterm"}
    with running(tmp_path, 150, stdout=slave, stderr=slave, env=environment) as process:
        os.close(slave)
        until(process, lambda: _taken(master) and recorded(out))
        os.write(master, STOP)
        before = cycles(out)
        until(process, lambda: cycles(out) > before + 200)  # some pictures later
        os.kill(process.pid, signal.SIGINT)  # typed, it would let the terminal go on
        until(process, lambda: left(out))
        assert process.poll() is None, "its last picture waits for the terminal"
        os.write(master, GO_ON)
        until(process, lambda: not _taken(master))
        assert process.wait(_PATIENCE_S) == 130
    os.close(master)
    found = marker(out)
    assert (found["outcome"], found["missing"]) == ("stopped", 0)


def _taken(master: int) -> bool:
    """Read what the terminal was told; tell whether its other side is still open."""
    try:
        while select.select([master], [], [], 0.0)[0]:
            os.read(master, 65536)
    except OSError:  # the other side is closed
        return False
    return True


@pytest.mark.slow
def test_when_the_reader_is_gone_and_ctrl_z_is_pressed_ctrl_c_is_obeyed(tmp_path: Path) -> None:
    out = tmp_path / "out"
    ours, theirs = os.pipe()
    with running(tmp_path, 150, stdout=theirs, stderr=theirs) as process:
        os.close(theirs)
        until(process, lambda: recorded(out))
        os.close(ours)
        process.send_signal(signal.SIGTSTP)
        process.send_signal(signal.SIGINT)  # the next lines find nobody
        process.wait(_PATIENCE_S)
    found = marker(out)
    assert (found["outcome"], found["missing"]) == ("stopped", 0)


def test_closed_streams_leave_their_numbers_to_nothing_else(tmp_path: Path) -> None:
    """A library's message to a closed stream must not end in a recording."""
    told = tmp_path / "told"
    program = (
        "import pmm.cli\n"
        "pmm.cli._hold_standard_numbers()\n"
        f"with open({str(told)!r}, 'w') as file: print(file.fileno(), file=file)\n"
    )

    def close() -> None:
        for number in (1, 2):
            os.close(number)

    subprocess.run([sys.executable, "-c", program], cwd=ROOT, preexec_fn=close, check=True)
    assert int(told.read_text(encoding="utf-8")) > 2


@linux
def test_what_takes_nothing_loses_pictures_first_then_lines_and_is_told_how_many() -> None:
    ours, theirs = os.pipe()
    drawn: list[str] = []
    with ThreadPoolExecutor(1) as pool:
        with os.fdopen(theirs, "w") as stream, Terminal(stream) as terminal:
            blocked = _filled(ours)
            terminal.say("line 0")
            assert not terminal.draw(lambda: drawn.append("a picture"))
            sys.stdout.write("line 1\n")  # a library's
            sys.stderr.write("line 2\n")
            for k in range(3, LINES + 5):
                terminal.say(f"line {k}")
            assert terminal.lost == 5
            os.close(blocked)
            said = pool.submit(drained, ours)
        lines = said.result().split("\n")
    shown = [one for one in lines if one]
    assert shown[:-1] == [f"line {k}" for k in range(LINES)]
    assert shown[-1].startswith("(5 lines are left out here")
    assert not drawn
