"""What the figures were measured on."""

import os
import platform
import subprocess
import sys
from collections.abc import Mapping
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).parents[1]
MEASURED = ("pmm", "hardware", "analysis", "sim", "tests/sealed")


def describe() -> dict[str, str]:
    """Return the machine, the versions of what matters, the commit and the date."""
    return {
        "date": datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"),
        "commit": commit(),
        "cpu": _cpu_model(),
        "cores": str(os.cpu_count()),
        "load_at_start": _load(),
        "os": platform.platform(),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "blas": _blas(),
        "blas_threads": os.environ.get("OPENBLAS_NUM_THREADS", "default"),
        **{name: version(name) for name in ("numba", "scipy", "ulia", "rota-order")},
    }


def with_machine(kept: Mapping[str, Any]) -> dict[str, Any]:
    """Return counts with the machine that goes on counting, and every commit that counted."""
    machine = describe()
    commits = dict.fromkeys([*kept.get("commits", ()), machine["commit"]])
    return {**kept, "machine": machine, "commits": list(commits)}


def version(distribution: str) -> str:
    """Return the version of an installed package, or that it is not."""
    try:
        return metadata.version(distribution)
    except metadata.PackageNotFoundError:
        return "not installed"


def commit() -> str:
    """Return the commit that is checked out, marked where the measured code differs from it."""
    try:
        name = _git("rev-parse", "--short", "HEAD")
        changed = _git("status", "--porcelain", "--", *MEASURED)
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return f"{name} with changes" if changed else name


def _git(*arguments: str) -> str:
    command = ["git", "-C", str(ROOT), *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return done.stdout.strip()


def _cpu_model() -> str:
    information = Path("/proc/cpuinfo")
    if information.exists():
        for line in information.read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or "unknown"


def _load() -> str:
    """Return the load, and whether the measurement takes its cores from it (``chrt -f 10``)."""
    if sys.platform == "win32":
        return "unknown"
    first = sys.platform == "linux" and os.sched_getscheduler(0) == os.SCHED_FIFO
    return f"{os.getloadavg()[0]:.2f}{' by others of lower priority' if first else ''}"


def _blas() -> str:
    blas = np.show_config(mode="dicts")["Build Dependencies"]["blas"]
    return f"{blas.get('name', 'unknown')} {blas.get('version', '')}".strip()
