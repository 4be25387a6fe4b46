"""Random sequences of commands and faults on the simulated rig, as many as are asked for.

``python -m benchmarks.storms --to 20000`` goes on where the last call ended and keeps what it has
found in ``benchmarks/results/storms.json`` after every hundred; it can be stopped at any time. What
a sequence is and what is looked for: ``tests/pmm/run/storms.py``. It is made from its seed, so that
any number of workers finds the same. Exit status 1 if anything was wrong.
"""

import sys
from typing import Final

from benchmarks.trials import Found, Trials
from tests.pmm.run.storms import Storm


def carry_out(seeds: range) -> Found:
    """Run sequences of 10 s of the rig's time."""
    found = Found()
    for one in (Storm(seed).run() for seed in seeds):
        found.counts += one.counts
        found.wrong += one.wrong
    return found


TRIALS: Final = Trials("storms", "sequences", 20_000, 1, 100, carry_out)

if __name__ == "__main__":
    sys.exit(TRIALS.main(sys.argv[1:], __doc__))
