"""The command line of the benchmarks."""

import argparse
import time
from collections.abc import Sequence
from functools import partial
from importlib import import_module
from pathlib import Path

from rich.console import Console

from benchmarks.machine import ROOT, describe
from benchmarks.outcome import Benchmark, judge
from benchmarks.page import keep, show, write_page

NAMES = (
    "speed",
    "accuracy",
    "coverage",
    "live",
    "memory",
    "text",
    "startup",
    "classic",
    "simulator",
    "devices",
    "run_control",
    "console",
    "latency",
    "crowd",
    "live_values",
    "inertia",
    "contradictions",
    "comparison",
    "uneven",
    "recorder",
    "archive",
    "questions",
    "kill",
    "soak",
    "faults",
    "coefficients",
    "exact",
    "plan_design",
    "steering",
    "roll",
    "multisine",
    "paths",
    "sequential",
    "campaign",
    "cluster",
    "sealed",
    "gap_cost",
    "evidence",
    "campaign_boards",
    "gap_worlds",
    "gap_odds",
    "forced",
    "decays",
    "gap_loop",
    "signs",
)
_RESULTS = ROOT / "benchmarks" / "results"


def load(name: str) -> Benchmark:
    """Return the benchmark of that name."""
    benchmark: Benchmark = import_module(f"benchmarks.{name}").BENCHMARK
    return benchmark


def main(arguments: Sequence[str]) -> int:
    """Run what is asked for; return 1 where a full run missed a threshold."""
    request = _parse(arguments)
    console = Console(width=None if Console().is_terminal else 160)
    machine = describe()
    missed = 0
    folder = request.output or (None if request.quick else _RESULTS)
    for name in request.names or NAMES:
        benchmark = load(name)
        started = time.monotonic()
        outcome = benchmark.run(request.quick, partial(_progress, console, name))
        show(console, benchmark, outcome)
        console.print(f"({name}: {time.monotonic() - started:.1f} s)\n")
        missed += sum(verdict.met is False for verdict in judge(name, outcome.measured))
        if folder is not None:
            keep(folder, benchmark, outcome, machine, quick=request.quick)
    if folder == _RESULTS and not request.quick:
        write_page(_RESULTS, ROOT / "docs" / "benchmarks.md", list(NAMES))
    if request.quick:
        console.print("Quick: sizes too small for the thresholds to bind; nothing on the page.")
        return 0
    console.print(f"{missed} thresholds missed" if missed else "no threshold missed")
    return int(missed > 0)


def _progress(console: Console, name: str, word: str) -> None:
    """Say what is measured now; nothing turns meanwhile that would take time from it."""
    if console.is_terminal:
        console.print(f"{name}: {word}", style="dim")


def _parse(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(NAMES)}")
    parser.add_argument("--quick", action="store_true", help="small sizes, under a minute in all")
    parser.add_argument(
        "--output", type=Path, metavar="FOLDER", help="where results go (benchmarks/results)"
    )
    request = parser.parse_args(arguments)
    unknown = [name for name in request.names if name not in NAMES]
    if unknown:
        parser.error(f"no benchmark {', '.join(unknown)}; there are {', '.join(NAMES)}")
    if request.output is not None:
        request.output = request.output.resolve()
    return request
