"""What ``pmm gap check`` does: read a board, score it, print it, write the page."""

import json
from pathlib import Path
from typing import TYPE_CHECKING

import click

from pmm.cli.folders import check_file
from pmm.cli.hints import pasted
from pmm.cli.screen import busy, messages, output
from pmm.gap.scoring.board import read_board
from pmm.gap.scoring.document import document
from pmm.gap.scoring.score import CarryOut, Score, score
from pmm.gap.scoring.tables import tables

if TYPE_CHECKING:
    from rich.console import Console


def run(
    folder: str, page: str | None, *, as_json: bool, carry_out: CarryOut | None = None
) -> Score:
    """Score a board, print it and write its page; return the score.

    Raises
    ------
    ConfigurationError, DataError
        If the board cannot be read, or is not whole.
    """
    if page is not None:
        check_file(Path(page), "--page")
    with busy(f"scoring {folder}"):
        board = read_board(Path(folder))
        found = score(board, carry_out)
    if as_json:
        click.echo(json.dumps(document(found), indent=1, allow_nan=False))
    else:
        print_score(output(), found)
    if page is not None:
        from pmm.gap.scoring.page import write_page

        command = pasted("gap", "check", folder, "--page", page)
        write_page(found, Path(page), title=f"Sealed board {found.seed}", command=command)
        messages().print(f"written: {page}")
    return found


def print_score(console: "Console", found: Score) -> None:
    """Print a score as tables."""
    from rich.table import Table

    kinds = ", ".join(f"{count} {kind}" for kind, count in found.kinds.items())
    console.print(f"board {found.seed}: {found.cases} cases ({kinds})")
    for one in tables(found):
        table = Table(title=one.caption, title_justify="left", box=None, padding=(0, 1))
        for at, name in enumerate(one.head):
            table.add_column(name, justify="right" if at else "left", overflow="fold")
        for row in one.rows:
            table.add_row(*row)
        console.print()
        console.print(table)
    for note in found.notes:
        console.print(f"- {note}", style="dim")
