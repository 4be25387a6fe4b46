"""What the console costs: frames, processor shares, memory, and what it does to the loop.

Two Chromium of 1400 x 900 show 16 channels of 2000 points. Server and page are the real ones; the
channels come from :mod:`benchmarks.console_source`, because the simulated rig has fewer. Loop and
memory are those of ``pmm console`` on the simulated rig. Needs chromium and chromedriver.
"""

import shutil
import statistics
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Final

import psutil

from benchmarks.console_source import CHANNELS, Source, Watcher
from benchmarks.outcome import Benchmark, Outcome, Report, Row

_WINDOW_S: Final = 20.0
_BROWSERS: Final = 2
_TURNS: Final = 3
_SETTLE_S: Final = 12.0  # until a window of the statistics is free of the start
_HOUR_S: Final = 3600.0
_WARM_S: Final = 300.0  # of the rig's time: rings and pools are full by then
_LEVEL_S: Final = 100.0  # of the rig's time, over which memory is looked at
_FAST: Final = 1000.0  # as fast as the machine goes
_MEGA: Final = 1e6


def _run(quick: bool, report: Report) -> Outcome:
    if shutil.which("chromium") is None or shutil.which("chromedriver") is None:
        return Outcome({}, {}, ("not measured: needs chromium and chromedriver",))
    window_s = _WINDOW_S / 4.0 if quick else _WINDOW_S
    with tempfile.TemporaryDirectory() as folder:
        report(f"{_BROWSERS} browsers, {CHANNELS} channels")
        shown = _shown(Path(folder) / "shown", window_s)
        report("loop without and with browsers")
        alone, watched = _loop(Path(folder) / "loop", window_s)
        report("memory")
        memory = _memory(Path(folder) / "hour", _HOUR_S / 20.0 if quick else _HOUR_S)
    measured = {
        "frames_per_s": min(float(row["frames/s"]) for row in shown[:-1]),
        "client_share": max(float(row["share [%]"]) for row in shown[:-1]),
        "server_share": float(shown[-1]["share [%]"]),
        "growth_mb_per_hour": sum(float(row["growth [MB/h]"]) for row in memory),
        "p99_with_browsers": float(watched["p99 [ms]"]) - float(alone["p99 [ms]"]),
    }
    tables = {
        f"{CHANNELS} channels x 2000 points, 25 frames/s": shown,
        "control loop, 100 Hz": [alone, watched],
        "memory over the rig's time": memory,
    }
    load = psutil.getloadavg()[0] / (psutil.cpu_count() or 1)
    return Outcome(tables, measured, (f"load per core at the end: {load:.1f}",))


def _shown(folder: Path, window_s: float) -> list[Row]:
    """Show synthetic channels to browsers; a row for each, and one for the server."""
    from tests.pmm.console.chromium import browser

    folder.mkdir(parents=True)
    with ExitStack() as stack:
        source = stack.enter_context(Source(folder))
        pages = [stack.enter_context(browser(folder / f"b{k}")) for k in range(_BROWSERS)]
        for page in pages:
            page.open(source.address)
        source.wait(window_s / 2.0)
        trees = [_tree(page.driver.service.process.pid) for page in pages]
        server = [psutil.Process(source.server_pid)]
        before = [_cpu_s(tree) for tree in (*trees, server)]
        frames = [int(page.run("return pmmFrames()")) for page in pages]
        start = time.monotonic()
        source.wait(window_s)
        took_s = time.monotonic() - start
        after = [_cpu_s(tree) for tree in (*trees, server)]
        came = [int(page.run("return pmmFrames()")) for page in pages]
    shares = [100.0 * (b - a) / took_s for a, b in zip(before, after, strict=True)]
    rows: list[Row] = [
        {"process": f"browser {k + 1}", "share [%]": round(shares[k], 1),
         "frames/s": round((came[k] - frames[k]) / took_s, 2)}
        for k in range(_BROWSERS)
    ]  # fmt: skip
    sent = round(source.sent_per_s, 2)
    return [*rows, {"process": "server", "share [%]": round(shares[-1], 1), "frames/s": sent}]


def _loop(folder: Path, window_s: float) -> list[Row]:
    """Record a run in real time; return how late its cycles began, in turns without and with.

    What else the machine does changes by the minute, so both are measured in turns in one run, and
    the medians of the windows are compared.
    """
    from tests.pmm.console.chromium import browser, console, plan, rig_in

    folder.mkdir(parents=True)
    found: dict[int, list[dict[str, Any]]] = {0: [], _BROWSERS: []}
    with ExitStack() as stack:
        one = stack.enter_context(console(rig_in(folder / "rig"), folder / "out"))
        watcher = stack.enter_context(Watcher(one.address))
        watcher.start(plan("bench", periods=1000))
        for turn in range(_TURNS):
            for count, windows in found.items():
                with ExitStack() as shown:
                    for k in range(count):
                        page = shown.enter_context(browser(folder / f"b{turn}{k}"))
                        page.open(one.address)
                    watcher.loops(_SETTLE_S)
                    windows += watcher.loops(window_s)
    return [_late(count, windows) for count, windows in found.items()]


def _late(browsers: int, windows: list[dict[str, Any]]) -> Row:
    """Return the medians over windows of ten seconds, and the worst of all."""
    median = {key: statistics.median(one[key] for one in windows) for key in ("p50_s", "p99_s")}
    return {
        "browsers": browsers,
        "windows": len(windows),
        "p50 [ms]": round(1e3 * median["p50_s"], 3),
        "p99 [ms]": round(1e3 * median["p99_s"], 3),
        "worst p99 [ms]": round(1e3 * max(one["p99_s"] for one in windows), 3),
        "worst [ms]": round(1e3 * max(one["worst_s"] for one in windows), 1),
        "late": sum(one["late"] for one in windows),
    }


def _memory(folder: Path, rig_s: float) -> list[Row]:
    """Record a run as fast as it goes, watched; return how each process grew."""
    from tests.pmm.console.chromium import console, plan, rig_in

    folder.mkdir(parents=True)
    text = plan("bench", periods=int(1.2 * (_WARM_S + rig_s + _LEVEL_S)))
    with ExitStack() as stack:
        one = stack.enter_context(
            console(rig_in(folder / "rig"), folder / "out", "--speed", f"{_FAST:g}")
        )
        watcher = stack.enter_context(Watcher(one.address))
        watcher.start(text)
        watcher.until(_WARM_S)
        loop = next(p for p in psutil.Process().children() if "console" in p.cmdline())
        server = max(loop.children(), key=lambda one: one.memory_info().rss)
        processes = {"loop": loop, "server": server}
        before = _levels(processes, watcher, _WARM_S + _LEVEL_S)
        watcher.until(_WARM_S + rig_s)
        after = _levels(processes, watcher, _WARM_S + rig_s + _LEVEL_S)
        return [
            {
                "process": name,
                "at first [MB]": round(before[name], 1),
                "growth [MB/h]": round((after[name] - before[name]) * _HOUR_S / rig_s, 2),
            }
            for name in processes
        ]


def _levels(
    processes: dict[str, psutil.Process], watcher: Watcher, until_s: float
) -> dict[str, float]:
    """Return the median memory of each process until a time of the rig, in MB.

    Buffers fill and are written: a single moment is off by some megabytes.
    """
    found: dict[str, list[int]] = {name: [] for name in processes}

    def look(frame: dict[str, Any]) -> bool:
        for name, process in processes.items():
            found[name].append(process.memory_info().rss)
        return bool(frame["time_s"] >= until_s)

    watcher.see(look)
    return {name: statistics.median(sizes) / _MEGA for name, sizes in found.items()}


def _tree(pid: int) -> list[psutil.Process]:
    """Return a browser's processes, without its driver."""
    return list(psutil.Process(pid).children(recursive=True))


def _cpu_s(processes: list[psutil.Process]) -> float:
    times = [one.cpu_times() for one in processes if one.is_running()]
    return float(sum(one.user + one.system for one in times))


BENCHMARK = Benchmark("console", "The operator's console", _run)
