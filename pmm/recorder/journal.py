"""Appends to the files of a run, in a thread of its own, so that the disk never holds up the loop.

What is handed over is written and brought to the disk (fdatasync) at once. A write that fails, on a
full disk for example, is taken back to the last whole piece; everything before stays.
"""

import hashlib
import os
import queue
import threading
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Final, TypeAlias

from hardware.description.errors import DataError
from pmm.recorder.disk import DiskFullError, is_full
from pmm.recorder.files import STREAMS, lock, sync_data, sync_folder

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
        left = memoryview(data)
        try:
            while left:
                left = left[os.write(self.handle, left) :]
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
    first
        What each file begins with; all streams of :data:`pmm.recorder.files.STREAMS` are made.

    Raises
    ------
    DiskFullError, OSError
        If the files cannot be made.
    """

    def __init__(self, folder: Path, first: Mapping[str, bytes]) -> None:
        self._folder = folder
        self._streams: dict[str, _Stream] = {}
        self._jobs: queue.SimpleQueue[tuple[tuple[str, Piece], ...] | None] = queue.SimpleQueue()
        self._error: Exception | None = None
        self._pending = 0
        try:
            for name in STREAMS:
                self._streams[name] = _Stream(folder / name)
                self._streams[name].append(first.get(name, b""))
                sync_data(self._streams[name].handle)
            lock(self._streams[STREAMS[0]].handle, folder)
            sync_folder(folder)
        except BaseException as error:
            self._release()
            if isinstance(error, OSError):
                raise self._named(error) from error
            raise
        self._thread = threading.Thread(target=self._work, name="recorder", daemon=True)
        self._thread.start()

    @property
    def size(self) -> int:
        """Bytes that are written."""
        return sum(one.size for one in self._streams.values())

    @property
    def behind(self) -> int:
        """How many pieces of work wait for the disk."""
        return self._pending

    def hand_over(self, pieces: Iterable[tuple[str, Piece]]) -> None:
        """Have pieces appended to their files and brought to the disk.

        Raises
        ------
        DiskFullError, DataError
            If an earlier piece could not be written; nothing more is taken then.
        """
        self.check()
        self._pending += 1
        self._jobs.put(tuple(pieces))

    def check(self) -> None:
        """Raise what went wrong in writing, if anything did."""
        if self._error is not None:
            raise self._named(self._error) from self._error

    def finish(self) -> None:
        """Write what was handed over and end the thread; the files stay open. May be repeated."""
        if self._thread.is_alive():
            self._jobs.put(None)
            self._thread.join()

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
            name: {"bytes": one.size, "sha256": one.hash.hexdigest()}
            for name, one in self._streams.items()
            if one.size
        }

    def close(self) -> None:
        """Finish and let go of the files; may be repeated."""
        self.finish()
        self._release()

    def _work(self) -> None:
        while (job := self._jobs.get()) is not None:
            if self._error is None:
                try:
                    self._write(job)
                except Exception as error:  # the loop has to learn of whatever it was
                    self._error = error
            self._pending -= 1

    def _write(self, job: tuple[tuple[str, Piece], ...]) -> None:
        touched = set()
        for name, piece in job:
            self._streams[name].append(piece())
            touched.add(name)
        for name in touched:
            sync_data(self._streams[name].handle)

    def _release(self) -> None:
        for one in self._streams.values():
            os.close(one.handle)
        self._streams = {}

    def _named(self, error: Exception) -> DiskFullError | DataError:
        if isinstance(error, OSError) and is_full(error):
            return DiskFullError(
                f"{self._folder}: {error.strerror}; what was written before is kept. Make room, "
                f"then: pmm recover {self._folder}"
            )
        return DataError(f"{self._folder}: cannot be written: {error}")
