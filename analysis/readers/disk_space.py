"""A new file whose room on the disk is taken before anything is written into it."""

import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO, Final

_CANNOT: Final = {errno.EOPNOTSUPP, errno.ENOSYS, errno.EINVAL}  # not every disk can take room


@dataclass(frozen=True)
class Reserved:
    """A new, empty file and the room that it will need at most."""

    file: BinaryIO
    size_bytes: int

    def take(self) -> None:
        """Take the room.

        Raises
        ------
        OSError
            If there is not so much.
        """
        if not hasattr(os, "posix_fallocate"):
            return
        try:
            os.posix_fallocate(self.file.fileno(), 0, self.size_bytes)
        except OSError as error:
            if error.errno not in _CANNOT:
                raise


@contextmanager
def reserved(path: Path, size_bytes: int) -> Iterator[Reserved]:
    """Open a new file for which there is room, and bring it to the disk at the end.

    HDF5 does not outlive a disk that fills up under it: it takes the process with it. It begins
    with an empty file, so the room is tried first, and taken for good once HDF5 has begun.

    Raises
    ------
    OSError
        If there is no room; nothing is written then.
    """
    with path.open("wb+") as file:
        opened = Reserved(file, size_bytes)
        opened.take()
        file.truncate(0)
        yield opened
        file.flush()
        os.fsync(file.fileno())
