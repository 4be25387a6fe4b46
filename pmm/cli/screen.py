"""What goes to the screen: results on the output, messages and progress on the error stream."""

from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from rich.console import Console

    from hardware.description.flags import Flag, Severity

T = TypeVar("T")

WIDE = 120  # columns where nobody's terminal sets a width


def output() -> "Console":
    """Return the console for results."""
    from rich.console import Console

    console = Console(highlight=False, emoji=False, markup=False)
    if not console.is_terminal:
        console.width = WIDE
    return console


def messages() -> "Console":
    """Return the console for everything that is not a result."""
    from rich.console import Console

    return Console(stderr=True, highlight=False, emoji=False, markup=False, soft_wrap=True)


def error_line(message: str) -> None:
    """Print an error."""
    from rich.text import Text

    messages().print(Text.assemble(("error: ", "bold red"), message))


def show_progress(items: Sequence[T], what: str) -> Iterator[T]:
    """Yield the items, with a progress bar where there are several and a terminal to see it."""
    from rich.progress import Progress

    console = messages()
    with Progress(
        console=console, transient=True, disable=len(items) < 2 or not console.is_terminal
    ) as progress:
        yield from progress.track(items, description=what)


def busy(what: str) -> AbstractContextManager[object]:
    """Say that something is going on, on a terminal, for as long as the context lasts."""
    console = messages()
    return console.status(what) if console.is_terminal else nullcontext()


def flag_style(severity: "Severity") -> str:
    """Return the colour of a severity; the word itself is always printed too."""
    return {"note": "cyan", "warning": "yellow", "void": "bold red"}[severity]


def print_flags(console: "Console", flags: "Sequence[Flag]") -> None:
    """Print flags, one a line: severity, channel, message, options that act on it, and code."""
    from rich.text import Text

    from pmm.cli.hints import FLAG_OPTIONS

    for flag in flags:
        channel = f"{flag.channel}: " if flag.channel else ""
        if flag.message.startswith(channel):
            channel = ""
        line = Text.assemble(
            (f"{flag.severity.upper():8s}", flag_style(flag.severity)),
            f"{channel}{flag.message}",
            f" ({FLAG_OPTIONS[flag.code]})" if flag.code in FLAG_OPTIONS else "",
            (f" [{flag.code}]", "dim"),
        )
        console.print(line, soft_wrap=True)
