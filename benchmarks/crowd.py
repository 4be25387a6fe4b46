"""The quick stop with a crowd before the console: how long until its frame is on the bus.

A run is started on the simulated rig in real time; when the shaft turns, a quick stop is posted on
a new connection, and the frame is stamped on the simulated bus. Meanwhile 200 pages take pictures,
500 connections hold half a request each (refused ones come again after a second), and a plan of
nearly 10000 runs is checked over and over. All of it shares the machine with the console.
"""

import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import IO, Any, Final, cast

import numpy as np

from benchmarks.console_source import Watcher
from benchmarks.machine import ROOT
from benchmarks.outcome import Benchmark, Outcome, Report, Row

_PAGES: Final = 200
_HALVES: Final = 500
_STOPS: Final = 50
_WINDOW_S: Final = 10.0
_DRAIN_S: Final = 3.0  # for what came while the crowd did
_EDGES_MS: Final = (0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 80.0, 100.0, 200.0, np.inf)
_TURNING: Final = ("settling", "armed", "gate open")


def _run(quick: bool, report: Report) -> Outcome:
    stops = 5 if quick else _STOPS
    with tempfile.TemporaryDirectory() as folder:
        found = {
            pages: _measured(Path(folder) / str(pages), pages, halves, stops, report)
            for pages, halves in ((0, 0), (_PAGES, _HALVES))
        }
    alone, crowd = found[0], found[_PAGES]
    measured = {
        "quick_stop_ms": float(np.max(crowd["ms"])),
        "refused": float(crowd["refused"]),
        "frames_in_control_per_s": float(crowd["frames/s"]),
    }
    tables = {
        "quick stop to its frame on the bus": _histogram(alone["ms"], crowd["ms"]),
        "the page in control": [
            {
                "pages": pages,
                "frames/s": round(one["frames/s"], 1),
                "median [ms]": round(float(np.median(one["ms"])), 1),
                "worst [ms]": round(float(np.max(one["ms"])), 1),
            }
            for pages, one in found.items()
        ],
    }
    load = os.getloadavg()[0] / (os.cpu_count() or 1)
    return Outcome(tables, measured, (f"load per core at the end: {load:.1f}",))


def _histogram(alone: list[float], crowd: list[float]) -> list[Row]:
    counts = [np.histogram(one, _EDGES_MS)[0] for one in (alone, crowd)]
    return [
        {"from [ms]": low, "alone": int(a), "with the crowd": int(c)}
        for low, a, c in zip(_EDGES_MS[:-1], *counts, strict=True)
    ]


def _measured(folder: Path, pages: int, halves: int, stops: int, report: Report) -> dict[str, Any]:
    from tests.pmm.console.chromium import plan, rig_in
    from tests.pmm.console.raw import address_of

    folder.mkdir()
    text = plan("crowd", periods=100).replace("[[runs]]", "repeats = 1000\n[[runs]]")
    times = folder / "times"
    refused, late_ms = 0, []
    with ExitStack() as stack:
        url = stack.enter_context(_console(rig_in(folder / "rig"), folder / "out", times))
        address = address_of(url)
        watcher = stack.enter_context(Watcher(url))
        watcher.queue(text)
        stack.enter_context(_crowd(address.port, pages, halves))
        watcher.frames_per_s(_DRAIN_S)
        frames_per_s = watcher.frames_per_s(_WINDOW_S)
        request = address.post("/api/command", {"command": "quick stop"}, session="1" * 32)
        for number in range(stops):
            report(f"{pages} pages, quick stop {number + 1} of {stops}")
            watcher.command("start")
            _see(watcher, _TURNING)
            asked_s = time.monotonic()
            refused += address.ask(request)[0] != 200
            watcher.told("finished")
            stamps = [float(line) for line in times.read_text().split()]
            late_ms.append(1e3 * (min(s for s in stamps if s > asked_s) - asked_s))
    return {"ms": late_ms, "refused": refused, "frames/s": frames_per_s}


def _see(watcher: Watcher, states: tuple[str, ...]) -> None:
    """Wait for one of the states; a fault ends the measurement."""

    def reached(frame: dict[str, Any]) -> bool:
        if frame["state"] == "fault":
            raise RuntimeError(f"the rig has a fault: {frame['bus']['faults']}")
        return frame["state"] in states

    watcher.see(reached)


@contextmanager
def _console(rig: Path, output: Path, times: Path) -> Iterator[str]:
    """Run ``pmm console``; yield its address."""
    command = [sys.executable, "-m", "benchmarks.crowd_console", str(times), "console", str(rig)]
    command += ["--output", str(output), "--port", "0"]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, cwd=ROOT)
    try:
        said = cast("IO[str]", process.stderr)
        found = re.search(r"http://\S+", said.readline())
        if found is None:
            raise RuntimeError(said.read())
        yield found.group()
        process.send_signal(signal.SIGINT)
        rest = process.communicate(timeout=60)[1]
        if process.returncode:
            raise RuntimeError(rest)
    finally:
        if process.poll() is None:
            process.kill()
            process.communicate()


@contextmanager
def _crowd(port: int, pages: int, halves: int) -> Iterator[None]:
    """Let the crowd come; it has to be whole to the end."""
    command = [sys.executable, "-m", "benchmarks.crowd_sockets", *map(str, (port, pages, halves))]
    process = subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=ROOT
    )
    try:
        if cast("IO[str]", process.stdout).readline().strip() != "ready":
            raise RuntimeError("the crowd did not come")
        yield
        lost = process.communicate(timeout=60)[0].strip()
        if lost != "0":
            raise RuntimeError(f"of the crowd went away: {lost}")
    finally:
        if process.poll() is None:
            process.kill()
            process.communicate()


BENCHMARK = Benchmark("crowd", "Quick stop with a crowd before the console", _run)
