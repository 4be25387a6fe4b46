"""A disk whose power is cut: what is under a folder is logged, and laid out as a cut leaves it.

Between two syncs a disk may write sectors in any order, or not at all; a sync may fail, which drops
what it was to write, or report done before it is. Names are kept in the order in which they were
given, up to any one of them, unless their folder was synced.
"""

import errno
import os
import stat
from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np
import pytest

SECTOR_BYTES: Final = 512
_SYNCS: Final = ("fsync", "fdatasync")


@dataclass(frozen=True)
class Faults:
    """How a disk misbehaves: shares of its syncs that fail, and that are late by some steps."""

    failing: float = 0.0
    late: float = 0.0
    late_steps: int = 40

    @property
    def name(self) -> str:
        """What kind of disk it is."""
        return "failing syncs" if self.failing else "late syncs" if self.late else "honest"

    @property
    def honest(self) -> bool:
        """Whether what a sync has reported done is done."""
        return not self.late


@dataclass(frozen=True)
class Step:
    """One thing that was asked of the disk.

    Attributes
    ----------
    kind
        ``write``, ``resize``, ``sync``, ``failed``, ``name``, ``sync names``.
    file
        Number of a file; ``None`` where a name goes away.
    done
        Step from which on a sync has done what it said.
    """

    kind: str
    file: int | None = None
    at: int = 0
    data: bytes = b""
    names: tuple[tuple[str, int | None], ...] = ()
    done: int = 0


@dataclass
class _Kept:
    """A file on the disk, and what is on the way to it."""

    data: bytearray = field(default_factory=bytearray)
    waiting: list[Step] = field(default_factory=list)

    def settle(self, is_kept: Callable[[], bool]) -> None:
        """Write what waits, sector by sector, as far as it is kept."""
        for one in self.waiting:
            if one.kind == "resize":
                if is_kept():
                    del self.data[one.at :]
                continue
            for start in range(0, len(one.data), SECTOR_BYTES):
                if is_kept():
                    piece, at = one.data[start : start + SECTOR_BYTES], one.at + start
                    self.data.extend(bytes(max(0, at + len(piece) - len(self.data))))
                    self.data[at : at + len(piece)] = piece
        self.waiting.clear()


class _Disk:
    """What is on a disk after some steps, and on the way to it."""

    def __init__(self, is_kept: Callable[[], bool]) -> None:
        self.files: defaultdict[int, _Kept] = defaultdict(_Kept)
        self.names: dict[str, int | None] = {}
        self.unnamed: list[Step] = []
        self._late: list[Step] = []
        self._is_kept = is_kept

    def take(self, number: int, step: Step) -> None:
        """Do a step; those that are late and due by now are done first."""
        for due in [one for one in self._late if one.done <= number]:
            self._late.remove(due)
            self._settle(due, lambda: True)
        if step.kind in ("write", "resize"):
            self.files[step.file or 0].waiting.append(step)
        elif step.kind == "sync" and step.done > number:
            self._late.append(step)
        elif step.kind == "sync":
            self._settle(step, lambda: True)
        elif step.kind == "failed":
            self._settle(step, self._is_kept)
        elif step.kind == "name":
            self.unnamed.append(step)
        else:
            self.name(len(self.unnamed))

    def name(self, count: int) -> None:
        """Keep so many of the names that wait."""
        self.names.update(pair for one in self.unnamed[:count] for pair in one.names)
        del self.unnamed[:count]

    def _settle(self, step: Step, is_kept: Callable[[], bool]) -> None:
        self.files[step.file or 0].settle(is_kept)


class FaultyDisk:
    """Logs what is asked of the disk below a folder, while it is watched."""

    def __init__(self, folder: Path, faults: Faults, seed: int) -> None:
        self.steps: list[Step] = []
        self._folder, self._faults = folder.resolve(), faults
        self._rng = np.random.default_rng(seed)
        self._files: dict[int, int] = {}  # by inode
        self._logged: set[int] = set()  # whose writes are seen as they are made
        self._count = 0

    @contextmanager
    def watched(self) -> Iterator["FaultyDisk"]:
        """Take the place of the system's calls."""
        with pytest.MonkeyPatch.context() as patch:
            for name in ("open", "write", "ftruncate", "replace", "rename", "unlink", *_SYNCS):
                own = getattr(self, "_sync" if name in _SYNCS else f"_{name}")
                patch.setattr(os, name, self._bound(own, getattr(os, name)))
            yield self

    def image(self, steps: int, seed: int, place: Path) -> None:
        """Lay out what a cut after so many steps leaves."""
        rng = np.random.default_rng(seed)
        share = rng.choice([0.0, 0.5, 0.9, 1.0])
        kept = _Disk(lambda: bool(rng.random() < 0.5))
        for number, one in enumerate(self.steps[:steps]):
            kept.take(number, one)
        kept.name(int(rng.integers(len(kept.unnamed) + 1)))
        place.mkdir(parents=True)
        for name, number in kept.names.items():
            if number is not None:
                kept.files[number].settle(lambda: bool(rng.random() < share))
                (place / name).write_bytes(kept.files[number].data)

    @staticmethod
    def _bound(own: Callable[..., Any], system: Callable[..., Any]) -> Callable[..., Any]:
        return lambda *words, **more: own(system, *words, **more)

    def _name_of(self, path: Any) -> str | None:
        where = Path(os.fsdecode(path)).absolute()
        return where.name if where.parent == self._folder else None

    def _number(self, inode: int) -> int:
        if inode not in self._files:
            self._count += 1
            self._files[inode] = self._count
        return self._files[inode]

    def _open(self, system: Any, path: Any, flags: int, *more: Any, **others: Any) -> int:
        handle: int = system(path, flags, *more, **others)
        if flags & os.O_EXCL and (name := self._name_of(path)) is not None:
            file = self._number(os.fstat(handle).st_ino)
            self._logged.add(file)
            self.steps.append(Step("name", names=((name, file),)))
        return handle

    def _write(self, system: Any, handle: int, data: Any) -> int:
        file = self._files.get(os.fstat(handle).st_ino)
        if file not in self._logged:
            return int(system(handle, data))
        at = os.lseek(handle, 0, os.SEEK_CUR)
        count = int(system(handle, data))
        self.steps.append(Step("write", file, at, bytes(data)[:count]))
        return count

    def _ftruncate(self, system: Any, handle: int, size: int) -> None:
        system(handle, size)
        file = self._files.get(os.fstat(handle).st_ino)
        if file in self._logged:
            self.steps.append(Step("resize", file, size))

    def _sync(self, system: Any, handle: int) -> None:
        about = os.fstat(handle)
        path = Path(f"/proc/self/fd/{handle}").resolve()
        if stat.S_ISDIR(about.st_mode):
            if path == self._folder:
                self.steps.append(Step("sync names"))
            return
        if path.parent != self._folder:
            system(handle)
            return
        file = self._number(about.st_ino)
        if file not in self._logged:
            self.steps.append(Step("name", names=((path.name, file),)))
            self.steps.append(Step("write", file, 0, path.read_bytes()))
        if self._rng.random() < self._faults.failing:
            self.steps.append(Step("failed", file))
            raise OSError(errno.EIO, os.strerror(errno.EIO), str(path))
        is_late = self._rng.random() < self._faults.late
        late = int(self._rng.integers(1, self._faults.late_steps)) if is_late else 0
        self.steps.append(Step("sync", file, done=len(self.steps) + late))

    def _replace(self, system: Any, old: Any, new: Any) -> None:
        was, now = self._name_of(old), self._name_of(new)
        if was is None or now is None:
            system(old, new)
            return
        file = self._number(Path(old).stat().st_ino)
        self._forget(new)
        system(old, new)
        self.steps.append(Step("name", names=((was, None), (now, file))))

    _rename = _replace

    def _unlink(self, system: Any, path: Any, **more: Any) -> None:
        name = self._name_of(path)
        if name is not None:
            self._forget(path)
        system(path, **more)
        if name is not None:
            self.steps.append(Step("name", names=((name, None),)))

    def _forget(self, path: Any) -> None:
        """Let go of the number of a file that goes away; its inode may come again."""
        if Path(path).exists():
            self._files.pop(Path(path).stat().st_ino, None)
