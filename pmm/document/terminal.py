"""A document on a terminal: texts, notes and tables; figures are for pages and files."""

from functools import singledispatch
from typing import TYPE_CHECKING, Any, Final, Literal

from pmm.document.content import Content, Document, Figure, Notes, Section, Table, Text

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table as Grid

_STYLES: Final = {
    "": "",
    "faint": "dim",
    "good": "green",
    "note": "cyan",
    "warning": "yellow",
    "void": "bold red",
}


def print_document(console: "Console", document: Document) -> None:
    """Print a document; its name runs into its first line, or has its own above a table."""
    if document.name:
        first = next(one for one in document.contents if not one.empty)
        end = ": " if isinstance(first, Text) else "\n"
        console.print(document.name, style="bold", end=end, soft_wrap=True)
    for section in document.sections:
        print_section(console, section)


def print_section(console: "Console", section: Section) -> None:
    """Print a section, unless all that it has is for a page."""
    shown = [one for one in section.contents if not (one.empty or isinstance(one, Figure))]
    if shown and section.title:
        console.print(f"\n{section.title}", style="bold")
    above: Content | None = None
    for one in shown:
        led = above is None or (isinstance(above, Text) and not above.faint)
        if isinstance(one, Table) and not (led or one.titled):
            console.print()
        print_content(one, console)
        above = one


@singledispatch
def print_content(_content: Content, _console: "Console") -> None:
    """Print a content; what is not for a terminal is left out."""


@print_content.register(Text)
def _(text: Text, console: "Console") -> None:
    style = "bold" if text.strong else "dim" if text.faint else None
    for line in text.lines:
        console.print(line, style=style, soft_wrap=True)
    if text.strong:
        console.print()


@print_content.register(Notes)
def _(notes: Notes, console: "Console") -> None:
    from rich.text import Text as Styled

    for one in notes.items:
        line = Styled.assemble(
            (f"{one.kind.upper():7s} ", _STYLES[one.grade]),
            one.text,
            (f" [{one.code}]" if one.code else "", "dim"),
        )
        console.print(line, soft_wrap=True)


@print_content.register(Table)
def _(table: Table[Any], console: "Console") -> None:
    console.print(grid(table))
    for line in table.notes:
        console.print(line, soft_wrap=True)


def grid(table: Table[Any]) -> "Grid":
    """Return a table as a terminal draws it, for what is drawn again and again."""
    from rich.table import Table as Grid

    title = f"\n{table.name}" if table.titled else None
    found = Grid(title=title, title_justify="left", box=None, padding=(0, 1), pad_edge=False)
    found.show_header = any(one.title for one in table.shown)
    for column in table.shown:
        justify: Literal["left", "right"] = "right" if column.number else "left"
        found.add_column(column.title, justify=justify, overflow="fold")
    for cells, grade in table.lines:
        found.add_row(*cells, style=_STYLES[grade])
    return found
