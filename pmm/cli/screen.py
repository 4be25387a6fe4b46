"""What goes to the screen: results on the output, messages and progress on the error stream."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import IO, TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from rich.console import Console

    from hardware.description.flags import Flag, Severity

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


@contextmanager
def busy(what: str) -> Iterator[Callable[[float], None]]:
    """Say that something is going on, on a terminal, for as long as the context lasts.

    What it gives may be told how much of that has been read, from 0 to 1.
    """
    console = messages()
    if not console.is_terminal:
        yield lambda _: None
        return
    with console.status(what) as status:
        yield lambda part: status.update(f"{what}: {100.0 * part:.0f} % read")


def flag_style(severity: "Severity") -> str:
    """Return the colour of a severity; the word itself is always printed too."""
    return {"note": "cyan", "warning": "yellow", "void": "bold red"}[severity]


def print_flags(console: "Console", flags: "Iterable[Flag]", *, hints: bool = True) -> None:
    """Print flags, equal ones in one line: severity, where, message, options for it, and code.

    Parameters
    ----------
    hints
        Whether the options of ``pmm analyse`` are the reader's to use.
    """
    from rich.text import Text

    from pmm.cli.hints import FLAG_OPTIONS
    from pmm.flag_lines import flag_lines

    for one in flag_lines(flags):
        line = Text.assemble(
            (f"{one.severity.upper():8s}", flag_style(one.severity)),
            one.text,
            f" ({FLAG_OPTIONS[one.code]})" if hints and one.code in FLAG_OPTIONS else "",
            (f" [{one.code}]", "dim"),
        )
        console.print(line, soft_wrap=True)
