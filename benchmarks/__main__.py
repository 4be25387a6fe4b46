"""Measure: ``python -m benchmarks [NAME...] [--quick] [--output FOLDER]``."""

import os
import sys

# One thread for every contender, set before NumPy is loaded: what one core does, and no rival wins
# by taking both.
for _variable in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")

from benchmarks.command import main  # noqa: E402

sys.exit(main(sys.argv[1:]))
