"""What the compiled sums cost before their first result, in interpreters of their own."""

import os
import subprocess
import sys
import tempfile

from benchmarks.machine import ROOT
from benchmarks.outcome import Row

_FIRST_CALL = """
import time
import numpy as np
from analysis.resolver.compiled import moments
started = time.perf_counter()
import numba
imported = time.perf_counter()
one = np.ones(1)
moments(np.ones((1, 100)), np.zeros(1, np.int64), 90 * np.ones(1, np.int64), one, 0.01 * one, 3)
print(imported - started, time.perf_counter() - imported)
"""


def compile_times() -> list[Row]:
    """Time the import and the first call, with an empty cache and with a full one."""
    rows: list[Row] = []
    with tempfile.TemporaryDirectory() as cache:
        for state in ("empty", "filled"):
            environment = {**os.environ, "NUMBA_CACHE_DIR": cache}
            command = [sys.executable, "-c", _FIRST_CALL]
            done = subprocess.run(
                command, cwd=ROOT, env=environment, check=True, capture_output=True, text=True
            )
            imported, called = (float(word) for word in done.stdout.split())
            rows.append({"cache": state, "import numba, s": imported, "first call, s": called})
    return rows
