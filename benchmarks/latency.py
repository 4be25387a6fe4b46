"""How late the cycles of ``pmm run`` and ``pmm console`` begin while all else keeps the host busy.

The terminal is stopped by Ctrl-S, the disk of the recording is written to without a pause, and
200 light sockets watch the console on the same cores. A timer loop that does nothing runs beside,
with the same period and the same priority: what it meets is the host's, not the program's.
"""

import os
import pty
import re
import select
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Final

import numpy as np
import psutil
from numpy.typing import NDArray

from benchmarks.machine import ROOT
from benchmarks.outcome import Benchmark, Outcome, Report, Row

_WINDOW_S: Final = 120.0  # 12,000 cycles: 12 of them beyond 99.9 %
_QUICK_S: Final = 3.0
_SETTLE_S: Final = 5.0
_WATCHERS: Final = 200
_FEW: Final = 5
_PATIENCE_S: Final = 120.0
_CLASSES_MS: Final = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 300.0)
_STOP: Final = b"\x13"  # Ctrl-S
_GO_ON: Final = b"\x11"  # Ctrl-Q

FloatArray = NDArray[np.float64]


@dataclass
class _Loop:
    """A command of ours on a terminal, and the file of its cycles."""

    process: subprocess.Popen[bytes]
    terminal: int
    cycles: Path
    said: str = ""

    def until(self, come: Callable[[], object], what: str) -> None:
        """Wait for something, while the terminal is read."""
        end = time.monotonic() + _PATIENCE_S
        while not come():
            self._read()
            if self.process.poll() is not None or time.monotonic() > end:
                raise RuntimeError(f"{what} never came: {self.said}")
            time.sleep(0.05)

    def leave(self) -> None:
        """Let the terminal go on, and the command end by Ctrl-C."""
        os.write(self.terminal, _GO_ON)
        self.process.send_signal(signal.SIGINT)
        with suppress(OSError):  # the other side of the terminal is closed
            while self.process.poll() is None:
                self._read()
                time.sleep(0.05)
        self.process.wait(_PATIENCE_S)

    def _read(self) -> None:
        while select.select([self.terminal], [], [], 0.0)[0]:
            self.said += os.read(self.terminal, 1 << 16).decode(errors="replace")


def _run(quick: bool, report: Report) -> Outcome:
    window_s, watchers = (_QUICK_S, _FEW) if quick else (_WINDOW_S, _WATCHERS)
    found: dict[str, FloatArray] = {}
    measured: dict[str, float] = {}
    for name, watched in (("run", 0), ("console", watchers)):
        report(f"pmm {name}, {watched} watchers")
        with tempfile.TemporaryDirectory() as folder:
            ours, bare = _measured(Path(folder), name, watched, window_s)
        found |= {f"pmm {name}": ours, f"bare timer beside pmm {name}": bare}
        over_s = np.quantile(ours, 0.999) - np.quantile(bare, 0.999)
        measured[f"{name}_p999_over_bare"] = 1e3 * float(over_s)
        measured[f"{name}_worst"] = 1e3 * float(ours.max())
    tables = {
        "lateness of cycles at 100 Hz": [_row(who, late_s) for who, late_s in found.items()],
        "the same: cycles by lateness": _classes(found),
    }
    load = psutil.getloadavg()[0] / (psutil.cpu_count() or 1)
    return Outcome(
        tables,
        measured,
        (f"terminal stopped, disk busy, {watchers} sockets on the console; load per core at the "
         f"end: {load:.1f}",),
    )  # fmt: skip


def _measured(
    folder: Path, name: str, watchers: int, window_s: float
) -> tuple[FloatArray, FloatArray]:
    """Return how late the cycles in a window began: those of the command, and of a bare timer."""
    with ExitStack() as stack:
        loop = stack.enter_context(_recording(folder, name, watchers))
        stack.enter_context(_child("disk", folder / "busy"))
        bare = stack.enter_context(_child("bare", folder / "bare.npy"))
        os.write(loop.terminal, _STOP)
        time.sleep(_SETTLE_S)
        begin_s = time.monotonic()
        time.sleep(window_s)
        end_s = time.monotonic()
        if loop.process.poll() is not None or bare.poll() is not None:
            raise RuntimeError(f"pmm {name} has ended: {loop.said}")
    return _within(loop.cycles, begin_s, end_s), _within(folder / "bare.npy", begin_s, end_s)


def _within(file: Path, begin_s: float, end_s: float) -> FloatArray:
    at_s, late_s = np.load(file).T
    return np.asarray(late_s[(at_s >= begin_s) & (at_s < end_s)])


@contextmanager
def _recording(folder: Path, name: str, watchers: int) -> Iterator[_Loop]:
    """Start a command that records a long run on a simulated rig, watched by some."""
    from benchmarks.console_source import Watcher
    from tests.pmm.console.chromium import plan, rig_in

    rig, out = rig_in(folder / "rig"), folder / "out"
    text = plan("bench", periods=10_000)
    given: list[str | Path] = ["run", rig.with_name("plan.toml"), "--real-time"]
    if name == "console":
        given = ["console", rig, "--port", "0"]
    rig.with_name("plan.toml").write_text(text, encoding="utf-8")
    with ExitStack() as stack:
        loop = stack.enter_context(_command(folder / f"{name}.npy", *given, "--output", out))
        if name == "console":
            loop.until(lambda: re.search(r"http://\S+/", loop.said), "the address")
            (address,) = re.findall(r"(http://\S+)/", loop.said)
            with Watcher(address) as one:
                one.start(text)
            there = stack.enter_context(
                _child("watchers", address, watchers, stdout=subprocess.PIPE)
            )
            loop.until(lambda: _readable(there.stdout), "the watchers")
        loop.until(lambda: _recorded(out), "a recording")
        yield loop


def _readable(stream: IO[bytes] | None) -> bool:
    return bool(stream and select.select([stream], [], [], 0.0)[0])


def _recorded(out: Path) -> bool:
    return any(one.stat().st_size for one in out.rglob("cycles.jsonl"))


@contextmanager
def _command(cycles: Path, *words: str | Path) -> Iterator[_Loop]:
    """Run a command of ours on a terminal of its own; it is left by Ctrl-C."""
    master, slave = pty.openpty()
    try:
        with _child("pmm", cycles, *words, stdout=slave, stderr=slave) as process:
            os.close(slave)
            loop = _Loop(process, master, cycles)
            yield loop
            loop.leave()
    finally:
        os.close(master)


@contextmanager
def _child(mode: str, *words: object, **streams: int) -> Iterator[subprocess.Popen[bytes]]:
    """Run one of :mod:`benchmarks.latency_child`; it is ended by Ctrl-C."""
    command = [sys.executable, "-m", "benchmarks.latency_child", mode, *map(str, words)]
    process = subprocess.Popen(command, cwd=ROOT, stdin=subprocess.DEVNULL, **streams)  # type: ignore[call-overload]
    try:
        yield process
        process.send_signal(signal.SIGINT)
        process.wait(_PATIENCE_S)
    finally:
        process.kill()
        process.wait()


def _row(who: str, late_s: FloatArray) -> Row:
    """Return the lateness of a loop: how much of it is below a limit, and the most."""
    row: Row = {"loop": who, "cycles": len(late_s)}
    for name, part in (("50 %", 0.5), ("99 %", 0.99), ("99.9 %", 0.999), ("worst", 1.0)):
        row[f"{name} [ms]"] = round(1e3 * float(np.quantile(late_s, part)), 3)
    return row


def _classes(found: dict[str, FloatArray]) -> list[Row]:
    """Return how many cycles of each loop began later than one limit, and not than the next."""
    limits = np.array([0.0, *_CLASSES_MS, np.inf]) / 1e3
    counts = {who: np.histogram(late_s, limits)[0] for who, late_s in found.items()}
    names = [*(f"to {one:g}" for one in _CLASSES_MS), "later"]
    return [
        {"lateness [ms]": name, **{who: int(each[k]) for who, each in counts.items()}}
        for k, name in enumerate(names)
    ]


BENCHMARK = Benchmark("latency", "Latency of the loop under load", _run)
