"""Room on the disk: enough before a run, and still enough in it."""

import shutil
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from hardware.errors import HardwareError, Reaction

RESERVE_BYTES: Final = 256 * 2**20
_FRAME_BYTES: Final = 12  # of a raw log, packed; measured 8 to 10
_MEGA: Final = 1e6


class DiskFullError(HardwareError):
    """No room for the recording: before a run, or while it is being written."""

    reaction = Reaction.PROFILE_STOP

    def __init__(self, message: str) -> None:
        super().__init__("recorder", message)


def bytes_per_s(channels: int, sample_rate_hz: float, frames_per_s: float = 0.0) -> float:
    """Return what a recording takes: journal, NetCDF of the same size, and the raw log."""
    return 16.0 * (channels + 1) * sample_rate_hz + _FRAME_BYTES * frames_per_s


def free_bytes(path: Path) -> int:
    """Return the room on the disk of a path, which need not exist yet."""
    while not path.exists() and path != path.parent:
        path = path.parent
    return shutil.disk_usage(path).free


@dataclass(frozen=True)
class DiskWatch:
    """Watches the disk that a run is recorded to.

    Attributes
    ----------
    bytes_per_s
        What the recording takes; see :func:`bytes_per_s`.
    reserve_bytes
        What has to stay free beside it.
    free
        Returns the free bytes of a path.
    """

    path: Path
    bytes_per_s: float
    reserve_bytes: float = RESERVE_BYTES
    free: Callable[[Path], int] = field(default=free_bytes)

    def check_before(self, duration_s: float) -> None:
        """Refuse a run for which there is no room.

        Raises
        ------
        DiskFullError
            If there is not; the message says what it needs and what is free.
        """
        need, free = duration_s * self.bytes_per_s + self.reserve_bytes, self.free(self.path)
        if free < need:
            raise DiskFullError(
                f"{self.path}: a run of {duration_s:g} s needs {need / _MEGA:.1f} MB "
                f"({self.reserve_bytes / _MEGA:.1f} MB of them in reserve) and "
                f"{free / _MEGA:.1f} MB are free; make room or record to another disk"
            )

    def check_during(self, journal_bytes: int) -> None:
        """Refuse to go on when only the reserve and the room for the NetCDF are left.

        Parameters
        ----------
        journal_bytes
            Size of the journal so far: the NetCDF on close will take as much again.

        Raises
        ------
        DiskFullError
            If so.
        """
        need, free = self.reserve_bytes + journal_bytes, self.free(self.path)
        if free < need:
            raise DiskFullError(
                f"{self.path}: {free / _MEGA:.1f} MB are free; the recording's NetCDF and the "
                f"reserve need {need / _MEGA:.1f} MB. What was recorded is kept; make room"
            )
