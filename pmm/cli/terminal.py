"""The terminal while a rig moves: stopped, slow or gone, nobody waits for it."""

import errno
import io
import os
import sys
from collections.abc import Callable
from contextlib import ExitStack, redirect_stderr, redirect_stdout
from typing import TYPE_CHECKING, Final, Self, TextIO, cast

from pmm.cli.screen import messages
from pmm.worker import Job, Worker

if TYPE_CHECKING:
    from rich.console import Console

# Some 100 kB. Halved, a pause of the terminal loses lines in a long campaign; doubled, it is still
# nothing: one line is a change of state, and a run has about ten.
LINES: Final = 1000


class Terminal:
    """Standard error, written in a thread of its own; use it in a ``with`` block.

    Whatever else is printed meanwhile goes the same way: a library's warning must not hold up the
    loop either. Where nobody reads any more, nothing is shown any more, and nothing else happens.

    Parameters
    ----------
    stream
        What to write to; standard error unless given.

    Attributes
    ----------
    console
        For jobs that draw.
    lost
        Lines that were not shown, because :data:`LINES` waited already, and not yet said to be.
    """

    def __init__(self, stream: TextIO | None = None) -> None:
        self.console: Console = messages(cast("TextIO", _Direct(stream or sys.stderr)))
        self.lost = 0
        self._worker = Worker("terminal")
        self._redirected = ExitStack()

    def __enter__(self) -> Self:
        self._redirected.enter_context(redirect_stdout(_Lines(self.say)))
        self._redirected.enter_context(redirect_stderr(_Lines(self.say)))
        return self

    def __exit__(self, *_: object) -> None:
        """Wait until all is shown, as any program does at its end."""
        self._redirected.close()
        self._tell_lost(sys.maxsize)
        self._worker.close()

    def say(self, line: str) -> None:
        """Show a line below all others."""
        self._tell_lost()
        if not self._worker.offer(lambda: self.console.print(line, soft_wrap=True), LINES):
            self.lost += 1

    def draw(self, job: Job) -> bool:
        """Show a picture unless an earlier one is still on its way; tell whether it will be."""
        return self._worker.offer(job, 1)

    def do(self, job: Job) -> None:
        """Show what must not be left out: the beginning and the end of a picture."""
        self._worker.do(job)

    def _tell_lost(self, most: int = LINES) -> None:
        line = f"({self.lost} lines are left out here: the terminal took nothing)"
        if self.lost and self._worker.offer(lambda: self.console.print(line), most):
            self.lost = 0


class _Direct(io.TextIOBase):
    """Writes at once to a stream's file, past its buffer.

    A thread that a stopped terminal holds up holds no lock then that the end of the program needs.
    """

    def __init__(self, stream: TextIO | None) -> None:
        self._stream = stream
        try:
            self._handle = -1 if stream is None else stream.fileno()
        except (OSError, ValueError):  # no file: a test's, or a notebook's
            self._handle = -1

    @property
    def encoding(self) -> str:  # type: ignore[override]
        """That of the stream."""
        return getattr(self._stream, "encoding", None) or "utf-8"

    def isatty(self) -> bool:
        """Tell whether the stream is a terminal."""
        return self._stream is not None and self._stream.isatty()

    def fileno(self) -> int:
        """Return the stream's file."""
        if self._handle < 0:
            raise io.UnsupportedOperation("fileno")
        return self._handle

    def write(self, text: str) -> int:
        """Write all of it, however long that takes.

        Raises
        ------
        OSError
            If nobody reads it; never as ``BrokenPipeError``, by which rich would end the program.
        """
        if self._handle < 0:
            return len(text) if self._stream is None else self._stream.write(text)
        rest = memoryview(text.encode(self.encoding, "backslashreplace"))
        try:
            while rest:
                rest = rest[os.write(self._handle, rest) :]
        except OSError as error:
            raise OSError(errno.EIO, "nobody reads what is shown") from error
        return len(text)


class _Lines(io.TextIOBase):
    """Takes text and hands it on line by line."""

    def __init__(self, say: Callable[[str], None]) -> None:
        self._say, self._part = say, ""

    def write(self, text: str) -> int:
        """Hand on the lines that are whole."""
        *lines, self._part = (self._part + text).split("\n")
        for line in lines:
            self._say(line)
        return len(text)
