"""Live values over MQTT: whether a tick is lost in real time, and what a day of them costs.

Real time is ``pmm console`` on the simulated rig during a run. The day goes through the same
process as fast as it takes ticks, 2.16 million of them; while the broker reads no more than 20 s of
them are on their way. For an hour of it the broker reads nothing, for another it is away. Hours are
counted in ticks. The broker is a real one, and a client of its own counts what it hands on. The
broker keeps that client's session while it is away: what it takes before the client is back is
handed on then, so that whatever does not come was lost.
"""

import json
import signal
import statistics
import tempfile
import time
from collections import deque
from collections.abc import Callable
from contextlib import ExitStack, suppress
from dataclasses import dataclass, replace
from getpass import getuser
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
_TOGETHER: Final = 100  # frames between two looks at how many are on their way
_ON_THE_WAY: Final = 500  # ticks: two thirds of what may wait in front of the process
_HOURS: Final = 24
_STUCK, _AWAY = 8, 16  # hours in which the broker reads nothing, and is away
_PATIENCE_S: Final = 120.0
_LAST_S: Final = 10.0  # for the last of those that the broker has taken
_BROKER: Final = (
    "allow_anonymous true",
    "persistence true",
    "max_queued_messages 0",
)
_MEGA: Final = 1e6


class Counted:
    """Counts the ticks that come, each number once, in memory that does not grow.

    Attributes
    ----------
    once, again, last
        Ticks that came, those of them that came once more, and the largest number.
    unread, while_read
        Numbers handed on while the broker did not read, and ticks of all others that came.
    """

    def __init__(self) -> None:
        self.once = self.again = self.last = self.while_read = 0
        self.unread: list[range] = []
        self._seen, self._lately = set[int](), deque[int]()

    def __call__(self, _client: Any, _data: Any, got: Any) -> None:
        """Take what came, from its topic and payload."""
        if not got.topic.endswith("/live"):
            return
        number = json.loads(got.payload)["n"]
        if number in self._seen:
            self.again += 1
            return
        self.once += 1
        self.while_read += not any(number in outage for outage in self.unread)
        self.last = max(self.last, number)
        self._seen.add(number)
        self._lately.append(number)
        if len(self._lately) > 10_000:
            self._seen.discard(self._lately.popleft())


@dataclass
class Day:
    """What became of a day's ticks."""

    offered: int
    counted: Counted
    reached: int
    status: OutletStatus
    lost: int
    both: int
    sizes_mb: list[float]
    took_s: float
    processor_s: float


def _run(quick: bool, report: Report) -> Outcome:
    from tests.pmm.console.live_rig import MOSQUITTO

    if MOSQUITTO is None:
        return Outcome({}, {}, ("not measured: needs mosquitto",))
    seconds, share = (5.0, 1e-3) if quick else (_REAL_S, 1.0)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        report("a day as fast as it goes")
        whole_day = day(folder, share, report)
        report("real time")
        real = _real(folder, seconds)
    half = len(whole_day.sizes_mb) // 2
    growth_mb = statistics.median(whole_day.sizes_mb[half:]) - statistics.median(
        whole_day.sizes_mb[:half]
    )
    measured = {
        "lost_in_real_time": float(real["lost"]),
        "dropped_in_real_time": float(real["dropped"]),
        "unaccounted": whole_day.lost,
        "arrived": whole_day.counted.while_read / whole_day.reached,
        "growth_mb": growth_mb,
        "day_s": whole_day.took_s,
    }
    row: Row = {
        "ticks": whole_day.offered, "while it reads": whole_day.reached,
        "of those received": whole_day.counted.while_read,
        "received": whole_day.counted.once, "twice": whole_day.counted.again,
        "dropped, counted": whole_day.status.dropped, "of them received": whole_day.both,
        "took [s]": round(whole_day.took_s),
        "processor [s]": round(whole_day.processor_s),
        "memory at first [MB]": round(whole_day.sizes_mb[0], 1),
        "memory at last [MB]": round(whole_day.sizes_mb[-1], 1),
    }  # fmt: skip
    tables = {
        f"{seconds:g} s in real time, a run of the simulated rig": [real],
        f"{share * 24:g} h of ticks as fast as they arrive; for a 24th the broker reads nothing, "
        "for a 24th it is away": [row],
    }
    load = psutil.getloadavg()[0] / (psutil.cpu_count() or 1)
    return Outcome(tables, measured, (f"load per core at the end: {load:.1f}",))


def _real(folder: Path, seconds: float) -> Row:
    from tests.pmm.console.chromium import console, plan, rig_in
    from tests.pmm.console.live_rig import Reader, broker, free_port

    port, counted = free_port(), Counted()
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


class Feed:
    """Hands ticks on, no faster than they are fetched, and no further ahead than it is told to.

    Attributes
    ----------
    number, reached
        Ticks that were handed on, and those of them while the broker read.
    lost, both
        Ticks that were given up, and those that came though they were told as dropped: the broker
        had taken them and not confirmed it. Neither hides what becomes of those that follow.
    """

    def __init__(self, one: Publishing, counted: Counted) -> None:
        from tests.pmm.console.live_rig import HELLO, frame

        self.one, self.counted = one, counted
        self.number = self.reached = self.lost = self.both = 0
        self.status = OutletStatus("MQTT", False, 0, 0)
        self._first = frame(1)
        one.take(HELLO)

    def on_the_way(self) -> int:
        """Look how it is; return ticks that are neither there, nor dropped, nor given up."""
        told = self.one.statuses()
        self.status = told[0] if told else self.status
        there = self.counted.once - self.both
        return self.number - there - self.status.dropped - self.lost

    def give(self, ticks: int, *, reads: bool) -> None:
        """Hand so many on."""
        if not reads:
            self.counted.unread.append(range(self.number + 1, self.number + ticks + 1))
        for _ in range(ticks):
            self.number += 1
            self.one.take(replace(self._first, number=self.number))
            if self.number % _TOGETHER == 0:
                self._wait_for_room(reads=reads)
        self.reached += ticks * reads

    def _wait_for_room(self, *, reads: bool) -> None:
        def has_room() -> bool:
            fetched = self.one.waiting <= _TOGETHER
            return fetched and (not reads or self.on_the_way() <= _ON_THE_WAY)

        try:
            _wait(has_room)
        except TimeoutError as error:
            held_up = f"{self.on_the_way()} ticks on their way at tick {self.number}"
            raise TimeoutError(f"{held_up}: {error}") from error

    def wait_until_carried(self) -> None:
        """Wait until none waits to be carried; one that was made up in silence is carried too."""

        def is_carried() -> bool:
            self.on_the_way()
            return self.status.carried + self.status.dropped >= self.number

        _wait(is_carried)

    def settle(self) -> None:
        """Wait for the last, which is never dropped; give up those before it that are not there."""
        self.wait_until_carried()
        with suppress(TimeoutError):
            _wait(lambda: self.counted.last >= self.number, _LAST_S)
        left = self.on_the_way()
        self.lost += max(left, 0)
        self.both += max(-left, 0)


def day(folder: Path, share: float, report: Report) -> Day:
    """A day of 24 hours: in one the broker reads nothing, in another it is away."""
    from tests.pmm.console.live_rig import Reader, broker, free_port

    hour, port, counted = round(share * _DAY_S * _RATE_HZ / _HOURS), free_port(), Counted()
    one, sizes = Publishing(_settings(port)), list[float]()
    durable = (*_BROKER, f"user {getuser()}", f"persistence_location {folder}/")
    started = time.monotonic()
    with ExitStack() as stack:
        stack.callback(one.close)
        there = stack.enter_context(ExitStack())
        running = there.enter_context(broker(port, folder, *durable))
        there.enter_context(Reader(port, counted))
        feed, process = Feed(one, counted), psutil.Process(one.pid)
        for number in range(1, _HOURS + 1):
            report(f"hour {number}")
            if number in (_STUCK, _AWAY):
                feed.settle()
            if number == _STUCK:
                running.send_signal(signal.SIGSTOP)
            if number == _AWAY:
                running.terminate()  # it writes its sessions down
                running.wait(_PATIENCE_S)
                there.close()
            feed.give(hour, reads=number not in (_STUCK, _AWAY))
            if number == _STUCK:
                running.send_signal(signal.SIGCONT)
            if number == _AWAY:
                there.enter_context(broker(port, folder, *durable))
                feed.wait_until_carried()  # nobody reads yet: the broker has to keep them
                there.enter_context(Reader(port, counted))
            if number in (_STUCK, _AWAY):
                feed.settle()
            sizes.append(process.memory_info().rss / _MEGA)
        feed.settle()
        processor_s = sum(process.cpu_times()[:2])
    took_s = time.monotonic() - started
    return Day(
        feed.number, counted, feed.reached, feed.status, feed.lost, feed.both, sizes, took_s,
        processor_s,
    )  # fmt: skip


def _settings(port: int) -> Any:
    return live_settings("tank", f"mqtt://127.0.0.1:{port}/t", None, None, None)


def _wait(condition: Callable[[], bool], patience_s: float = _PATIENCE_S) -> None:
    """Wait for a condition.

    Raises
    ------
    TimeoutError
        If it does not come about in time: whatever is waited for is lost or stuck.
    """
    end_s = time.monotonic() + patience_s
    while not condition():
        if time.monotonic() > end_s:
            raise TimeoutError(f"not within {patience_s:g} s")
        time.sleep(0.02)


BENCHMARK = Benchmark("live_values", "Live values over MQTT", _run)
