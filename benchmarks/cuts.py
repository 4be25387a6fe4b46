"""Power cuts of recording runs on faulty disks, as many as are asked for.

``python -m benchmarks.cuts --to 1000`` goes on where the last call ended and keeps what it has
found in ``benchmarks/results/cuts.json`` after every twenty, which are cuts of one run; it can be
stopped at any time. What a cut is and what is looked for: ``tests/pmm/recorder/power_cuts.py``.
Exit status 1 if anything was lost of what was promised, or altered or lost unseen.
"""

import argparse
import json
import sys
import tempfile
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from benchmarks.machine import ROOT, with_machine
from tests.pmm.recorder.power_cuts import cut, record

_FILE: Final = ROOT / "benchmarks" / "results" / "cuts.json"
_EACH: Final = 20


def main(arguments: Sequence[str]) -> int:
    """Cut runs up to a seed; return 1 if any cut was wrong."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.cuts", description=__doc__)
    parser.add_argument("--to", type=int, default=1000, help="first seed that is not cut")
    parser.add_argument("--file", type=Path, default=_FILE, help="where counts are kept")
    request = parser.parse_args(arguments)
    kept: dict[str, Any] = {"cuts": 0, "wrong": [], "counts": {}}
    if request.file.exists():
        kept = json.loads(request.file.read_text(encoding="utf-8"))
    if kept["cuts"] < request.to:
        kept = with_machine(kept)
    while kept["cuts"] < request.to:
        first = kept["cuts"]
        kept = _more(kept, range(first, min(first + _EACH, request.to)))
        request.file.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")
    sys.stdout.write(f"{kept['cuts']} cuts, {len(kept['wrong'])} wrong\n")
    return int(bool(kept["wrong"]))


def _more(kept: dict[str, Any], seeds: range) -> dict[str, Any]:
    """Record a run, and cut it once for each seed."""
    counts, wrong = Counter(kept["counts"]), list(kept["wrong"])
    with tempfile.TemporaryDirectory() as place:
        run = record(seeds.start // _EACH, Path(place) / "run")
        for seed in seeds:
            kind, said = cut(run, seed, Path(place) / str(seed))
            counts[f"{run.faults.name}: {kind}"] += 1
            wrong += [{"seed": seed, "what": said}] if said else []
    after = {"cuts": seeds.stop, "wrong": wrong, "counts": dict(sorted(counts.items()))}
    return kept | after


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
