"""Mutate and test: ``python -m benchmarks.mutants``, after ``make coverage``."""

import sys

from benchmarks.mutants.command import main

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
