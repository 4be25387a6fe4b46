"""Opens and writes the files of a run, in a thread of its own: the disk never holds up the loop.

What is handed over is written and brought to the disk (fdatasync) at once. A write that fails, on a
full disk for example, is taken back to the last whole piece; everything before stays.
"""

import hashlib
import os
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from pathlib import Path
from typing import Final, TypeAlias

from hardware.description.errors import DataError, PmmError
from hardware.description.room import is_full
from pmm.recorder.disk import DiskFullError
from pmm.recorder.files import STREAMS, sync_data
from pmm.whole_file import sync_folder
from pmm.worker import Worker

Piece: TypeAlias = Callable[[], bytes]
"""Makes bytes to append; called in the journal's thread."""


class _Stream:
    """One file, appended to."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.size = 0
        self.hash = hashlib.sha256()
        self.handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | _BINARY, 0o644)

    def append(self, data: bytes) -> None:
        """Append all of the data, or nothing."""
        rest = memoryview(data)
        try:
            while rest:
                rest = rest[os.write(self.handle, rest) :]
        except OSError:
            os.ftruncate(self.handle, self.size)
            os.lseek(self.handle, self.size, os.SEEK_SET)
            raise
        self.size += len(data)
        self.hash.update(data)


_BINARY: Final = getattr(os, "O_BINARY", 0)


class Journal:
    """The streams of a run's folder.

    Parameters
    ----------
    prepare
        Called first, in the journal's thread: makes room for the files and returns what each begins
        with. All streams of :data:`pmm.recorder.files.STREAMS` are made then.
    """

    def __init__(self, folder: Path, prepare: Callable[[], Mapping[str, bytes]]) -> None:
        self._folder = folder
        self._streams: dict[str, _Stream] = {}
        self._begun = self._opened = False
        self._worker = Worker("recorder")
        self._worker.do(partial(self._open, prepare))

    def opened(self, *, wait: bool) -> bool:
        """Tell whether the files are there, on the disk.

        Parameters
        ----------
        wait
            Until they are.

        Raises
        ------
        PmmError
            If they cannot be made, or a piece could not be written.
        """
        if wait and not self._opened:
            self._worker.wait()
        self.check()
        return self._opened

    @property
    def has_files(self) -> bool:
        """Whether the files were made: there is something to keep."""
        return self._begun

    @property
    def size(self) -> int:
        """Bytes written so far, of all streams."""
        return sum(stream.size for stream in tuple(self._streams.values()))

    @property
    def behind(self) -> int:
        """How many pieces of work wait for the disk."""
        return self._worker.behind

    def hand_over(
        self, pieces: Iterable[tuple[str, Piece]], then: Callable[[], None] | None = None
    ) -> None:
        """Have pieces appended to their files and brought to the disk; ``then`` is called after.

        Raises
        ------
        PmmError
            If an earlier piece could not be written; nothing more is taken then.
        """
        self.check()
        self._worker.do(partial(self._write, tuple(pieces), then))

    def check(self) -> None:
        """Raise what went wrong in writing, if anything did."""
        error = self._worker.error
        if isinstance(error, PmmError):
            raise error.with_traceback(None)
        if error is not None:
            raise self._write_error(error) from error

    def finish(self) -> None:
        """Write what was handed over and end the thread; the files stay open. May be repeated."""
        self._worker.close()

    def replace_head(self, name: str, head: bytes) -> None:
        """Write over the beginning of a finished stream, whose hash is taken anew."""
        stream = self._streams[name]
        os.lseek(stream.handle, 0, os.SEEK_SET)
        os.write(stream.handle, head)
        sync_data(stream.handle)
        stream.hash = hashlib.sha256(stream.path.read_bytes())

    def contents(self) -> dict[str, dict[str, int | str]]:
        """Return size and hash of each file that is not empty."""
        return {
            name: {"bytes": stream.size, "sha256": stream.hash.hexdigest()}
            for name, stream in self._streams.items()
            if stream.size
        }

    def close(self) -> None:
        """Finish and let go of the files; may be repeated."""
        self.finish()
        self._release()

    def _open(self, prepare: Callable[[], Mapping[str, bytes]]) -> None:
        first = prepare()
        for name in STREAMS:
            self._streams[name] = _Stream(self._folder / name)
            self._begun = True
            if name in first:
                self._streams[name].append(first[name])
                sync_data(self._streams[name].handle)
        sync_folder(self._folder)
        self._opened = True

    def _write(self, job: tuple[tuple[str, Piece], ...], then: Callable[[], None] | None) -> None:
        touched = set()
        for name, piece in job:
            self._streams[name].append(piece())
            touched.add(name)
        for name in touched:
            sync_data(self._streams[name].handle)
        if then is not None:
            then()

    def _release(self) -> None:
        for stream in self._streams.values():
            os.close(stream.handle)
        self._streams = {}

    def _write_error(self, error: Exception) -> DiskFullError | DataError:
        if isinstance(error, OSError) and is_full(error):
            return DiskFullError(
                f"{self._folder}: {error.strerror}; what was written before is kept. Make room, "
                f"then: pmm recover {self._folder}"
            )
        return DataError(f"{self._folder}: cannot be written: {error}")
