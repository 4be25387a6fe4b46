"""What the jobs of ``pmm devices`` share: opening, asking a person, plain tables."""

import queue
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Final, TextIO

import click

from hardware.description.errors import ConfigurationError
from hardware.pacing import FreeRunning, RealTime
from hardware.rig import Rig
from hardware.rig_configuration import RigConfiguration
from pmm.cli.screen import messages, output
from pmm.devices.opening import SIMULATED

if TYPE_CHECKING:
    from rich.table import Table

JSON_SCHEMA: Final = "pmm-devices-1"


class Person:
    """Asks a person on the error stream; answers are read from standard input without waiting.

    Attributes
    ----------
    absent
        Nobody will answer: a simulated rig then does what is asked by itself.
    """

    def __init__(self, answers: TextIO | None = None, *, absent: bool = False) -> None:
        self.absent = absent
        self._from = sys.stdin if answers is None else answers
        self._answers: queue.SimpleQueue[str] = queue.SimpleQueue()
        self._thread: threading.Thread | None = None
        self._asked: str | None = None

    def __call__(self, question: str) -> str | None:
        """Show a question once; return the answer when there is one."""
        if question != self._asked:
            self._asked = question
            messages().print(question)
        if self._thread is None and not self.absent:
            self._thread = threading.Thread(target=self._read, name="answers", daemon=True)
            self._thread.start()
        try:
            answer = self._answers.get_nowait()
        except queue.Empty:
            return None
        self._asked = None
        return answer

    def _read(self) -> None:
        for line in self._from:
            self._answers.put(line.strip())


@contextmanager
def opened(configuration: RigConfiguration, *, free_running: bool = False) -> Iterator[Rig]:
    """Open a rig that keeps to the clock, without touching its devices yet.

    Raises
    ------
    ConfigurationError
        If it is to run free and is not simulated in this process.
    """
    bus = configuration.bus
    if free_running and (bus is None or bus.interface != SIMULATED):
        raise ConfigurationError(
            f"--free-running is for a simulated rig (interface {SIMULATED!r}); "
            "a real one keeps to the clock"
        )
    period_s = 1.0 / configuration.sample_rate_hz
    pacer = FreeRunning() if free_running else RealTime(period_s, time.monotonic, time.sleep)
    with Rig(configuration, time.monotonic, pacer, Person(absent=free_running)) as rig:
        yield rig


def confirm(question: str, *, yes: bool) -> None:
    """Ask before something moves.

    Raises
    ------
    click.Abort
        If the answer is no, or there is nobody to give one.
    """
    if not yes:
        click.confirm(question, err=True, abort=True)


def print_json(job: str, content: dict[str, Any]) -> None:
    """Print a job's document; numbers that are not known are ``null``."""
    import json

    click.echo(json.dumps({"schema": JSON_SCHEMA, "job": job, **_clean(content)}, indent=2))


def print_table(headings: Sequence[str], rows: Sequence[Sequence[str]], numbers: str = "") -> None:
    """Print a table; headings among ``numbers`` (separated by commas) are aligned to the right."""
    output().print(plain_table(headings, rows, numbers))


def plain_table(
    headings: Sequence[str], rows: Sequence[Sequence[str]], numbers: str = ""
) -> "Table":
    """Return such a table."""
    from rich.table import Table

    table = Table(box=None, padding=(0, 1), pad_edge=False)
    right = numbers.split(",")
    for one in headings:
        table.add_column(one, justify="right" if one in right else "left", overflow="fold")
    for row in rows:
        table.add_row(*row)
    return table


def _clean(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _clean(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [_clean(one) for one in value]
    return None if isinstance(value, float) and value - value != 0.0 else value
