"""Many campaigns on a cluster: two workers measured, more by a simulated scheduler."""

import heapq
import tempfile
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from benchmarks.campaign_folder import make_campaign
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from benchmarks.workers import dask_workers
from pmm.archive.database import open_archive
from pmm.archive.indexing import add_folders
from pmm.archive.results import Analyses
from pmm.cli.archive_analyses import analysed_folder
from pmm.cluster import SENDING_S
from pmm.parallel import (
    IN_HAND_EACH,
    InThisProcess,
    LocalProcesses,
    as_done,
    open_executor,
    tasks_each,
)

_NOW: Final = "2026-01-01T00:00:00+00:00"
_JOB: Final = 10_000  # campaigns of the simulated job
_SENDING_S: Final = (0.0, 0.5 * SENDING_S, SENDING_S, 2.0 * SENDING_S)
_TOGETHER: Final = 10  # tasks of the larger messages that do nothing
_EMPTY: Final = 1000  # messages that do nothing: what sending one costs


def run(quick: bool, report: Report) -> Outcome:
    """Analyse campaigns one after the other and by two workers; simulate more workers."""
    count, seconds = (2, 20.0) if quick else (12, 60.0)
    with tempfile.TemporaryDirectory() as place:
        folders = [_campaign(Path(place) / str(k), seconds) for k in range(count)]
        report("one after the other")
        analysed_folder(folders[0])  # what is compiled or loaded first is none of a task's time
        walls, times = zip(*map(_timed, folders), strict=True)
        with _two(quick) as executor:
            report("two workers")
            wall_s = _added(Path(place) / "archive.sqlite", folders, executor)
            cost = _overhead(executor, 20 if quick else _EMPTY)
    measured = sum(walls) / (2.0 * wall_s)
    rows: list[Row] = [{"workers": 2, "in hand": 2 * IN_HAND_EACH, "by": "measured",
                        "taken for a message, ms": 1e3 * SENDING_S,
                        "efficiency": measured}]  # fmt: skip
    job = np.random.default_rng(0).choice(times, _JOB).tolist()
    found = {}
    for workers in (2, 100, 1000):
        for sending_s in _SENDING_S:
            for each in (1, IN_HAND_EACH, 2 * IN_HAND_EACH):
                simulated = Workers(workers, workers * sending_s)
                found[workers, sending_s, each] = efficiency(job, simulated, each * workers, cost)
    rows += [
        {"workers": workers, "in hand": each * workers, "by": "simulated",
         "taken for a message, ms": 1e3 * sending_s, "efficiency": value}
        for (workers, sending_s, each), value in found.items()
    ]  # fmt: skip
    values = {
        "two": measured,
        "hundred": found[100, SENDING_S, IN_HAND_EACH],
        "thousand": found[1000, SENDING_S, IN_HAND_EACH],
    }
    return Outcome(
        {"Efficiency against one worker": rows},
        {} if quick else values,
        (
            f"A task is the harmonics and coefficients of a campaign of 8 runs of {seconds:g} s, "
            f"{np.mean(walls):.3g} s on the mean of {count}, {np.mean(times):.3g} s of them of the "
            "processor. A message and its answer cost "
            f"{1e3 * cost.message_s:.3g} ms and {1e3 * cost.task_s:.3g} ms for each further task "
            "in it, of the busier of this process and the scheduler (processor time), and the way "
            f"there and back {1e3 * cost.way_s:.3g} ms: by tasks that do nothing.",
            f"Simulated, not measured: {_JOB} tasks of the processor times, drawn with seed 0, for "
            "100 and 1,000 workers of one speed, each message sent to the worker that is free "
            "first, with as many tasks as the program puts in it; disk and network are not in it. "
            "Taken for a message is what the program counts with; 0 sends each task by itself.",
        ),
    )


@dataclass(frozen=True)
class Cost:
    """What messages cost.

    Attributes
    ----------
    message_s, task_s
        Of sending a message and taking its answer, and of each task in it beyond the first, by the
        one process that hands them out.
    way_s
        From there to a worker and back.
    """

    message_s: float = 0.0
    task_s: float = 0.0
    way_s: float = 0.0

    def half_s(self, tasks: int) -> float:
        """Return what a message of some tasks costs one way."""
        return 0.5 * (self.message_s + self.task_s * (tasks - 1))


class Workers(InThisProcess):
    """A cluster's size, as :func:`pmm.parallel.tasks_each` asks for it."""

    def __init__(self, workers: int, round_s: float = 0.0) -> None:
        self.workers, self.round_s = workers, round_s


def efficiency(times_s: Sequence[float], workers: Workers, in_hand: int, cost: Cost) -> float:
    """Return the work's time over the workers' time, by events.

    Parameters
    ----------
    in_hand
        Messages that are with the workers at most.
    """
    free = [0.0] * min(workers.workers, len(times_s))  # when each worker will be
    coming: list[tuple[float, int, float]] = []  # when answers come back, their tasks and work
    now, sent, count, work_s = 0.0, 0, 0, 0.0
    while sent < len(times_s) or coming:
        while coming and (coming[0][0] <= now or len(coming) >= in_hand or sent == len(times_s)):
            back_s, tasks, own_s = heapq.heappop(coming)
            now = max(now, back_s) + cost.half_s(tasks)
            count, work_s = count + tasks, work_s + own_s
        if some := times_s[sent : sent + tasks_each(workers, work_s / count if count else None)]:
            sent += len(some)
            now += cost.half_s(len(some))
            end = max(now + 0.5 * cost.way_s, free[0]) + sum(some)
            heapq.heapreplace(free, end)
            heapq.heappush(coming, (end + 0.5 * cost.way_s, len(some), sum(some)))
    return float(sum(times_s)) / (workers.workers * now)


def _campaign(folder: Path, seconds: float) -> Path:
    folder.mkdir()
    return make_campaign(folder, 8, seconds)


def nothing(_number: int) -> None:
    """Do nothing."""


def _timed(folder: Path) -> tuple[float, float]:
    """Return what a campaign takes, on the clock and of the processor."""
    started, started_here = time.perf_counter(), time.process_time()
    analysed_folder(folder)
    return time.perf_counter() - started, time.process_time() - started_here


def _added(path: Path, folders: Sequence[Path], executor: Executor) -> float:
    list(as_done(executor, analysed_folder, folders[:2]))  # the workers have loaded all they need
    started = time.perf_counter()
    with open_archive(path, create=True) as connection:
        list(add_folders(connection, folders, Analyses(analysed_folder), _NOW, executor))
    return time.perf_counter() - started


def nothings(numbers: Sequence[int]) -> None:
    """Do nothing some times."""
    for one in numbers:
        nothing(one)


def _overhead(executor: Executor, count: int) -> Cost:
    """Return what messages cost, by those of one and of ten tasks that do nothing."""
    one_s, ten_s = (_message_s(executor, count, tasks) for tasks in (1, _TOGETHER))
    ways = []
    for _ in range(20):
        started = time.perf_counter()
        executor.submit(nothing, 0).result()
        ways.append(time.perf_counter() - started)
    return Cost(one_s, max(0.0, ten_s - one_s) / (_TOGETHER - 1), float(np.median(ways)))


def _message_s(executor: Executor, count: int, tasks: int) -> float:
    """Return the processor time of sender or scheduler, the larger, for each message."""
    before = _spent_s(executor)
    for one in [executor.submit(nothings, range(tasks)) for _ in range(count)]:
        one.result()
    return max(b - a for a, b in zip(before, _spent_s(executor), strict=True)) / count


def _spent_s(executor: Executor) -> list[float]:
    client = getattr(executor, "client", None)
    scheduler_s = 0.0 if client is None else float(client.run_on_scheduler(time.process_time))
    return [time.process_time(), scheduler_s]


@contextmanager
def _two(quick: bool) -> Iterator[Executor]:
    if quick:
        local = LocalProcesses(2)
        try:
            yield local
        finally:
            local.shutdown()
        return
    with (
        dask_workers(2, apart=True) as cluster,
        open_executor(scheduler=cluster.scheduler_address) as executor,
    ):
        yield executor


BENCHMARK = Benchmark("cluster", "Many campaigns on a cluster", run)
