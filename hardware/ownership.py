"""Who owns a folder or a bus: one process at a time, for as long as it lives.

The system's own lock on a file (``filelock``) ends with its process, however that ends. Who holds
it stands in the file, for the message to whoever comes second.
"""

import json
import os
import platform
import sys
import tempfile
import threading
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from hashlib import sha256
from pathlib import Path
from typing import Final, Self, TypeVar

from filelock import FileLock, Timeout

from hardware.description.errors import DataError
from hardware.wall_clock import utc_now

# A reader that asks who the owner is holds the lock for an instant; an owner-to-be outlasts it.
# Halved, a busy machine might refuse for a reader's sake; doubled, a refusal takes a second.
PATIENCE_S: Final = 0.5
_MODE: Final = 0o666  # whoever else may write to the folder, or has the machine's buses, locks too
_LONGEST_COMMAND: Final = 200
_KEPT_OF_NAME: Final = 40


class OwnedElsewhereError(DataError):
    """Another process owns the folder, bus or port; or nothing can be locked there."""


@dataclass(frozen=True)
class Owner:
    """A process that owns something.

    Attributes
    ----------
    since_utc
        When it took it, in ISO 8601.
    """

    pid: int
    command: str
    since_utc: str
    host: str

    def __str__(self) -> str:
        """Name it as a person would look for it."""
        place = "" if self.host == platform.node() else f" on {self.host}"
        return f"process {self.pid}{place} ({self.command}), since {self.since_utc}"


@dataclass
class Ownership:
    """A thing that this process owns until :meth:`release`; use it in a ``with`` block."""

    path: Path
    _lock: FileLock = field(repr=False)
    _count: int = 1

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.release()

    def release(self) -> None:
        """Let go, once for each time that it was taken."""
        with _GUARD:
            self._count -= 1
            if self._count == 0:
                del _HELD[_key(self.path)]
                with suppress(OSError):  # a folder that is gone holds no record either
                    os.truncate(self.path, 0)
                self._lock.release()


T = TypeVar("T", bound=Ownership)
_GUARD: Final = threading.RLock()
_HELD: Final[dict[Path, Ownership]] = {}


def acquire(path: Path, message: str) -> Ownership:
    """Own what a lock file stands for.

    Parameters
    ----------
    path
        The lock file; it is made, and stays when it is let go of, empty.
    message
        What is owned, for the message: "out is being written".

    Raises
    ------
    OwnedElsewhereError
        If another process (or part of this one) owns it; the message names it. Also where the
        disk cannot lock a file.
    """
    with _GUARD:
        if _key(path) in _HELD:
            raise OwnedElsewhereError(f"{message} by this very process")
        return _owned(path, message, PATIENCE_S, Ownership)


def own_together(path: Path, message: str, kind: type[T], *, patience_s: float = PATIENCE_S) -> T:
    """Own as :func:`acquire`, but together with the other parts of this process; they share one.

    Parameters
    ----------
    kind
        What is shared: an ownership that carries more.
    patience_s
        How long to wait for it; 0 in a loop that must not wait.
    """
    with _GUARD:
        held = _HELD.get(_key(path))
        if not isinstance(held, kind):
            return _owned(path, message, patience_s, kind)
        held._count += 1
        return held


def owner_of(path: Path) -> Owner | None:
    """Return the other process that owns what a lock file stands for; nothing is made or changed.

    ``None`` if nobody does, this process does, or the file cannot be looked at.
    """
    with _GUARD:
        if _key(path) in _HELD:
            return None
        owner = _record(path)
        if owner is None:
            return None
        probe = FileLock(path, blocking=False, thread_local=False)
        try:
            probe.acquire()
        except Timeout:
            return _record(path) or owner
        except OSError:
            return None
        probe.release()  # what a process left that was killed
        return None


def machine_lock(key: str) -> Path:
    """Return the lock file of something that all users of this machine share, a bus for example."""
    name = "".join(char if char.isalnum() else "-" for char in key)[-_KEPT_OF_NAME:].strip("-")
    digest = sha256(key.encode()).hexdigest()[:12]
    return Path(tempfile.gettempdir()) / f"pmm-{name}-{digest}.lock"


def own_on_machine(key: str) -> Ownership:
    """Own a device that all users of this machine share; as :func:`acquire`."""
    return acquire(machine_lock(key), "in use")


def _owned(path: Path, message: str, patience_s: float, kind: type[T]) -> T:
    mine = kind(path, _locked(path, message, patience_s))
    _HELD[_key(path)] = mine
    return mine


def _locked(path: Path, message: str, patience_s: float) -> FileLock:
    lock = FileLock(path, patience_s, _MODE, thread_local=False, on_acquired=_sign)
    try:
        lock.acquire()
    except Timeout:
        by = _record(path) or "another process"
        raise OwnedElsewhereError(f"{message} by {by}; wait for it or stop it") from None
    except OSError as error:
        raise OwnedElsewhereError(
            f"{path}: cannot be locked ({error.strerror or error}), and without a lock two "
            "processes would mix what they write; use a folder that you may write to, on a disk "
            "that locks files"
        ) from error
    return lock


def _sign(handle: int) -> None:
    """Write who owns it into the lock file."""
    command = " ".join([Path(sys.argv[0]).name, *sys.argv[1:]])[:_LONGEST_COMMAND]
    mine = Owner(os.getpid(), command, utc_now(), platform.node())
    with suppress(OSError):  # on a full disk the lock holds, only its owner stays unnamed
        os.ftruncate(handle, 0)
        os.lseek(handle, 0, os.SEEK_SET)
        os.write(handle, json.dumps(asdict(mine)).encode())


def _record(path: Path) -> Owner | None:
    """Return what the lock file says; ``None`` if it says nothing."""
    try:
        return Owner(**json.loads(path.read_text(encoding="utf-8")))
    except (OSError, ValueError, TypeError):
        return None


def _key(path: Path) -> Path:
    return path.parent.resolve() / path.name
