"""What goes to the screen: results on the output, messages and progress on the error stream.

Commands are named as a shell takes them.
"""

import os
import shlex
import sys
from collections.abc import Callable, Iterable, Iterator, Sized
from contextlib import contextmanager
from typing import IO, TYPE_CHECKING, TypeVar

import click

from hardware.description.errors import DataError, PmmError
from hardware.description.room import file_error_text

if TYPE_CHECKING:
    from pathlib import Path

    from rich.console import Console

    from pmm.document.content import Document

T = TypeVar("T")

WIDE = 120  # columns where nobody's terminal sets a width


def output(file: IO[str] | None = None) -> "Console":
    """Return the console for results: standard output, whatever that is then, or another file."""
    from rich.console import Console

    console = Console(file=file, highlight=False, emoji=False, markup=False)
    if not console.is_terminal:
        console.width = WIDE
    return console


def messages(file: IO[str] | None = None) -> "Console":
    """Return the console for everything that is not a result: standard error, or another file."""
    from rich.console import Console

    return Console(
        file=file, stderr=True, highlight=False, emoji=False, markup=False, soft_wrap=True
    )


def error_line(message: str) -> None:
    """Print an error on the standard error, ``error:`` before it."""
    from rich.text import Text

    messages().print(Text.assemble(("error: ", "bold red"), message))


def tell_refusal(error: PmmError | OSError) -> int:
    """Print what is refused, or cannot be done with a file; return its exit status.

    With ``--debug`` its traceback goes before it.
    """
    refusal = error if isinstance(error, PmmError) else DataError(file_error_text(error))
    if click.get_current_context().find_root().params.get("debug"):
        import traceback

        traceback.print_exception(error)
    error_line(str(refusal))
    return refusal.exit_status


def show_progress(items: Iterable[T], activity: str, count: int | None = None) -> Iterator[T]:
    """Yield the items, with a progress bar where there are several and a terminal to see it.

    Parameters
    ----------
    count
        How many there are, where they do not say it.
    """
    from rich.progress import Progress

    count = len(items) if isinstance(items, Sized) else count or 0
    console = messages()
    with Progress(
        console=console, transient=True, disable=count < 2 or not console.is_terminal
    ) as progress:
        yield from progress.track(items, total=count, description=activity)


@contextmanager
def doing(activity: str) -> Iterator[Callable[[str], None]]:
    """Say that something is going on, on a terminal, for as long as the context lasts.

    What it gives may be told what is done now.
    """
    console = messages()
    if not console.is_terminal:
        yield lambda _: None
        return
    with console.status(activity) as status:
        yield lambda words: status.update(words)


@contextmanager
def busy(activity: str) -> Iterator[Callable[[float], None]]:
    """Say so of something of which parts have been read, from 0 to 1."""
    with doing(activity) as tell:
        yield lambda part: tell(f"{activity}: {100.0 * part:.0f} % read")


def say(*lines: object) -> None:
    """Print lines beside a result, unbroken whatever the width."""
    for line in lines:
        output().print(str(line), soft_wrap=True)


def show(document: "Document", *, as_json: bool) -> None:
    """Print what a command found: for programs, or for people."""
    from pmm.document.data import as_json as written
    from pmm.document.terminal import print_document

    if as_json:
        click.echo(written(document))
    else:
        print_document(output(), document)


def program() -> str:
    """Return the program as it was called, ``pmm`` where that cannot be told."""
    called = sys.argv[0] if sys.argv else ""
    # Start-up does without pathlib.
    is_pmm = os.path.splitext(os.path.basename(called))[0] == "pmm"  # noqa: PTH119, PTH122
    return called if is_pmm else "pmm"


def pasted(*words: "str | Path") -> str:
    """Return a command of this program that a shell takes as it is, blanks and all."""
    return shlex.join([program(), *map(str, words)])
