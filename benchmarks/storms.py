"""Random sequences of commands and faults on the simulated rig, as many as are asked for.

``python -m benchmarks.storms --to 20000`` goes on where the last call ended and keeps what it has
found in ``benchmarks/results/storms.json`` after every hundred; it can be stopped at any time. What
a sequence is and what is looked for: ``tests/pmm/run/storms.py``. It is made from its seed, so that
any number of workers finds the same. Exit status 1 if anything was wrong.
"""

import argparse
import json
import sys
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import Executor
from pathlib import Path
from typing import Any, Final

from benchmarks.machine import ROOT, with_machine
from pmm.parallel import open_executor
from pmm.whole_file import write_whole
from tests.pmm.run.storms import SECONDS, Found, Storm

_FILE: Final = ROOT / "benchmarks" / "results" / "storms.json"
_EACH: Final = 100


def main(arguments: Sequence[str]) -> int:
    """Run sequences up to a seed; return 1 if a cycle of any was wrong."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.storms", description=__doc__)
    parser.add_argument("--to", type=int, default=20_000, help="first seed that is not run")
    parser.add_argument("--file", type=Path, default=_FILE, help="where counts are kept")
    parser.add_argument("--workers", type=int, default=2, help="processes that run them")
    request = parser.parse_args(arguments)
    kept = _kept(request.file)
    if kept["sequences"] < request.to:
        kept = with_machine(kept)
    with open_executor(request.workers) as executor:
        while kept["sequences"] < request.to:
            first = kept["sequences"]
            kept = _more(executor, kept, range(first, min(first + _EACH, request.to)))
            write_whole(request.file, json.dumps(kept, indent=1) + "\n")
    sys.stdout.write(f"{kept['sequences']} sequences, {len(kept['wrong'])} wrong\n")
    return int(bool(kept["wrong"]))


def _kept(file: Path) -> dict[str, Any]:
    if file.exists():
        found: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
        return found
    return {"sequences": 0, "seconds_each": SECONDS, "wrong": [], "counts": {}}


def _more(executor: Executor, kept: dict[str, Any], seeds: range) -> dict[str, Any]:
    counts, wrong = Counter(kept["counts"]), list(kept["wrong"])
    for found in executor.map(_found, seeds):
        counts += found.counts
        wrong += found.wrong
    after = {"sequences": seeds.stop, "wrong": wrong, "counts": dict(sorted(counts.items()))}
    return kept | after


def _found(seed: int) -> Found:
    return Storm(seed).run()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
