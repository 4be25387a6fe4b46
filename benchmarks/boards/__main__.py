"""Measure a slice of a board: ``python -m benchmarks.boards BOARD``."""

import sys

from pmm.parallel import one_thread

one_thread()  # set before NumPy is loaded

from benchmarks.boards.command import main  # noqa: E402

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
