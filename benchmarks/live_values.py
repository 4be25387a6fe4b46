"""Live values over MQTT: whether a tick is lost in real time, and what a day of them costs.

Real time is ``pmm console`` on the simulated rig during a run. The day goes through the same
process as fast as frames can be made, 2.16 million of them, and for an hour of it the broker is
away. The broker is a real one, and a client of its own counts what it hands on.
"""

import json
import statistics
import tempfile
import time
from collections import deque
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

import psutil

from benchmarks.console_source import Watcher
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from pmm.console.live.live_settings import live_settings
from pmm.console.live.outlet import OutletStatus
from pmm.console.live.process import Publishing

_REAL_S: Final = 600.0
_RATE_HZ: Final = 25.0
_DAY_S: Final = 86400.0
_TOGETHER: Final = 100  # frames between two rests of a millisecond
_LOOKS: Final = 10  # at the memory, over the day
_PATIENCE_S: Final = 120.0
_MEGA: Final = 1e6


class _Counted:
    """Counts the ticks that come, each number once, in memory that does not grow."""

    def __init__(self) -> None:
        self.once = self.again = 0
        self._seen, self._lately = set[int](), deque[int]()

    def __call__(self, _client: Any, _data: Any, got: Any) -> None:
        if not got.topic.endswith("/live"):
            return
        number = json.loads(got.payload)["n"]
        if number in self._seen:
            self.again += 1
            return
        self.once += 1
        self._seen.add(number)
        self._lately.append(number)
        if len(self._lately) > 10_000:
            self._seen.discard(self._lately.popleft())


@dataclass
class _Day:
    """What became of a day's ticks."""

    offered: int
    counted: _Counted
    status: OutletStatus
    sizes_mb: list[float]
    took_s: float


def _run(quick: bool, report: Report) -> Outcome:
    from tests.pmm.console.live_rig import MOSQUITTO

    if MOSQUITTO is None:
        return Outcome({}, {}, ("not measured: needs mosquitto",))
    seconds, share = (5.0, 1e-3) if quick else (_REAL_S, 1.0)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        report("a day as fast as it goes")
        day = _day(folder, share)
        report("real time")
        real = _real(folder, seconds)
    half = len(day.sizes_mb) // 2
    growth_mb = statistics.median(day.sizes_mb[half:]) - statistics.median(day.sizes_mb[:half])
    measured = {
        "lost_in_real_time": float(real["lost"]),
        "dropped_in_real_time": float(real["dropped"]),
        "unaccounted": abs(day.offered - day.counted.once - day.status.dropped),
        "growth_mb": growth_mb,
    }
    row: Row = {
        "ticks": day.offered, "received": day.counted.once, "twice": day.counted.again,
        "dropped, counted": day.status.dropped, "took [s]": round(day.took_s),
        "memory at first [MB]": round(day.sizes_mb[0], 1),
        "memory at last [MB]": round(day.sizes_mb[-1], 1),
    }  # fmt: skip
    tables = {
        f"{seconds:g} s in real time, a run of the simulated rig": [real],
        f"{share * 24:g} h of ticks as fast as frames are made; broker away for a 24th": [row],
    }
    load = psutil.getloadavg()[0] / (psutil.cpu_count() or 1)
    return Outcome(tables, measured, (f"load per core at the end: {load:.1f}",))


def _real(folder: Path, seconds: float) -> Row:
    from tests.pmm.console.chromium import console, plan, rig_in
    from tests.pmm.console.live_rig import Reader, broker, free_port

    port, counted = free_port(), _Counted()
    with ExitStack() as stack:
        stack.enter_context(broker(port, folder))
        stack.enter_context(Reader(port, counted))
        options = ("--mqtt", f"mqtt://127.0.0.1:{port}/t")
        one = stack.enter_context(console(rig_in(folder / "rig"), folder / "out", *options))
        watcher = stack.enter_context(Watcher(one.address))
        watcher.start(plan("bench", periods=10_000))
        watcher.until(seconds)
        last = watcher.frame["n"]
        _wait(lambda: counted.once >= last)
        watcher.wait(lambda known: known["live"][0]["carried"] >= last, _PATIENCE_S)
        (status,) = watcher.known["live"]
        received = counted.once
        watcher.command("stop")
    lost = max(status["carried"] - received, last - received, 0)
    return {"ticks": last, "received": received, "twice": counted.again, "lost": lost,
            "dropped": status["dropped"]}  # fmt: skip


def _day(folder: Path, share: float) -> _Day:
    from tests.pmm.console.live_rig import HELLO, Reader, broker, frame, free_port

    offered, port, counted = round(share * _DAY_S * _RATE_HZ), free_port(), _Counted()
    away = range(offered // 2, offered // 2 + offered // 24)
    one, sizes, first = Publishing(_settings(port)), list[float](), frame(1)
    started = time.monotonic()
    with ExitStack() as stack:
        stack.callback(one.close)
        there = stack.enter_context(ExitStack())
        there.enter_context(broker(port, folder))
        there.enter_context(Reader(port, counted))
        one.take(HELLO)
        process = psutil.Process(one.pid)
        status = OutletStatus("MQTT", False, 0, 0)
        for number in range(1, offered + 1):
            one.take(replace(first, number=number))
            if number % _TOGETHER == 0:
                time.sleep(1e-3)
            if number == away.start:
                _settled(one, status)
                there.close()
            if number == away.stop:
                there.enter_context(broker(port, folder))
                there.enter_context(Reader(port, counted))
            if number % max(offered // _LOOKS, 1) == 0:
                sizes.append(process.memory_info().rss / _MEGA)
        status = _settled(one, status)
        _wait(lambda: counted.once + status.dropped >= offered, patient=False)
    return _Day(offered, counted, status, sizes, time.monotonic() - started)


def _settings(port: int) -> Any:
    return live_settings("tank", f"mqtt://127.0.0.1:{port}/t", None, None, None)


def _settled(one: Publishing, status: OutletStatus) -> OutletStatus:
    """Wait until nothing is carried any more; what comes in silence is not counted twice."""
    end_s, before = time.monotonic() + _PATIENCE_S, -1
    while time.monotonic() < end_s and (status.carried != before or not status.carried):
        before = status.carried
        time.sleep(3.0)
        told = one.statuses()
        status = told[0] if told else status
    return status


def _wait(condition: Any, *, patient: bool = True) -> None:
    end_s = time.monotonic() + (_PATIENCE_S if patient else 10.0)
    while not condition() and time.monotonic() < end_s:
        time.sleep(0.05)


BENCHMARK = Benchmark("live_values", "Live values over MQTT", _run)
