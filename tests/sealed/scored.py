"""A board scored: printed, as JSON, as a page, and among the scores of the documentation."""

from pathlib import Path
from typing import TYPE_CHECKING

from benchmarks.machine import describe
from pmm.cli.screen import messages, output
from tests.sealed.scoreboard import write_scoreboard
from tests.sealed.scores import dumped, keep, refuse_another
from tests.sealed.scoring.board import read_board
from tests.sealed.scoring.page import write_page
from tests.sealed.scoring.score import Score, score
from tests.sealed.scoring.tables import tables

if TYPE_CHECKING:
    from rich.console import Console


def score_board(
    board: Path,
    *,
    json_file: Path | None = None,
    page: Path | None = None,
    docs: Path | None = None,
) -> None:
    """Score a board, print it and write what is asked for.

    Parameters
    ----------
    docs
        The documentation's folder, to keep the score among the others there.

    Raises
    ------
    ConfigurationError, DataError
        If the board cannot be read, or is not whole; before anything is scored, if its score was
        to be kept and its seed is one for development or was scored already.
    """
    read = read_board(board)
    if docs is not None:
        refuse_another(docs, read.seed)
    found, made_on = score(read), describe()
    _print(output(), found)
    if json_file is not None:
        json_file.write_text(dumped(found, made_on))
    if page is not None:
        command = f"python -m tests.sealed score {board} --page {page}"
        write_page(found, page, title=f"Sealed board {found.seed}", command=command)
    if docs is not None:
        messages().print(f"kept: {keep(docs, found, made_on)}")
        write_scoreboard(docs)
    messages().print(f"scored: {found.cases} cases, {len(found.rows)} rows")


def _print(console: "Console", found: Score) -> None:
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
