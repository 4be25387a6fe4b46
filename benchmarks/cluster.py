"""Many campaigns on a cluster: two workers measured, more by a simulated scheduler."""

import heapq
import tempfile
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager
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
from pmm.parallel import IN_HAND_EACH, LocalProcesses, as_done, open_executor

_NOW: Final = "2026-01-01T00:00:00+00:00"
_JOB: Final = 10_000  # campaigns of the simulated job
_FIXED: Final = 500  # tasks in hand before they followed the workers
_EMPTY: Final = 1000  # tasks that do nothing: what sending one costs


def run(quick: bool, report: Report) -> Outcome:
    """Analyse campaigns one after the other and by two workers; simulate more workers."""
    count, seconds = (2, 20.0) if quick else (24, 60.0)
    with tempfile.TemporaryDirectory() as place:
        folders = [_campaign(Path(place) / str(k), seconds) for k in range(count)]
        report("one after the other")
        analysed_folder(folders[0])  # what is compiled or loaded first is none of a task's time
        times = [_timed(folder) for folder in folders]
        with _two(quick) as executor:
            report("two workers")
            wall_s = _added(Path(place) / "archive.sqlite", folders, executor)
            cost_s, way_s = _overhead(executor, 20 if quick else _EMPTY)
    measured = sum(times) / (2.0 * wall_s)
    rows: list[Row] = [{"workers": 2, "in hand": 2 * IN_HAND_EACH, "by": "measured",
                        "efficiency": measured}]  # fmt: skip
    job = np.random.default_rng(0).choice(times, _JOB).tolist()
    found = {}
    for workers in (2, 100, 1000):
        for each in (1, IN_HAND_EACH, 2 * IN_HAND_EACH):
            found[workers, each] = efficiency(job, workers, each * workers, cost_s, way_s)
        found[workers, 0] = efficiency(job, workers, _FIXED, cost_s, way_s)
    rows += [
        {"workers": workers, "in hand": each * workers or _FIXED, "by": "simulated",
         "efficiency": value}
        for (workers, each), value in found.items()
    ]  # fmt: skip
    values = {
        "two": measured,
        "hundred": found[100, IN_HAND_EACH],
        "thousand": found[1000, IN_HAND_EACH],
    }
    return Outcome(
        {"Efficiency against one worker": rows},
        {} if quick else values,
        (
            f"A task is the harmonics and coefficients of a campaign of 8 runs of {seconds:g} s, "
            f"{np.mean(times):.3g} s on the mean of {count}; sending one and taking its result "
            f"costs {1e3 * cost_s:.3g} ms of this process, and the way there and back "
            f"{1e3 * way_s:.3g} ms: by tasks that do nothing.",
            f"Simulated, not measured: {_JOB} tasks of the measured times, drawn with seed 0, for "
            "100 and 1,000 workers of one speed, each sent to the worker that is free first; disk "
            "and network are not in it.",
        ),
    )


def efficiency(
    times_s: Sequence[float], workers: int, in_hand: int, cost_s: float, way_s: float
) -> float:
    """Return the work's time over the workers' time, by events.

    Parameters
    ----------
    cost_s
        Of sending a task and taking its result, both by the one process that hands them out.
    way_s
        From there to a worker and back.
    """
    free = [0.0] * min(workers, len(times_s))  # when each worker will be
    coming: list[float] = []  # when results come back
    now = 0.0
    for time_s in times_s:
        while coming and (coming[0] <= now or len(coming) >= in_hand):
            now = max(now, heapq.heappop(coming)) + 0.5 * cost_s
        now += 0.5 * cost_s
        end = max(now + 0.5 * way_s, free[0]) + time_s
        heapq.heapreplace(free, end)
        heapq.heappush(coming, end + 0.5 * way_s)
    while coming:
        now = max(now, heapq.heappop(coming)) + 0.5 * cost_s
    return float(sum(times_s)) / (workers * now)


def _campaign(folder: Path, seconds: float) -> Path:
    folder.mkdir()
    return make_campaign(folder, 8, seconds)


def nothing(_number: int) -> None:
    """Do nothing."""


def _timed(folder: Path) -> float:
    started = time.perf_counter()
    analysed_folder(folder)
    return time.perf_counter() - started


def _added(path: Path, folders: Sequence[Path], executor: Executor) -> float:
    list(as_done(executor, analysed_folder, folders[:2]))  # the workers have loaded all they need
    started = time.perf_counter()
    with open_archive(path, create=True) as connection:
        list(add_folders(connection, folders, Analyses(analysed_folder), _NOW, executor))
    return time.perf_counter() - started


def _overhead(executor: Executor, count: int) -> tuple[float, float]:
    """Return what a task costs where it is sent, and how long it is on its way, in seconds."""
    started = time.perf_counter()
    list(as_done(executor, nothing, range(count), most=count))
    cost_s = (time.perf_counter() - started) / count
    ways = []
    for _ in range(20):
        started = time.perf_counter()
        executor.submit(nothing, 0).result()
        ways.append(time.perf_counter() - started)
    return cost_s, float(np.median(ways))


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
        dask_workers(2) as cluster,
        open_executor(scheduler=cluster.scheduler_address) as executor,
    ):
        yield executor


BENCHMARK = Benchmark("cluster", "Many campaigns on a cluster", run)
