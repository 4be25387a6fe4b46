"""Power cuts of recording runs on faulty disks, as many as are asked for.

``python -m benchmarks.cuts --to 1000`` goes on where the last call ended and keeps what it has
found in ``benchmarks/results/cuts.json`` after every forty, twenty of one run each; it can be
stopped at any time. What a cut is and what is looked for: ``tests/pmm/recorder/power_cuts.py``.
Exit status 1 if anything was lost of what was promised, or altered or lost unseen.
"""

import sys
import tempfile
from pathlib import Path
from typing import Final

from benchmarks.trials import Found, Trials
from tests.pmm.recorder.power_cuts import cut, record

_OF_A_RUN: Final = 20


def carry_out(seeds: range) -> Found:
    """Record a run, and cut it once for each seed."""
    found = Found()
    with tempfile.TemporaryDirectory() as place:
        run = record(seeds.start // _OF_A_RUN, Path(place) / "run")
        for seed in seeds:
            kind, said = cut(run, seed, Path(place) / str(seed))
            found.counts[f"{run.faults.name}: {kind}"] += 1
            found.wrong += [f"seed {seed}: {said}"] if said else []
    return found


TRIALS: Final = Trials("cuts", "cuts", 1000, _OF_A_RUN, 2, carry_out)

if __name__ == "__main__":
    sys.exit(TRIALS.main(sys.argv[1:], __doc__))
