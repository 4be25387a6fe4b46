"""The parent process: it hands files to a child process that reads them one after another."""

import atexit
import json
import os
import signal
import subprocess
import sys
from dataclasses import asdict, dataclass, field
from pathlib import Path
from threading import Lock, Timer
from typing import IO, Any, Final, cast

import numpy as np

from analysis.foreign.columns import LONGEST_ANSWER, ForeignColumns
from analysis.reading_limits import TIME_SETTING, ReadingLimits, limits
from hardware.description.errors import DataError

# -P: no module of the folder that the user happens to be in is taken for one of ours.
_COMMAND: Final = (sys.executable, "-P", "-m", "analysis.foreign.child")
_ROOT: Final = Path(__file__).parents[2]


def read_foreign(path: Path, kind: str, reader: str) -> ForeignColumns:
    """Return the columns of a binary file, read in a process that may die over it.

    A child is kept for the next file, so that its start is paid once.

    Parameters
    ----------
    kind
        As in messages: ``"mat"`` or ``"tdms"``, for example.
    reader
        The function that reads, ``module:name``; the child imports it.

    Raises
    ------
    DataError
        If the file is refused, ends the child, or takes more memory or time than the limits.
    """
    allowed = limits()
    child = _idle.take() or _Child()
    try:
        columns = child.read(path, kind, reader, allowed)
    except BaseException:
        child.end()
        raise
    _idle.keep(child)
    if isinstance(columns, DataError):
        raise columns
    return columns


def end_children() -> None:
    """End the child that is kept; the next file starts another."""
    while (child := _idle.take()) is not None:
        child.end()


@dataclass
class _Idle:
    """Children without work; those of a process that this one was forked from are not ours."""

    children: list["_Child"] = field(default_factory=list)
    lock: Lock = field(default_factory=Lock)

    def take(self) -> "_Child | None":
        with self.lock:
            while self.children:
                child = self.children.pop()
                if child.is_alive():
                    return child
        return None

    def keep(self, child: "_Child") -> None:
        """Keep one; as many threads as read at once have one each, and only one stays."""
        with self.lock:
            if not self.children:
                self.children.append(child)
                return
        child.end()


class _Child:
    """A process of :mod:`analysis.foreign.child`."""

    def __init__(self) -> None:
        paths = [str(_ROOT), os.environ.get("PYTHONPATH", "")]
        single_thread = {
            "OPENBLAS_NUM_THREADS": "1",
            "OMP_NUM_THREADS": "1",
            "MKL_NUM_THREADS": "1",
        }
        self._parent, self._was_late = os.getpid(), False
        self._process = subprocess.Popen(  # noqa: S603 - this interpreter and our own module
            _COMMAND,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env={**os.environ, **single_thread, "PYTHONPATH": os.pathsep.join(filter(None, paths))},
        )

    @property
    def _answers(self) -> IO[bytes]:
        return cast("IO[bytes]", self._process.stdout)

    def is_alive(self) -> bool:
        """Whether it can be asked: it runs, and is this process's own."""
        return self._parent == os.getpid() and self._process.poll() is None

    def end(self) -> None:
        """End it, whatever it is at."""
        self._process.kill()
        with self._process:  # closes the pipes, and waits
            pass

    def read(
        self, path: Path, kind: str, reader: str, allowed: ReadingLimits
    ) -> ForeignColumns | DataError:
        """Return what it found, or why the file is refused.

        Raises
        ------
        DataError
            If it died, or had to be ended.
        """
        late = Timer(allowed.seconds, self._end_late)
        late.start()
        try:
            answer = self._ask({"path": str(path.absolute()), "reader": reader, **asdict(allowed)})
            if "columns" in answer:
                return self._columns(answer, allowed, str(path))
        except (EOFError, BrokenPipeError, ValueError):
            raise self._death(f"{path}: the reader of {kind.upper()} files", allowed) from None
        finally:
            late.cancel()
            late.join()
        if "memory" in answer:
            return allowed.too_large(str(path), f"the file's {kind.upper()} content")
        return DataError(f"{path}: {answer['refused']}")

    def _end_late(self) -> None:
        self._was_late = True
        self._process.kill()

    def _death(self, reader: str, allowed: ReadingLimits) -> DataError:
        """Say how it ended."""
        self._process.kill()
        status = self._process.wait()
        if self._was_late:
            return DataError(
                f"{reader} took longer than {allowed.seconds:g} s and was ended; if the file is "
                f"sound, raise {TIME_SETTING}"
            )
        return DataError(
            f"{reader} was ended by it ({_signal(status)}): the file is damaged; export it again, "
            "or as CSV"
        )

    def _ask(self, request: dict[str, Any]) -> dict[str, Any]:
        line = cast("IO[bytes]", self._process.stdin)
        line.write(json.dumps(request).encode() + b"\n")
        line.flush()
        reply = self._answers.readline(LONGEST_ANSWER)
        if not reply.endswith(b"\n"):
            raise EOFError
        answer: dict[str, Any] = json.loads(reply)
        return answer

    def _columns(
        self, answer: dict[str, Any], allowed: ReadingLimits, where: str
    ) -> ForeignColumns:
        columns = answer["columns"]
        longest = max((count for _, _, count in columns), default=0)
        allowed.check_rows(longest, len(columns), where)
        values = {name: self._numbers(count) for name, _, count in columns}
        units = {name: unit for name, unit, _ in columns}
        return ForeignColumns(values, units, answer["sample_rate_hz"], answer["no_rate"])

    def _numbers(self, count: int) -> np.ndarray[Any, np.dtype[np.float64]]:
        values = np.empty(count)
        if self._answers.readinto(values.data.cast("B")) < values.nbytes:  # type: ignore[attr-defined]
            raise EOFError
        return values


def _signal(status: int) -> str:
    """Return how a process ended that did not end by itself."""
    try:
        return signal.Signals(-status).name
    except ValueError:
        return f"status {status}"


_idle: Final = _Idle()
atexit.register(end_children)
