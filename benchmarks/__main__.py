"""Measure: ``python -m benchmarks [NAME...] [--quick] [--output FOLDER]``."""

import sys

from pmm.parallel import one_thread

# One thread for every contender, set before NumPy is loaded: what one core does, and no rival wins
# by taking both.
one_thread()

from benchmarks.command import main  # noqa: E402

sys.exit(main(sys.argv[1:]))
