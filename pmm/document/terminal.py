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
        first = next(content for content in document.contents if not content.empty)
        end = ": " if isinstance(first, Text) else "\n"
        console.print(document.name, style="bold", end=end, soft_wrap=True)
    for section in document.sections:
        print_section(console, section)


def print_section(console: "Console", section: Section) -> None:
    """Print a section, unless all that it has is for a page."""
    contents = [
        content
        for content in section.contents
        if not (content.empty or isinstance(content, Figure))
    ]
    if contents and section.title:
        console.print(f"\n{section.title}", style="bold")
    above: Content | None = None
    for content in contents:
        led = above is None or (isinstance(above, Text) and not above.faint)
        if isinstance(content, Table) and not (led or content.titled):
            console.print()
        print_content(content, console)
        above = content


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

    for note in notes.items:
        line = Styled.assemble(
            (f"{note.kind.upper():7s} ", _STYLES[note.grade]),
            note.text,
            (f" [{note.code}]" if note.code else "", "dim"),
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
    rich_table = Grid(title=title, title_justify="left", box=None, padding=(0, 1), pad_edge=False)
    rich_table.show_header = any(column.title for column in table.shown_columns)
    for column in table.shown_columns:
        justify: Literal["left", "right"] = "right" if column.number else "left"
        rich_table.add_column(column.title, justify=justify, overflow="fold")
    for cells, grade in table.lines:
        rich_table.add_row(*cells, style=_STYLES[grade])
    return rich_table
