"""How much memory a process has taken."""

import resource
import sys
from pathlib import Path


def peak_bytes() -> int:
    """Return the largest resident memory of this process so far.

    From ``/proc`` where there is one: what ``getrusage`` tells of a process starts, on Linux, with
    the peak of the one that started it.
    """
    status = Path("/proc/self/status")
    if status.exists():
        for line in status.read_text(encoding="utf-8").splitlines():
            if line.startswith("VmHWM:"):
                return 1024 * int(line.split()[1])
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else 1024 * peak
