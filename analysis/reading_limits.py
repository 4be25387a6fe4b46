"""How large a recording may be: stated once, checked before memory is taken, raised by a setting.

A file's size says little: 10 MB of gzip may hold 10 GB of text, and a few bytes of MAT or NetCDF
may state any shape. What every limit follows from is the memory that reading one recording may
take. ``docs/formats.md`` has the table.
"""

import math
import os
from dataclasses import dataclass
from typing import Final

from hardware.description.errors import ConfigurationError, DataError

MEMORY_SETTING: Final = "PMM_READ_MEMORY_GB"
TIME_SETTING: Final = "PMM_READ_SECONDS"
# 40 million values, such as 16 channels at 1 kHz for 36 minutes: on any machine, whatever is sent.
# A longer recording asks for more by the setting, and says how much.
_MEMORY_GB: Final = 1.0
_SECONDS: Final = 60.0  # a child's; 1 GB is read in some seconds, on a slow disk in twenty
# Eight bytes as it was read, in pieces; joined; and as the recording's sample.
_BYTES_A_VALUE: Final = 24
_FOR_TIME: Final = 2  # columns more: what a time base takes while it is fitted
_TEXT: Final = 2.0  # bytes of text over those of memory: cells of 48 letters, or columns not read
MOST_COLUMNS: Final = 4096
LONGEST_LINE: Final = 1 << 17  # bytes: as many columns of 32 letters


@dataclass(frozen=True)
class ReadingLimits:
    """What reading one recording may take: memory, and seconds of a child process."""

    memory_bytes: float = _MEMORY_GB * 1e9
    seconds: float = _SECONDS

    @property
    def text_bytes(self) -> int:
        """Most bytes of a text, unpacked."""
        return int(_TEXT * self.memory_bytes)

    def check_rows(self, rows: int, columns: int, where: str) -> None:
        """Refuse a recording of more rows than there is memory for.

        Parameters
        ----------
        columns
            Those that are read.

        Raises
        ------
        DataError
            With the rows, the limit and the setting.
        """
        most = int(self.memory_bytes / _BYTES_A_VALUE / (columns + _FOR_TIME))
        if rows > most:
            excess = f"{rows} rows or more of {columns} columns, where the limit is {most} rows"
            raise self.too_large(where, excess)

    def too_large(self, where: str, excess: str) -> DataError:
        """Return the error of a recording beyond a limit."""
        return DataError(
            f"{where}: too large: {excess}, so that reading takes no more than "
            f"{self.memory_bytes / 1e9:g} GB of memory; split the recording, or raise "
            f"{MEMORY_SETTING} (pmm --read-memory GB ...)"
        )


def limits() -> ReadingLimits:
    """Return the limits of this process, as the environment sets them.

    Raises
    ------
    ConfigurationError
        If a setting is no number above 0.
    """
    return ReadingLimits(
        _setting(MEMORY_SETTING, _MEMORY_GB) * 1e9, _setting(TIME_SETTING, _SECONDS)
    )


def _setting(name: str, default: float) -> float:
    text = os.environ.get(name, "")
    try:
        value = float(text or default)
    except ValueError:
        value = math.nan
    if not 0.0 < value < math.inf:
        raise ConfigurationError(f"{name} = {text!r} should be a number above 0")
    return value
