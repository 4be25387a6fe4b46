"""Commands of this program as lines to paste."""

import shlex
import sys
from pathlib import Path


def program() -> str:
    """Return the program as it was called, ``pmm`` where that cannot be told."""
    called = sys.argv[0] if sys.argv else ""
    return called if Path(called).stem == "pmm" else "pmm"


def pasted(*words: str | Path) -> str:
    """Return a command of this program that a shell takes as it is, blanks and all."""
    return shlex.join([program(), *map(str, words)])
