"""How long ``pmm --help`` takes to answer, and ``import pmm``."""

import importlib.util
import os
import statistics
import subprocess
import sys

from benchmarks.machine import ROOT
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from benchmarks.timing import Contender, interleave

_HELP = "import sys; sys.argv = ['pmm', '--help']; from pmm.cli import main; main()"


def run(quick: bool, report: Report) -> Outcome:
    """Start interpreters, ten times each; sources are compiled once, as an installation's."""
    contenders = [
        _started("python -c pass", "pass"),
        _started("import numpy", "import numpy"),
        _started("import pmm", "import pmm"),
    ]
    notes = ["Each in a new interpreter; what the installed `pmm --help` does, without its script."]
    measured = {}
    if importlib.util.find_spec("pmm.cli") is None:
        notes.append("pmm --help was left out: there is no pmm.cli.")
    else:
        contenders.append(_started("pmm --help", _HELP))
    interleave(contenders, 3 if quick else 10, report)
    medians = {one.name: statistics.median(one.times_s) for one in contenders}
    measured["import_s"] = medians["import pmm"] - medians["python -c pass"]
    if "pmm --help" in medians:
        measured["help_s"] = medians["pmm --help"]
    return Outcome(
        {"Time to answer": [_row(c, contenders[0]) for c in contenders]}, measured, (*notes,)
    )


def _started(name: str, code: str) -> Contender:
    command = [sys.executable, "-c", code]
    kept = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}

    def call() -> None:
        subprocess.run(command, cwd=ROOT, env=kept, check=True, stdout=subprocess.DEVNULL)

    return Contender(name, call)


def _row(contender: Contender, rival: Contender) -> Row:
    return {
        "command": contender.name,
        "best, ms": 1e3 * contender.best_s,
        "median, ms": 1e3 * statistics.median(contender.times_s),
        f"best over {rival.name}": contender.best_s / rival.best_s,
    }


BENCHMARK = Benchmark("startup", "Start-up", run)
