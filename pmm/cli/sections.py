"""Sections of a result on a terminal: the same lines and tables as on its page."""

from collections.abc import Iterable
from typing import TYPE_CHECKING

from pmm.report.table import Section, Table

if TYPE_CHECKING:
    from rich.console import Console


def print_sections(console: "Console", sections: Iterable[Section]) -> None:
    """Print sections one below the other."""
    for one in sections:
        console.print(f"\n{one.title}", style="bold")
        for line in one.lines:
            console.print(line, soft_wrap=True)
        for table in one.tables:
            if table.rows:
                _print_table(console, table)


def _print_table(console: "Console", content: Table) -> None:
    from rich.table import Table as Grid

    grid = Grid(box=None, padding=(0, 1), pad_edge=False)
    for at, heading in enumerate(content.headings):
        grid.add_column(heading, justify="left" if at < content.words else "right", overflow="fold")
    for row in content.rows:
        grid.add_row(*row)
    console.print(grid)
