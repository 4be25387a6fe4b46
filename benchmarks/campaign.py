"""A campaign of 1000 runs: rate beside reading alone, memory, two workers, the same numbers."""

import os
import signal
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from analysis.coefficients.campaign_plan import Request
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.readers import read_recording
from benchmarks.campaign_folder import make_campaign
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from benchmarks.workers import dask_workers
from pmm.coefficients.settings import CoefficientSettings
from pmm.coefficients.solving import TrialBlock, draw_block
from pmm.coefficients.workflow import CampaignOutcome, coefficients_of
from pmm.parallel import InThisProcess, LocalProcesses, open_executor

_GIB = 2.0**30
_SMALL = 40  # runs that go over the cluster
_TRIALS = 5_000


def run(quick: bool, report: Report) -> Outcome:
    """Make the recordings, then read and solve them every way."""
    runs, seconds = (8, 20.0) if quick else (1000, 60.0)
    with tempfile.TemporaryDirectory() as place:
        report(f"writing {runs} recordings")
        folder = make_campaign(Path(place), runs, seconds)
        rows, measured, found = _files(folder, report)
        trials, ratio = _trials(found, 4 if quick else 160, report)
        same, largest = _same(Path(place) / "small", quick, report)
    measured |= {"same_numbers": largest}
    if quick:
        measured = {"same_numbers": largest}
    else:
        measured["two_on_trials"] = ratio
    size_mib = 8 * runs * seconds * 200.0 * 8 / 2**20
    return Outcome(
        {"Recordings to coefficients": rows, "Monte Carlo": trials, "The same numbers": same},
        measured,
        (
            f"{runs} runs of 8 channels, {seconds:g} s at 200 Hz ({size_mib:.0f} MiB of samples), "
            "heave and pitch at five amplitudes and five repeats; reading is every sample of every "
            "channel into memory, from a warm disk cache. Two workers include the start of their "
            "processes; the Monte Carlo does not.",
            "Peak memory adds up the resident sets of the process and its workers, libraries "
            "included each time.",
        ),
    )


def _files(folder: Path, report: Report) -> tuple[list[Row], dict[str, float], CampaignOutcome]:
    paths = sorted(folder.glob("*.nc"))
    _read_all(paths)  # the disk's cache is warm for all of them
    report("reading alone")
    reading_s, _, _ = _timed(lambda: _read_all(paths))
    report("one worker")
    one_s, one_gib, found = _timed(lambda: _solved(folder, InThisProcess()))
    report("two workers")
    two_s, two_gib, other = _timed(lambda: _in_two(folder))
    _check_equal(found.result, other.result)
    rows: list[Row] = [
        _row("reading alone", len(paths), reading_s, reading_s, 0.0),
        _row("one worker", len(paths), one_s, reading_s, one_gib),
        _row("two workers", len(paths), two_s, reading_s, two_gib),
    ]
    measured = {
        "over_reading": one_s / reading_s,
        "peak_gib": two_gib,
        "two_on_files": one_s / two_s,
    }
    return rows, measured, found


def _row(way: str, runs: int, seconds: float, reading_s: float, peak_gib: float) -> Row:
    return {
        "way": way,
        "time, s": seconds,
        "runs/s": runs / seconds,
        "over reading": seconds / reading_s,
        "peak, GiB": peak_gib or "-",
    }


def _read_all(paths: list[Path]) -> float:
    total = 0.0
    for path in paths:
        one = read_recording(path)
        total += float(one.samples[:, 0 : one.sample_count][0, 0])
    return total


def _solved(folder: Path, executor: Executor) -> CampaignOutcome:
    return coefficients_of([folder], CoefficientSettings(), executor, lambda *_: None)


def _in_two(folder: Path) -> CampaignOutcome:
    with open_executor(jobs=2) as executor:
        return _solved(folder, executor)


def _timed(call: Callable[[], Any]) -> tuple[float, float, Any]:
    """Return time, peak memory of this process and its children, and what the call returns."""
    with _watched() as peak:
        started = time.perf_counter()
        found = call()
        seconds = time.perf_counter() - started
    return seconds, max(peak) / _GIB, found


@contextmanager
def _watched() -> Iterator[list[float]]:
    import psutil

    own, peak, over = psutil.Process(), [0.0], threading.Event()

    def watch() -> None:
        while not over.wait(0.05):
            total = 0
            for one in (own, *own.children(recursive=True)):
                try:
                    total += one.memory_info().rss
                except psutil.NoSuchProcess:
                    continue
            peak.append(float(total))

    thread = threading.Thread(target=watch)
    thread.start()
    try:
        yield peak
    finally:
        over.set()
        thread.join()


def _trials(found: CampaignOutcome, blocks: int, report: Report) -> tuple[list[Row], float]:
    """Time blocks of trials of the first group, one worker against two that have started."""
    from analysis.coefficients.campaign_plan import plan
    from analysis.coefficients.linear_fit import linear_fit

    group = plan(found.cycles, Request())[0]
    fit = linear_fit(group.cycles, Request().form, found.stated).fit
    work = [TrialBlock(fit, _TRIALS, 1, k) for k in range(blocks)]
    report("Monte Carlo, one worker")
    one_s, _, one = _timed(lambda: list(map(draw_block, work)))
    two = LocalProcesses(2)
    try:
        list(two.map(draw_block, work[:4]))  # both have started
        report("Monte Carlo, two workers")
        two_s, _, other = _timed(lambda: list(two.map(draw_block, work)))
    finally:
        two.shutdown()
    same = all(np.array_equal(a, b) for a, b in zip(one, other, strict=True))
    count = blocks * _TRIALS
    rows: list[Row] = [
        {"way": way, "runs": len(group.cycles), "trials": count, "time, s": t, "same": str(same)}
        for way, t in (("one worker", one_s), ("two workers", two_s))
    ]
    return rows, one_s / two_s


def _same(folder: Path, quick: bool, report: Report) -> tuple[list[Row], float]:
    """Solve a small campaign on every engine, with Monte Carlo; a Dask worker is killed."""
    folder.mkdir()
    make_campaign(folder, 8 if quick else _SMALL, 20.0)
    settings = CoefficientSettings(trials=1_000 if quick else 10_000, seed=3)
    report("one process, two, and a cluster")
    alone = coefficients_of([folder], settings, InThisProcess(), lambda *_: None).result
    rows: list[Row] = []
    with open_executor(jobs=2) as executor:
        other = coefficients_of([folder], settings, executor, lambda *_: None).result
    rows.append({"engine": "two processes", "largest difference": _apart(alone, other)})
    if not quick:
        cluster = _on_cluster(folder, settings)
        killed = _apart(alone, cluster)
        rows.append({"engine": "Dask, a worker killed", "largest difference": killed})
    return rows, max(float(row["largest difference"]) for row in rows)


def _on_cluster(folder: Path, settings: CoefficientSettings) -> CampaignCoefficients:
    with (
        dask_workers(2) as cluster,
        open_executor(scheduler=cluster.scheduler_address) as executor,
    ):
        victims = [worker.pid for worker in cluster.workers.values()][:1]

        def progress(done: int, total: int, what: str) -> None:
            if what == "reading runs" and done == total // 4 and victims:
                os.kill(victims.pop(), signal.SIGKILL)

        found = coefficients_of([folder], settings, executor, progress).result
        if victims:
            message = "no worker was killed on the way"
            raise RuntimeError(message)
        return found


def _apart(one: CampaignCoefficients, other: CampaignCoefficients) -> float:
    """Largest difference of values, intervals and Monte Carlo, relative."""
    pairs = (
        (one.values, other.values),
        (one.half_widths, other.half_widths),
        (one.trials.low, other.trials.low),
        (one.trials.high, other.trials.high),
    )
    worst = 0.0
    for a, b in pairs:
        if not np.array_equal(np.isnan(a), np.isnan(b)):
            return float("inf")
        off = np.abs(a - b) / np.where(a == 0.0, 1.0, np.abs(a))
        worst = max(worst, float(np.nan_to_num(off).max()))
    return worst


def _check_equal(one: CampaignCoefficients, other: CampaignCoefficients) -> None:
    if _apart(one, other) != 0.0:
        message = "two workers give other numbers than one"
        raise RuntimeError(message)


BENCHMARK = Benchmark("campaign", "Campaigns", run)
