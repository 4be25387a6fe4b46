"""What the system says of a disk that takes nothing more, in a sentence."""

import errno
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from pathlib import Path

_FULL: Final = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}


def is_full(error: OSError) -> bool:
    """Tell whether an error says that there is no room: disk, quota or size limit."""
    return error.errno in _FULL


def file_error_text(error: OSError, path: "Path | str | None" = None) -> str:
    """Return what went wrong with a file, and the remedy where there is no room for it.

    Parameters
    ----------
    path
        The file; the error's own by default, which not every error names.
    """
    where = error.filename if path is None else path
    why = error.strerror or str(error)
    if is_full(error):
        named = "a file could not be written" if where is None else str(where)
        return f"{named}: no room on the disk ({why}); make room, or write to another disk"
    return why if where is None else f"{where}: {why}"
