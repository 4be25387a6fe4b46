"""The operator's side of ``pmm run``: answers from standard input, Ctrl-C once and twice."""

import queue
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from types import FrameType
from typing import Final, TextIO

from pmm.run.states import Command, RunStateError

_STOPS: Final = ("SIGINT", "SIGTERM")
_HANGS_UP: Final = ("SIGHUP",)  # a terminal that is closed; twice by the shell and the system
# Ctrl-Z, and reading or writing in the background: a program that is halted watches no drive.
_HALTS: Final = ("SIGTSTP", "SIGTTIN", "SIGTTOU")


class OperatorAnswers:
    """Answers to questions, line by line, without ever waiting for one.

    The lines are read in a thread of their own, from the first question on.

    Attributes
    ----------
    absent
        Whether no answer can come any more: the input has ended.
    question
        What was asked last and is not answered; empty if nothing.
    """

    def __init__(self, source: TextIO) -> None:
        self._source = source
        self._lines: queue.SimpleQueue[str | None] = queue.SimpleQueue()
        self._reader: threading.Thread | None = None
        self.absent = False
        self.question = ""

    def __call__(self, question: str) -> str | None:
        """Return the answer, once there is one."""
        self.question = question
        if self._reader is None:
            self._reader = threading.Thread(target=self._read, name="answers", daemon=True)
            self._reader.start()
        try:
            line = None if self.absent else self._lines.get_nowait()
        except queue.Empty:
            return None
        if line is None:
            self.absent = True
            return None
        self.question = ""
        return line.strip()

    def _read(self) -> None:
        try:
            for line in self._source:
                self._lines.put(line)
        except (OSError, ValueError):
            pass  # closed under the reader: the same as its end
        self._lines.put(None)


class Interrupts:
    """Counts what asks for a stop; the loop looks at the count, so that nothing is torn apart.

    Ctrl-C and SIGTERM count each time; a terminal that is closed counts as one of them, unless
    ``nohup`` has it ignored. Nothing halts the program meanwhile: Ctrl-Z is ignored.

    Attributes
    ----------
    count
        How many there were so far.
    heard
        How many of them have been handed on.
    """

    def __init__(self) -> None:
        self.count = self.heard = 0

    def hand_on(self, request: Callable[[Command], object]) -> None:
        """Request a gentle stop at the first, a quick one at each other, unless it has stopped."""
        if self.count > self.heard:
            self.heard += 1
            with suppress(RunStateError):
                request(Command.STOP if self.heard == 1 else Command.QUICK_STOP)

    def _take(self, _number: int, _frame: FrameType | None) -> None:
        self.count += 1

    def _hang_up(self, _number: int, _frame: FrameType | None) -> None:
        self.count = max(self.count, 1)

    @contextmanager
    def counted(self) -> Iterator[None]:
        """Count them for as long as the context lasts."""
        handlers: dict[signal.Signals, Callable[..., None] | signal.Handlers] = {
            **dict.fromkeys(_available_signals(_STOPS), self._take),
            **dict.fromkeys(_available_signals(_HALTS), signal.SIG_IGN),
        }
        for signum in _available_signals(_HANGS_UP):
            if signal.getsignal(signum) is not signal.SIG_IGN:
                handlers[signum] = self._hang_up
        before = {signum: signal.signal(signum, handler) for signum, handler in handlers.items()}
        try:
            yield
        finally:
            for signum, handler in before.items():
                signal.signal(signum, handler)


def _available_signals(names: Sequence[str]) -> list[signal.Signals]:
    """Return the signals of these names that the system has."""
    return [signal.Signals[name] for name in names if name in signal.Signals.__members__]


def standard_input() -> OperatorAnswers:
    """Return the answers that are typed in or piped."""
    return OperatorAnswers(sys.stdin)
