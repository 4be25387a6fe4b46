"""What the command line adds to what the analysis says: option names, and lines to paste."""

import shlex
import sys
from pathlib import Path

# Code of a flag -> the options that act on it.
FLAG_OPTIONS = {
    "few_reference_periods": "--reference, --frequency",
    "frequency_differs": "--frequency, --reference",
    "no_interval": "--periods, --gate",
    "not_steady": "--channel, --steady-tolerance, --opens-at",
    "reference_gap": "--reference, --frequency",
    "stretch_limited": "--channel, --steady-tolerance",
    "time_unit_assumed": "--column or --map",
    "transient": "--opens-at, --periods, --gate",
}
NO_REFERENCE = "--frequency HZ, --reference CHANNEL"
COLUMN_LEFT_OUT = (
    "; a column of the file that is not in the column map is not read: add it there or with "
    "--column, or say keep_others = true in the map"
)


def program() -> str:
    """Return the program as it was called, ``pmm`` where that cannot be told."""
    called = sys.argv[0] if sys.argv else ""
    return called if Path(called).stem == "pmm" else "pmm"


def pasted(*words: str | Path) -> str:
    """Return a command of this program that a shell takes as it is, blanks and all."""
    return shlex.join([program(), *map(str, words)])
