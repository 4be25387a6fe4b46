"""The machine as the checks see it; tests hand in another one."""

import ctypes
import os
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, requires, version
from pathlib import Path
from typing import Final

from hardware.serial_port import PluggedPort, plugged_ports
from planar_motion_mechanism import DISTRIBUTION, changed_files
from pmm.real_time import may_lock_memory
from pmm.recorder.disk import free_bytes

_NAPS: Final = 40
_NAP_S: Final = 0.002
_TIMEX_BYTES: Final = 512  # more than any system's struct timex
_UNSYNCHRONISED: Final = 5  # TIME_ERROR of adjtimex(2)


def installed(package: str) -> str | None:
    """Return the version of an installed package, ``None`` without it."""
    try:
        return version(package)
    except PackageNotFoundError:
        return None


def requirements() -> Sequence[str]:
    """Return what the installed package asks for, as its metadata has it; empty if it is not."""
    try:
        return requires(DISTRIBUTION) or ()
    except PackageNotFoundError:
        return ()


def may_use(path: str) -> bool:
    """Tell whether this user may read and write a device."""
    return os.access(path, os.R_OK | os.W_OK)


def may_write(folder: Path) -> bool:
    """Tell whether this user may write in a folder, or make it."""
    while not folder.exists() and folder != folder.parent:
        folder = folder.parent
    return folder.is_dir() and os.access(folder, os.W_OK | os.X_OK)


def highest_priority() -> int | None:
    """Return the real-time priority that this user may take; ``None`` where none is known of."""
    try:
        import resource
    except ImportError:
        return None
    if not hasattr(resource, "RLIMIT_RTPRIO"):
        return None
    if os.geteuid() == 0:
        return 99
    return resource.getrlimit(resource.RLIMIT_RTPRIO)[0]


def synchronised() -> bool | None:
    """Tell whether the clock is kept right over the network; ``None`` where that is not told."""
    if sys.platform != "linux":
        return None
    try:
        state: int = ctypes.CDLL(None).adjtimex(ctypes.create_string_buffer(_TIMEX_BYTES))
    except (OSError, AttributeError):
        return None
    return None if state < 0 else state != _UNSYNCHRONISED


def worst_lateness_s() -> float:
    """Return the worst lateness of some naps of 2 ms, as a control loop takes them."""
    worst = 0.0
    for _ in range(_NAPS):
        begun = time.perf_counter()
        time.sleep(_NAP_S)
        worst = max(worst, time.perf_counter() - begun - _NAP_S)
    return worst


def monotonic_resolution_s() -> float:
    """Return the smallest step of the clock that deadlines are kept by."""
    return time.get_clock_info("monotonic").resolution


@dataclass(frozen=True)
class Machine:
    """Where the checks look, each as a function without side effects.

    Attributes
    ----------
    root
        Of the file system: ``sys/class/net`` below it tells the CAN interfaces.
    python
        Major and minor version.
    home
        The program's own folder, beside whose sources compiled loops are kept.
    compiled_in
        The folder that ``NUMBA_CACHE_DIR`` names, or ``None``.
    """

    root: Path = Path("/")
    python: tuple[int, int] = sys.version_info[:2]
    home: Path = Path(__file__).parents[2]
    compiled_in: str | None = os.environ.get("NUMBA_CACHE_DIR")
    requirements: Callable[[], Sequence[str]] = requirements
    changed_files: Callable[[], Iterable[str]] = changed_files
    installed: Callable[[str], str | None] = installed
    ports: Callable[[], Sequence[PluggedPort]] = plugged_ports
    may_use: Callable[[str], bool] = may_use
    may_write: Callable[[Path], bool] = may_write
    free_bytes: Callable[[Path], int] = free_bytes
    highest_priority: Callable[[], int | None] = highest_priority
    may_lock_memory: Callable[[], bool | None] = may_lock_memory
    synchronised: Callable[[], bool | None] = synchronised
    worst_lateness_s: Callable[[], float] = worst_lateness_s
    monotonic_resolution_s: Callable[[], float] = monotonic_resolution_s
